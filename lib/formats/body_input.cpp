#include "formats/body_input.h"

#include "base/error.h"
#include "formats/format_table.h"
#include "formats/ply.h"
#include "formats/surface_io.h"
#include "formats/text_scanner.h"
#include "io/wrapped.h"

namespace hapsim {
namespace {

// "base_plane nx ny nz h".
std::optional<Support> base_of(const std::vector<std::string>& comments, double factor) {
  const std::string key = "base_plane ";
  for (const std::string& comment : comments) {
    if (!comment.starts_with(key)) continue;
    const std::string line = comment.substr(key.size()), none;
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
  return {};
}

[[noreturn]] void fail_points(const std::string& name, const std::string& bytes,
                              const Format& format) {
  const std::string what =
      format.describe_points != nullptr ? format.describe_points(bytes) : format.name;
  fail_input(name, "these are points (" + what + "), no surface",
             "run hs-scan2ply FILE | hs-reconstruct | hs-tetmesh first");
}

// A surface or a mesh is needed: fails with what `bytes` are instead.
void require_body(const std::string& bytes, const std::string& name, const Recognised& found) {
  if (found.content == Content::kPoints) fail_points(name, bytes, *found.format);
  if (found.format != nullptr) return;
  refuse_wrapped(name, bytes);
  const std::string surfaces = names_to_read(Content::kTriangles);
  if (bytes.empty()) fail_input(name, "the file is empty", "give a closed surface: " + surfaces);
  fail_input(name,
             "neither a surface (" + surfaces + ") nor a mesh of tetrahedra (" +
                 names_to_read(Content::kTetrahedra) + ")",
             "write it again as one of these");
}

}  // namespace

BodyInput read_body_input(Input& input, double factor) {
  const std::string bytes = input.read_all();
  const Recognised found = recognise(bytes);
  require_body(bytes, input.name(), found);
  BodyInput result;
  if (found.content == Content::kTetrahedra) {
    result.mesh = parse_mesh(bytes, input.name(), true);
    for (Vec3& p : result.mesh->mesh.nodes) p *= factor;
    return result;
  }
  result.surface = parse_surface(bytes, input.name());
  for (Vec3& p : result.surface.vertices) p *= factor;
  result.base = base_of(ply_comments(bytes), factor);
  return result;
}

Surface read_outside(Input& input) {
  const std::string bytes = input.read_all();
  const Recognised found = recognise(bytes);
  require_body(bytes, input.name(), found);
  if (found.content == Content::kTetrahedra)
    return boundary_surface(parse_mesh(bytes, input.name(), false).mesh);
  return parse_surface(bytes, input.name());
}

}  // namespace hapsim
