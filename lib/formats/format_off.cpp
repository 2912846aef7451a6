// OFF, as text: triangles, polygons as fans, colours left out.
#include <algorithm>

#include "containers/text_scanner.h"
#include "formats/format.h"
#include "formats/off.h"
#include "mesh/drop_unused.h"

namespace hapsim {
namespace {

Content sniff(const std::string& bytes) {
  for (const std::string_view key : {"OFF", "COFF"}) {
    if (!bytes.starts_with(key)) continue;
    const char next = bytes.size() > key.size() ? bytes[key.size()] : '\n';
    if (std::string_view(" \t\r\n#").find(next) != std::string_view::npos)
      return Content::kTriangles;
  }
  return Content::kNothing;
}

}  // namespace

Surface parse_off(const std::string& bytes, const std::string& name) {
  TextScanner scan(bytes, name, '#');
  const bool coloured = scan.word() == "COFF";
  Surface surface;
  const std::size_t vertices = scan.count("the number of vertices", 6);
  const std::size_t faces = scan.count("the number of faces", 8);
  scan.count("the number of edges", 1);
  for (std::size_t v = 0; v < vertices; ++v) {
    Vec3& p = surface.vertices.emplace_back();
    for (int k = 0; k < 3; ++k) p[k] = scan.number("a coordinate");
    if (coloured) scan.line();
  }
  for (std::size_t f = 0; f < faces; ++f) {
    const long corners = scan.integer("the number of corners", 3, 1000);
    Triangle t{};
    for (long k = 0; k < corners; ++k) {
      const int v = static_cast<int>(
          scan.integer("the vertex of a face", 0, static_cast<long>(vertices) - 1));
      t[std::min<long>(k, 2)] = v;
      if (k < 2) continue;
      surface.faces.push_back(t);
      t[1] = t[2];
    }
    scan.line();  // colours
  }
  drop_unused(surface);
  return surface;
}

const Format& off_format() {
  static const Format format{
      .name = "OFF", .extensions = {"off"}, .sniff = sniff, .read_surface = parse_off};
  return format;
}

}  // namespace hapsim
