#include "formats/body_input.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "containers/ply.h"
#include "containers/text_scanner.h"
#include "formats/format_table.h"
#include "formats/surface_io.h"
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
  result.window = window_of(ply_comments(bytes), factor);
  return result;
}

void require_metres(const BodyInput& body, const std::string& where) {
  constexpr double kLargest = 10;
  double largest = 0;
  for (const Vec3& p : body.mesh ? body.mesh->mesh.nodes : body.surface.vertices)
    largest = std::max(largest, p.cwiseAbs().maxCoeff());
  if (largest > kLargest)
    fail_input(where, fmt::format("coordinates reach {:.6g} m", largest),
               "give --unit mm if these are millimetres");
}

void put_on_base(Support& support, const BodyInput& body) {
  if (!body.base) return;
  for (Support& other : support.also) put_on_base(other, body);
  if (support.kind != SupportKind::kBottom) return;
  support.kind = body.base->kind;
  support.normal = body.base->normal;
  support.z = body.base->z;
}

std::string mended_words(const MeshRepairs& r) {
  if (r.unused_nodes + r.turned + r.doubled == 0) return "";
  return fmt::format(
      "mended: {} nodes of no tetrahedron and {} doubled tetrahedra dropped, {} "
      "inverted ones turned",
      r.unused_nodes, r.doubled, r.turned);
}

Surface read_outside(Input& input, std::optional<TetMesh>* mesh) {
  const std::string bytes = input.read_all();
  const Recognised found = recognise(bytes);
  require_body(bytes, input.name(), found);
  if (found.content == Content::kTetrahedra) {
    MeshFile file = parse_mesh(bytes, input.name(), false);
    Surface outside = boundary_surface(file.mesh);
    if (mesh != nullptr) *mesh = std::move(file.mesh);
    return outside;
  }
  return parse_surface(bytes, input.name());
}

}  // namespace hapsim
