#include "tetmesh/even_mesh.h"

#include "mesh/support.h"
#include "repair/coarsen.h"
#include "tetmesh/contact_patch.h"
#include "tetmesh/tetgen.h"

namespace hapsim {
namespace {

constexpr double kLongestEven = 1.6;  // edge length over the wished one

}  // namespace

TetMesh make_even_mesh(const ContactBase& base, double edge) {
  ClassedSurface even =
      coarsen_surface({base.fine, base.fine_fixed}, [edge](const Vec3&) { return edge; });
  even = split_long_edges(even, [edge](const Vec3&) { return kLongestEven * edge; });
  TetgenInput input;
  for (const std::uint8_t bonded : even.face_class)
    input.face_marker.push_back(bonded ? kBonded : kOther);
  input.surface = std::move(even.surface);
  TetgenOptions options;
  options.processor_time = true;
  const TetgenResult result = run_tetgen(input, options, "the body's coarse surface");
  TetMesh mesh = to_second_order(result.mesh);
  std::vector<std::uint8_t> bonded;
  for (const int m : result.face_marker) bonded.push_back(m == kBonded);
  fix_faces(mesh, bonded);
  return mesh;
}

}  // namespace hapsim
