// Wavefront OBJ: vertices and faces, polygons as fans; textures, normals, groups and materials are
// left out (Object Files, Wavefront Technologies, Appendix B1).
#include <fmt/format.h>

#include <algorithm>
#include <ostream>

#include "base/error.h"
#include "containers/text_scanner.h"
#include "formats/format.h"
#include "io/number.h"
#include "mesh/drop_unused.h"

namespace hapsim {
namespace {

constexpr std::string_view kKeywords[] = {"v", "vn", "vt", "vp", "f",      "l",     "p",
                                          "o", "g",  "s",  "mg", "usemtl", "mtllib"};
constexpr std::size_t kLooked = 1 << 16;  // bytes

bool has_vertex(std::string_view text) {
  for (std::size_t at = 0; at < text.size(); ++at) {
    const std::string_view line = text.substr(at, text.find('\n', at) - at);
    double x = 0;
    if (line.starts_with("v ") || line.starts_with("v\t")) {
      const std::size_t first = std::min(line.find_first_not_of(" \t", 1), line.size());
      const std::string_view number = line.substr(first, line.find_first_of(" \t", first) - first);
      return parse_number(number, x);
    }
    at += line.size();
  }
  return false;
}

// It has no mark of its own: the first line begins with one of its words, and a vertex follows.
Content sniff(const std::string& bytes) {
  const std::string_view text = std::string_view(bytes).substr(0, kLooked);
  for (std::size_t at = 0; at < text.size(); ++at) {
    const std::string_view line = text.substr(at, text.find('\n', at) - at);
    at += line.size();
    const std::size_t first = line.find_first_not_of(" \t\r");
    if (first == line.npos || line[first] == '#') continue;
    const std::string_view word = line.substr(first, line.find_first_of(" \t\r", first) - first);
    const bool known =
        std::find(std::begin(kKeywords), std::end(kKeywords), word) != std::end(kKeywords);
    return known && has_vertex(text) ? Content::kTriangles : Content::kNothing;
  }
  return Content::kNothing;
}

class ObjReader {
 public:
  ObjReader(const std::string& bytes, const std::string& name)
      : name_(name), scan_(bytes, name, '#') {}

  Surface read() {
    while (!scan_.done()) {
      const std::string_view word = scan_.word();
      if (word == "v")
        read_vertex();
      else if (word == "f")
        read_face();
      else
        scan_.line();
    }
    drop_unused(surface_);
    return std::move(surface_);
  }

 private:
  void read_vertex() {
    Vec3& p = surface_.vertices.emplace_back();
    for (int k = 0; k < 3; ++k) p[k] = scan_.number("a coordinate");
    scan_.line();  // a weight, or a colour
  }

  // "12", "12/3", "12//7", "-1": counted from 1, or back from the last.
  int corner(std::string_view text, long line) const {
    const std::string_view number = text.substr(0, text.find('/'));
    const auto count = static_cast<double>(surface_.vertices.size());
    double value = 0;
    const bool whole =
        parse_number(number, value) &&
        value == static_cast<double>(static_cast<long>(std::clamp(value, -1e9, 1e9)));
    const double index = value > 0 ? value - 1 : count + value;
    if (!whole || value == 0 || !(index >= 0 && index < count))
      fail_input(fmt::format("{}:{}", name_, line),
                 fmt::format("'{}' is no vertex: {} stand before this face", text.substr(0, 40),
                             surface_.vertices.size()),
                 "write the surface again");
    return static_cast<int>(index);
  }

  void read_face() {
    const long at = scan_.line_number();
    const std::string_view line = scan_.line();
    Triangle t{};
    int corners = 0;
    for (std::size_t begin = 0; begin < line.size();) {
      const std::size_t first = line.find_first_not_of(" \t", begin);
      if (first == line.npos || line[first] == '#') break;
      begin = std::min(line.find_first_of(" \t", first), line.size());
      t[std::min(corners, 2)] = corner(line.substr(first, begin - first), at);
      if (++corners < 3) continue;
      surface_.faces.push_back(t);
      t[1] = t[2];
    }
    if (corners < 3)
      fail_input(fmt::format("{}:{}", name_, at), "a face has fewer than three corners",
                 "write the surface again");
  }

  const std::string& name_;
  TextScanner scan_;
  Surface surface_;
};

Surface read_surface(const std::string& bytes, const std::string& name) {
  return ObjReader(bytes, name).read();
}

// All its vertices, also those of no face.
PointCloud read_points(const std::string& bytes, const std::string& name,
                       std::vector<std::string>&) {
  PointCloud cloud;
  TextScanner scan(bytes, name, '#');
  while (!scan.done()) {
    if (scan.word() == "v") {
      Vec3& p = cloud.points.emplace_back();
      for (int k = 0; k < 3; ++k) p[k] = scan.number("a coordinate");
    }
    scan.line();
  }
  return cloud;
}

void write_surface(std::ostream& out, const Surface& surface, const WriteOptions& options) {
  for (const std::string& comment : options.comments) out << "# " << comment << '\n';
  for (const Vec3& p : surface.vertices) out << fmt::format("v {} {} {}\n", p.x(), p.y(), p.z());
  for (const Triangle& f : surface.faces)
    out << fmt::format("f {} {} {}\n", f[0] + 1, f[1] + 1, f[2] + 1);
}

}  // namespace

const Format& obj_format() {
  static const Format format{.name = "OBJ",
                             .extensions = {"obj"},
                             .sniff = sniff,
                             .read_points = read_points,
                             .read_surface = read_surface,
                             .write_surface = write_surface};
  return format;
}

}  // namespace hapsim
