// STL as a surface, and its corners as points.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <unordered_map>

#include "containers/stl.h"
#include "formats/format.h"

namespace hapsim {
namespace {

struct PointHash {
  std::size_t operator()(const Vec3& p) const {
    std::size_t h = 0;
    for (int k = 0; k < 3; ++k) h = h * 0x9E3779B97F4A7C15u + std::hash<double>()(p[k]);
    return h;
  }
};

// A first triangle as STL has it behind a binary header: a normal of length 1 or 0, finite corners.
bool starts_with_facet(const std::string& bytes) {
  constexpr std::size_t kFacet = 84;
  float number[12];
  if (bytes.size() < kFacet + 50) return false;
  std::memcpy(number, bytes.data() + kFacet, sizeof number);
  for (const float x : number)
    if (!(std::abs(x) < 1e10F)) return false;
  const float length = std::hypot(number[0], number[1], number[2]);
  return length == 0 || std::abs(length - 1) < 1e-3F;
}

// Text begins with "solid". A binary file has no mark: its size fits the number of triangles that
// its header claims, or, where it was cut, its first triangle is one.
Content sniff(const std::string& bytes) {
  const std::size_t first = std::min(bytes.find_first_not_of(" \t\r\n"), bytes.size());
  const std::string word = bytes.substr(first, bytes.find_first_of(" \t\r\n", first) - first);
  if (word == "solid" || word == "SOLID") return Content::kTriangles;
  if (bytes.size() < 84) return Content::kNothing;
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + 80, sizeof count);
  if (count == 0) return Content::kNothing;
  const bool fits = bytes.size() == 84 + 50 * std::size_t{count};
  return fits || starts_with_facet(bytes) ? Content::kTriangles : Content::kNothing;
}

// Equal corners become one vertex.
Surface read_surface(const std::string& bytes, const std::string& name) {
  Surface surface;
  std::unordered_map<Vec3, int, PointHash> number;
  for (const auto& corners : parse_stl(bytes, name)) {
    Triangle face;
    for (int k = 0; k < 3; ++k) {
      const Vec3 p = corners[k] + Vec3::Zero();  // -0 becomes 0, which hashes alike
      const auto [at, added] = number.try_emplace(p, static_cast<int>(surface.vertices.size()));
      if (added) surface.vertices.push_back(p);
      face[k] = at->second;
    }
    surface.faces.push_back(face);
  }
  return surface;
}

// Every corner of every triangle: those at one place are dropped with a scan's doubles.
PointCloud read_points(const std::string& bytes, const std::string& name,
                       std::vector<std::string>&) {
  PointCloud cloud;
  for (const auto& triangle : parse_stl(bytes, name))
    cloud.points.insert(cloud.points.end(), triangle.begin(), triangle.end());
  return cloud;
}

TriangleSoup soup_of(const Surface& surface) {
  TriangleSoup soup;
  for (const Triangle& f : surface.faces)
    soup.push_back({surface.vertices[static_cast<std::size_t>(f[0])],
                    surface.vertices[static_cast<std::size_t>(f[1])],
                    surface.vertices[static_cast<std::size_t>(f[2])]});
  return soup;
}

void write_surface(std::ostream& out, const Surface& surface, const WriteOptions& options) {
  options.ascii ? write_stl_ascii(out, soup_of(surface)) : write_stl_binary(out, soup_of(surface));
}

}  // namespace

const Format& stl_format() {
  static const Format format{.name = "STL",
                             .extensions = {"stl"},
                             .sniff = sniff,
                             .read_points = read_points,
                             .read_surface = read_surface,
                             .write_surface = write_surface};
  return format;
}

}  // namespace hapsim
