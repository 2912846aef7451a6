// Input decks of Abaqus and CalculiX: nodes, C3D4 or C3D10, before the first step. Region: element
// sets REGION_k; fixed: the node set FIXED, and what *BOUNDARY holds in all three directions.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.h"
#include "formats/format.h"
#include "formats/mesh_file.h"
#include "io/number.h"

namespace hapsim {
namespace {

std::string upper(std::string_view text) {
  std::string result(trim(text));
  for (char& c : result)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  return result;
}

// Fields between commas; one that is empty at the end is left out.
std::vector<std::string_view> fields_of(std::string_view line) {
  std::vector<std::string_view> fields;
  while (!line.empty()) {
    const std::size_t comma = std::min(line.find(','), line.size());
    fields.push_back(trim(line.substr(0, comma)));
    line.remove_prefix(std::min(comma + 1, line.size()));
  }
  return fields;
}

class Deck {
 public:
  Deck(const std::string& bytes, const std::string& name) : rest_(bytes), name_(name) {}

  RawMesh read() {
    raw_.format = "Abaqus";
    while (next_line())
      if (line_[0] == '*')
        begin_keyword();
      else if (!in_step_)
        read_data(fields_of(line_));
    finish();
    return std::move(raw_);
  }

 private:
  [[noreturn]] void fail(const std::string& wrong, const std::string& mend) const {
    fail_input(name_ + ":" + std::to_string(number_), wrong, mend);
  }

  // The next line that is no comment and not blank.
  bool next_line() {
    while (!rest_.empty()) {
      const std::size_t end = std::min(rest_.find('\n'), rest_.size());
      line_ = trim(rest_.substr(0, end));
      if (!line_.empty() && line_.back() == '\r') line_ = trim(line_.substr(0, line_.size() - 1));
      rest_.remove_prefix(std::min(end + 1, rest_.size()));
      ++number_;
      if (!line_.empty() && !line_.starts_with("**")) return true;
    }
    return false;
  }

  void begin_keyword() {
    parameters_.clear();
    const std::vector<std::string_view> words = fields_of(line_.substr(1));
    keyword_ = words.empty() ? "" : upper(words[0]);
    for (std::size_t i = 1; i < words.size(); ++i) {
      const std::size_t equals = std::min(words[i].find('='), words[i].size());
      const std::size_t value = std::min(equals + 1, words[i].size());
      parameters_[upper(words[i].substr(0, equals))] = upper(words[i].substr(value));
    }
    in_step_ = in_step_ || keyword_ == "STEP";
    element_.clear();
    if (keyword_ == "INCLUDE" && !in_step_)
      fail("the deck includes another file", "put its nodes and elements into one file");
    if (keyword_ != "ELEMENT") return;
    const std::string type = parameters_["TYPE"];
    corners_ = type == "C3D4" ? 4 : type.starts_with("C3D10") ? 10 : 0;
    is_volume_ = type.starts_with("C3D") || type.starts_with("F3D") || type.starts_with("DC3D");
  }

  long integer(std::string_view text, const char* what) const {
    double value = 0;
    if (!parse_number(text, value) || value < 1 || value > 2147483647 || value != std::floor(value))
      fail(fmt::format("{} is no {}", shown(text), what), "write the mesh again");
    return static_cast<long>(value);
  }

  void read_data(const std::vector<std::string_view>& fields) {
    if (keyword_ == "NODE")
      read_node(fields);
    else if (keyword_ == "ELEMENT")
      read_element(fields);
    else if (keyword_ == "NSET" || keyword_ == "ELSET")
      read_set(fields);
    else if (keyword_ == "BOUNDARY")
      read_boundary(fields);
  }

  void read_node(const std::vector<std::string_view>& fields) {
    if (fields.size() < 4) fail("a node has a number and three coordinates", "complete the line");
    const long id = integer(fields[0], "number of a node");
    if (!node_.emplace(id, static_cast<int>(raw_.nodes.size())).second)
      fail(fmt::format("node {} is given twice", id),
           "export one part, or an assembly that is numbered as a whole");
    Vec3& p = raw_.nodes.emplace_back();
    for (Eigen::Index k = 0; k < 3; ++k)
      if (!parse_number(fields[static_cast<std::size_t>(k) + 1], p[k]))
        fail(shown(fields[static_cast<std::size_t>(k) + 1]) + " is no coordinate",
             "write the mesh again");
  }

  // An element of ten nodes may go on in the next line.
  void read_element(const std::vector<std::string_view>& fields) {
    if (corners_ == 0) {
      if (is_volume_) ++raw_.other_cells;
      return;
    }
    for (const std::string_view field : fields) element_.push_back(integer(field, "node"));
    if (element_.size() < corners_ + 1) return;
    if (element_.size() > corners_ + 1)
      fail(fmt::format("an element has {} nodes, not {}", element_.size() - 1, corners_),
           "write the mesh again");
    tet_[element_[0]] = raw_.tets.size();
    tets_.push_back({number_, {}});
    std::copy(element_.begin() + 1, element_.end(), tets_.back().node.begin());
    const int corners[10] = {};
    if (!raw_.add(corners, corners_, 0))
      fail("tetrahedra of first and of second order are mixed", "write all of one order");
    if (parameters_.count("ELSET") != 0) name_set(parameters_["ELSET"], raw_.tets.size() - 1);
    element_.clear();
  }

  // Element sets named REGION_k are regions.
  void name_set(const std::string& set, std::size_t tet) {
    double region = 0;
    if (set.starts_with("REGION_") && parse_number(set.substr(7), region) && region >= 0 &&
        region < 1e6)
      raw_.region[tet] = static_cast<int>(region);
  }

  void read_set(const std::vector<std::string_view>& fields) {
    const bool nodes = keyword_ == "NSET";
    const std::string set = parameters_[keyword_];
    std::vector<long> ids;
    for (const std::string_view field : fields) {
      double value = 0;
      if (parse_number(field, value)) ids.push_back(integer(field, "member of a set"));
    }
    if (parameters_.count("GENERATE") != 0 && ids.size() >= 2) {
      const long first = ids[0], last = ids[1], step = ids.size() > 2 ? ids[2] : 1;
      ids.clear();
      // Only those that there are: a line may claim any number of them.
      const auto take = [&](const auto& known) {
        for (auto it = known.lower_bound(first); it != known.end() && it->first <= last; ++it)
          if ((it->first - first) % step == 0) ids.push_back(it->first);
      };
      nodes ? take(node_) : take(tet_);
    }
    for (const long id : ids)
      if (nodes)
        sets_[set].push_back(id);
      else if (const auto tet = tet_.find(id); tet != tet_.end())
        name_set(set, tet->second);
  }

  // Nodes, or a set of them, whose three displacements are held at zero before the first step.
  void read_boundary(const std::vector<std::string_view>& fields) {
    if (fields.size() < 2) return;
    double value = 0, first = 0, last = 0;
    const std::string kind = upper(fields[1]);
    const bool all = kind == "ENCASTRE" || kind == "PINNED" ||
                     (fields.size() >= 3 && parse_number(fields[1], first) && first == 1 &&
                      parse_number(fields[2], last) && last >= 3 &&
                      (fields.size() < 4 || (parse_number(fields[3], value) && value == 0)));
    if (all) held_.emplace_back(upper(fields[0]));
  }

  int node_of(long id, long line) const {
    const auto found = node_.find(id);
    if (found != node_.end()) return found->second;
    fail_input(name_ + ":" + std::to_string(line), fmt::format("there is no node {}", id),
               "write the mesh again");
  }

  void fix(const std::vector<long>& ids) {
    for (const long id : ids) raw_.fixed[static_cast<std::size_t>(node_of(id, number_))] = 1;
  }

  void finish() {
    for (std::size_t t = 0; t < tets_.size(); ++t)
      for (std::size_t k = 0; k < (raw_.order == 1 ? 4U : 10U); ++k)
        raw_.tets[t][k] = node_of(tets_[t].node[k], tets_[t].line);
    const bool named = sets_.count("FIXED") != 0;
    if (!named && held_.empty()) return;
    raw_.fixed.assign(raw_.nodes.size(), 0);
    if (named) fix(sets_["FIXED"]);
    for (const std::string& what : held_) {
      double id = 0;
      if (parse_number(what, id))
        fix({integer(what, "number of a node")});
      else if (sets_.count(what) != 0)
        fix(sets_[what]);
    }
  }

  struct Tet {
    long line;
    std::array<long, 10> node;
  };

  std::string_view rest_, line_;
  const std::string& name_;
  long number_ = 0;
  std::string keyword_;
  std::map<std::string, std::string> parameters_;
  bool in_step_ = false, is_volume_ = false;
  std::size_t corners_ = 0;
  std::vector<long> element_;
  std::map<long, int> node_;         // by its number in the deck
  std::map<long, std::size_t> tet_;  // likewise
  std::vector<Tet> tets_;
  std::map<std::string, std::vector<long>> sets_;
  std::vector<std::string> held_;
  RawMesh raw_;
};

Content sniff(const std::string& bytes) {
  // Comments and the heading may stand before the nodes.
  const std::size_t first = bytes.find_first_not_of(" \t\r\n");
  if (first == bytes.npos || bytes[first] != '*') return Content::kNothing;
  const bool has_nodes =
      upper(std::string_view(bytes).substr(0, 65536)).find("*NODE") != bytes.npos;
  return has_nodes ? Content::kTetrahedra : Content::kNothing;
}

RawMesh read_mesh(const std::string& bytes, const std::string& where) {
  return Deck(bytes, where).read();
}

void write_mesh(std::ostream& out, const TetMesh& mesh, const WriteOptions&) {
  write_mesh_abaqus(out, mesh);
}

}  // namespace

const Format& abaqus_format() {
  static const Format format{.name = "Abaqus",
                             .extensions = {"inp"},
                             .sniff = sniff,
                             .read_mesh = read_mesh,
                             .write_mesh = write_mesh};
  return format;
}

}  // namespace hapsim
