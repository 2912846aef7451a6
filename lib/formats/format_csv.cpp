// Points as a table whose header names x, y and z.
#include <algorithm>

#include "formats/format.h"
#include "io/csv.h"

namespace hapsim {
namespace {

std::vector<Vec3> zip(const std::vector<double>& x, const std::vector<double>& y,
                      const std::vector<double>& z) {
  std::vector<Vec3> v(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) v[i] = {x[i], y[i], z[i]};
  return v;
}

PointCloud points_from_table(const CsvTable& table) {
  PointCloud cloud;
  cloud.points = zip(table.numbers("x"), table.numbers("y"), table.numbers("z"));
  if (table.find("nx") >= 0 && table.find("ny") >= 0 && table.find("nz") >= 0) {
    cloud.normals = zip(table.numbers("nx"), table.numbers("ny"), table.numbers("nz"));
  }
  return cloud;
}

// The first line that is no comment and not empty, without a byte-order mark; "" of binary bytes.
std::string_view first_row(const std::string& bytes) {
  std::string_view rest = bytes;
  if (rest.starts_with("\xef\xbb\xbf")) rest.remove_prefix(3);
  while (!rest.empty()) {
    const std::string_view line = trim(rest.substr(0, rest.find('\n')).substr(0, 1 << 16));
    rest.remove_prefix(std::min(rest.find('\n'), rest.size() - 1) + 1);
    if (line.empty() || line.starts_with('#')) continue;
    return line.find('\0') == line.npos ? line : std::string_view();
  }
  return {};
}

// Any table: what its columns mean is the reader's question.
Content sniff(const std::string& bytes) {
  const bool table = first_row(bytes).find_first_of(",;\t") != std::string_view::npos;
  return table ? Content::kPoints : Content::kNothing;
}

std::string describe_points(const std::string& bytes) {
  return "a table with the columns " + shown(first_row(bytes));
}

PointCloud read_points(const std::string& bytes, const std::string& name,
                       std::vector<std::string>&) {
  Input input = Input::from_bytes(bytes, name);
  return points_from_table(read_csv(input));
}

void write_points(std::ostream& out, const PointCloud& cloud, const WriteOptions& options) {
  Metadata metadata;
  for (const std::string& comment : options.comments) metadata.add_comment(comment);
  std::vector<std::string> header{"x", "y", "z"};
  if (!cloud.normals.empty()) header.insert(header.end(), {"nx", "ny", "nz"});
  CsvWriter writer(out, metadata, header);
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    std::vector<std::string> row;
    for (const double c : cloud.points[i]) row.push_back(format_number(c));
    if (!cloud.normals.empty())
      for (const double c : cloud.normals[i]) row.push_back(format_number(c));
    writer.row(row);
  }
}

}  // namespace

const Format& csv_format() {
  static const Format format{.name = "CSV",
                             .extensions = {"csv"},
                             .sniff = sniff,
                             .describe_points = describe_points,
                             .read_points = read_points,
                             .write_points = write_points};
  return format;
}

}  // namespace hapsim
