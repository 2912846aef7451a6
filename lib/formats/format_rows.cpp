// Points as rows of numbers without a header, often called XYZ.
#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "base/error.h"
#include "formats/format.h"
#include "io/number.h"

namespace hapsim {
namespace {

// Fields of a line without header: numbers between spaces, tabs, commas or semicolons.
std::vector<double> plain_numbers(const std::string& line, bool& clean) {
  std::vector<double> numbers;
  clean = true;
  std::size_t at = 0;
  while (true) {
    at = line.find_first_not_of(" \t\r,;", at);
    if (at == std::string::npos) return numbers;
    const std::size_t end = std::min(line.find_first_of(" \t\r,;", at), line.size());
    double value = 0;
    if (parse_number(std::string_view(line).substr(at, end - at), value)) {
      numbers.push_back(value);
    } else {
      clean = false;
    }
    at = end;
  }
}

// x y z [nx ny nz] without a header.
class PlainPoints {
 public:
  explicit PlainPoints(const std::string& name) : name_(name) {}

  void add(const std::string& line, long number) {
    if (trim(line).starts_with('#')) return;
    bool clean = true;
    const std::vector<double> v = plain_numbers(line, clean);
    if (v.empty() && clean) return;
    if (cloud_.points.empty()) normals_ = v.size() == 6;
    if (!clean || v.size() < (normals_ ? 6u : 3u)) {
      fail_input(fmt::format("{}:{}", name_, number), "not a row of finite x y z",
                 "remove or mend the row");
    }
    cloud_.points.emplace_back(v[0], v[1], v[2]);
    if (normals_) cloud_.normals.emplace_back(v[3], v[4], v[5]);
  }
  PointCloud take() { return std::move(cloud_); }

 private:
  std::string name_;
  PointCloud cloud_;
  bool normals_ = false;
};

// The first row that is no comment has three fields or more, and the first of them is a number.
Content sniff(const std::string& bytes) {
  for (std::string_view rest = bytes; !rest.empty();) {
    const std::string_view line = trim(rest.substr(0, rest.find('\n')).substr(0, 4096));
    rest.remove_prefix(std::min(rest.find('\n'), rest.size() - 1) + 1);
    if (line.empty() || line.starts_with('#')) continue;
    if (line.find('\0') != line.npos) return Content::kNothing;
    constexpr std::string_view kBetween = " \t\r,;";
    std::size_t fields = 0;
    for (std::size_t at = line.find_first_not_of(kBetween); at != line.npos; ++fields) {
      const std::size_t end = std::min(line.find_first_of(kBetween, at), line.size());
      double value = 0;
      if (fields == 0 && !parse_number(line.substr(at, end - at), value)) return Content::kNothing;
      at = line.find_first_not_of(kBetween, end);
    }
    return fields >= 3 ? Content::kPoints : Content::kNothing;
  }
  return Content::kNothing;
}

std::string describe_points(const std::string&) {
  return "rows of numbers";
}

PointCloud read_points(const std::string& bytes, const std::string& name,
                       std::vector<std::string>&) {
  PlainPoints plain(name);
  std::istringstream in(bytes);
  std::string line;
  for (long number = 1; std::getline(in, line); ++number) plain.add(line, number);
  return plain.take();
}

void write_points(std::ostream& out, const PointCloud& cloud, const WriteOptions& options) {
  for (const std::string& comment : options.comments) out << "# " << comment << '\n';
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const auto put = [&](const Vec3& v, const char* before) {
      out << before << format_number(v.x()) << ' ' << format_number(v.y()) << ' '
          << format_number(v.z());
    };
    put(cloud.points[i], "");
    if (!cloud.normals.empty()) put(cloud.normals[i], " ");
    out << '\n';
  }
}

}  // namespace

const Format& rows_format() {
  static const Format format{.name = "XYZ",
                             .extensions = {"xyz", "txt", "asc", "pts"},
                             .sniff = sniff,
                             .describe_points = describe_points,
                             .read_points = read_points,
                             .write_points = write_points};
  return format;
}

}  // namespace hapsim
