#include "formats/body_input.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "base/error.h"
#include "formats/mesh_parts.h"
#include "formats/surface_io.h"
#include "io/number.h"

namespace hapsim {
namespace {

[[noreturn]] void fail_points(const std::string& name, const std::string& what) {
  fail_input(name, "these are points (" + what + "), no surface",
             "run hs-scan2ply FILE | hs-reconstruct | hs-tetmesh first");
}

bool is_ply(const std::string& bytes) {
  return bytes.starts_with("ply\n") || bytes.starts_with("ply\r");
}

// Of text: rows of numbers, or a header row with x, y and z or joint angles.
std::optional<std::string> rows_of_points(const std::string& bytes) {
  const std::string head = bytes.substr(0, 1 << 16);
  if (head.find('\0') != head.npos) return {};
  std::string_view rest = head;
  if (rest.starts_with("\xef\xbb\xbf")) rest.remove_prefix(3);
  while (!rest.empty()) {
    const std::string_view line = trim(rest.substr(0, rest.find('\n')));
    rest.remove_prefix(std::min(rest.find('\n'), rest.size() - 1) + 1);
    if (line.empty() || line[0] == '#') continue;
    int numbers = 0, words = 0;
    for (std::size_t from = 0; from < line.size();) {
      const std::size_t to = std::min(line.find_first_of(",; \t\r", from), line.size());
      double value;
      if (to > from) ++(parse_number(line.substr(from, to - from), value) ? numbers : words);
      from = to + 1;
    }
    if (words == 0 && numbers >= 3) return "rows of numbers";
    if (words >= 3 && line.find_first_of(",;\t") != line.npos)
      return "a table with the columns " + shown(line);
    return {};
  }
  return {};
}

std::optional<Support> base_of(const std::string& bytes, double factor) {
  const std::string header = bytes.substr(0, std::min(bytes.find("end_header"), bytes.size()));
  const std::string key = "comment base_plane ";
  const std::size_t at = header.find(key);
  if (at == header.npos) return {};
  const std::string line = header.substr(at + key.size(), header.find('\n', at) - at - key.size());
  const std::string none;
  TextScanner scan(line, none);
  Support base;
  base.kind = SupportKind::kPlane;
  try {
    for (int k = 0; k < 3; ++k) base.normal[k] = scan.number("a component");
    base.z = scan.number("a height") * factor;
  } catch (const Error&) {
    return {};
  }
  const double length = base.normal.norm();
  if (!(length > 0)) return {};
  base.normal /= length;
  base.z /= length;
  return base;
}

Surface surface_of(const std::string& bytes, const std::string& name) {
  if (is_ply(bytes)) {
    const std::size_t end = std::min(bytes.find("end_header"), bytes.size());
    const std::string header = bytes.substr(0, end);
    if (header.find("element face") == header.npos || header.find("element face 0") != header.npos)
      if (header.find("element vertex") != header.npos) fail_points(name, "a PLY without faces");
  } else if (bytes.starts_with("OFF") || bytes.starts_with("COFF")) {
    return parse_off(bytes, name);
  } else if (const auto what = rows_of_points(bytes)) {
    fail_points(name, *what);
  }
  Input again = Input::from_bytes(bytes, name);
  return read_surface(again);
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
  std::vector<int> number(vertices, -1);
  for (std::size_t f = 0; f < faces; ++f) {
    const long corners = scan.integer("the number of corners", 3, 1000);
    Triangle t{};
    for (long k = 0; k < corners; ++k) {
      const int v = static_cast<int>(
          scan.integer("the vertex of a face", 0, static_cast<long>(vertices) - 1));
      number[static_cast<std::size_t>(v)] = 0;
      t[std::min<long>(k, 2)] = v;
      if (k < 2) continue;
      surface.faces.push_back(t);
      t[1] = t[2];
    }
    scan.line();  // colours
  }
  int used = 0;
  for (std::size_t v = 0; v < vertices; ++v) {
    if (number[v] < 0) continue;
    surface.vertices[static_cast<std::size_t>(used)] = surface.vertices[v];
    number[v] = used++;
  }
  surface.vertices.resize(static_cast<std::size_t>(used));
  for (Triangle& t : surface.faces)
    for (int& v : t) v = number[static_cast<std::size_t>(v)];
  return surface;
}

BodyInput read_body_input(Input& input, double factor) {
  const std::string bytes = input.read_all();
  BodyInput result;
  if (bytes.empty())
    fail_input(input.name(), "empty input", "give a closed surface: PLY, STL or OFF");
  if (is_mesh_file(bytes)) {
    result.mesh = parse_mesh(bytes, input.name(), true);
    for (Vec3& p : result.mesh->mesh.nodes) p *= factor;
    return result;
  }
  result.surface = surface_of(bytes, input.name());
  for (Vec3& p : result.surface.vertices) p *= factor;
  if (is_ply(bytes)) result.base = base_of(bytes, factor);
  return result;
}

}  // namespace hapsim
