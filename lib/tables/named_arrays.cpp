#include "tables/named_arrays.h"

#include <algorithm>
#include <map>
#include <set>

#include "base/error.h"
#include "io/number.h"

namespace hapsim {
namespace {

std::string parent(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  return slash == path.npos ? "" : path.substr(0, slash);
}

std::string last(const std::string& path) {
  return path.substr(path.rfind('/') + 1);
}

// A vector lies down or stands up: it is one column.
void stand(NamedArray& a, std::size_t length) {
  if (a.rows == 1 && a.columns > 1 && a.columns == length) std::swap(a.rows, a.columns);
}

// Columns of a matrix that is written by columns of samples: 3 x 500.
void turn(NamedArray& a) {
  std::vector<double> turned(a.values.size());
  for (std::size_t r = 0; r < a.rows; ++r)
    for (std::size_t c = 0; c < a.columns; ++c) turned[c * a.rows + r] = a.at(r, c);
  a.values = std::move(turned);
  std::swap(a.rows, a.columns);
}

// One struct or group: its arrays of the same length, and what stands alone in it.
struct Group {
  std::string path;
  std::size_t length = 0;
  std::vector<NamedArray> arrays;
  std::vector<std::string> names;  // of columns
};

// The length that most numbers have, above three: those of samples.
std::size_t common_length(const std::vector<NamedArray>& arrays) {
  std::map<std::size_t, std::size_t> weight;
  for (const NamedArray& a : arrays) {
    const std::size_t length = std::max(a.rows, a.columns);
    if (length > 3) weight[length] += std::min(a.rows, a.columns);
  }
  std::size_t best = 0, most = 0;
  for (const auto& [length, w] : weight)
    if (w > most || (w == most && length > best)) {
      best = length;
      most = w;
    }
  return best;
}

void name_columns(Group& group, const std::vector<std::string>& given) {
  static const char* const kAxes[] = {"x", "y", "z"};
  const bool one = group.arrays.size() == 1 && group.arrays[0].columns == given.size();
  for (const NamedArray& a : group.arrays)
    for (std::size_t c = 0; c < a.columns; ++c)
      group.names.push_back(one              ? given[c]
                            : a.columns == 1 ? last(a.path)
                            : a.columns == 3 ? last(a.path) + "_" + kAxes[c]
                                             : last(a.path) + "_" + std::to_string(c + 1));
}

std::vector<Group> groups_of(std::vector<NamedArray>& arrays,
                             const std::vector<std::string>& names) {
  std::map<std::string, std::vector<NamedArray>> by_parent;
  std::vector<std::string> order;
  for (NamedArray& a : arrays) {
    const std::string key = parent(a.path);
    if (!by_parent.count(key)) order.push_back(key);
    by_parent[key].push_back(std::move(a));
  }
  std::vector<Group> groups;
  for (const std::string& key : order) {
    Group group{key, common_length(by_parent[key]), {}, {}};
    if (group.length == 0) continue;
    for (NamedArray& a : by_parent[key]) {
      stand(a, group.length);
      if (a.rows != group.length && a.columns == group.length && a.rows <= 16) turn(a);
      const bool alone = a.rows * a.columns == 1 || (a.rows == 1 && a.columns == 3) ||
                         (a.rows == 3 && a.columns == 1);
      if (a.rows == 3 && a.columns == 1 && alone) std::swap(a.rows, a.columns);
      if (a.rows == group.length || alone) group.arrays.push_back(std::move(a));
    }
    name_columns(group, names);
    groups.push_back(std::move(group));
  }
  return groups;
}

void append(RawTable& table, const Group& group, const std::string& key, int block) {
  for (std::size_t row = 0; row < group.length; ++row) {
    std::size_t column = 0;
    for (const NamedArray& a : group.arrays)
      for (std::size_t c = 0; c < a.columns; ++c)
        table.columns[column++].push_back(format_number(a.at(a.rows == 1 ? 0 : row, c)));
    if (column < table.columns.size()) table.columns[column].push_back(key);
    table.line.push_back(static_cast<long>(row) + 1);
    table.block.push_back(block);
  }
}

// "sites[3]" is the third of "sites[]".
std::string without_index(const std::string& path) {
  std::string out;
  bool inside = false;
  for (const char c : path) {
    if (c == ']') inside = false;
    if (!inside) out += c;
    if (c == '[') inside = true;
  }
  return out;
}

}  // namespace

RawTable table_of(std::vector<NamedArray> arrays, const std::string& name,
                  const TableOptions& options) {
  if (!options.part.empty())
    std::erase_if(arrays, [&](const NamedArray& a) {
      return a.path != options.part && a.path.rfind(options.part + "/", 0) != 0 &&
             without_index(a.path).rfind(options.part + "[]", 0) != 0;
    });
  std::vector<Group> groups = groups_of(arrays, options.names);
  if (groups.empty())
    fail_input(name,
               options.part.empty() ? "the file holds no columns of numbers"
                                    : "nothing lies below " + shown(options.part),
               "arrays of one length are needed, or an array of structs that have them");
  // Groups with the same columns belong together; of different ones the user takes one.
  std::map<std::vector<std::string>, std::vector<const Group*>> kinds;
  for (const Group& group : groups) kinds[group.names].push_back(&group);
  if (kinds.size() > 1) {
    std::set<std::string> paths;
    for (const Group& group : groups)
      paths.insert(group.path.empty() ? shown(last(group.arrays[0].path))
                                      : without_index(group.path));
    std::string all;
    for (const std::string& path : paths) all += (all.empty() ? "" : ", ") + path;
    fail_input(name, "the file holds several tables: " + all.substr(0, 200),
               "say which by --part NAME");
  }
  const std::vector<const Group*>& same = kinds.begin()->second;
  RawTable table;
  table.name = name;
  std::vector<std::string> header = same[0]->names;
  const bool elements = same[0]->path.find('[') != std::string::npos;
  if (same.size() > 1) header.push_back(elements ? "site" : "recording");
  table.set_header(header);
  std::size_t column = 0;
  for (const NamedArray& a : same[0]->arrays)
    for (std::size_t c = 0; c < a.columns; ++c) table.unit[column++] = a.unit;
  for (std::size_t g = 0; g < same.size(); ++g)
    append(table, *same[g], elements ? std::to_string(g + 1) : same[g]->path, static_cast<int>(g));
  if (same.size() > 1)
    table.notes.push_back(std::to_string(same.size()) +
                          " tables of the same columns: one recording each");
  return table;
}

}  // namespace hapsim
