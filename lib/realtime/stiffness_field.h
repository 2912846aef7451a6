// The stiffness of a body against a bonded tool anywhere on its surface, as a table to interpolate.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "solid/surface_compliance.h"

namespace hapsim {

// The compliance of a half-space under a bonded rigid disc [m/N], normal outward and unit: along it
// (1 - 2 nu) / (4 G a ln(3 - 4 nu)) (Mossakovskii, PMM 18, 1954), across it (2 - nu) / (8 G a)
// (Johnson, Contact Mechanics, 3.7 and 7.2).
Eigen::Matrix3d disc_compliance(double modulus, double nu, double radius, const Vec3& normal);

// A contact whose stiffness is known better than the body's own mesh gives it.
struct KnownStiffness {
  Vec3 point, normal;  // on the surface [m]; outward, unit
  Eigen::Matrix3d K;   // [N/m], symmetric positive definite
};

struct FieldMaterial {
  double nu = 0.3;
  std::function<double(const Vec3&)> modulus;  // E [Pa] about a place
  // The compliance was condensed for E = 1 everywhere: a contact feels its own place's modulus as
  // if the whole body had it.
  bool unit_compliance = false;
};

// One 3x3 stiffness a vertex, straight in between, so continuous on the whole surface. The body's
// mesh is coarser than the tool, so a vertex's stiffness is put together: the condensed compliance
// of the nodes under the tool, less that of a disc as large as the area these nodes stand for, plus
// that of the tool's own disc (a half-space's, steeper at edges by the solid angle of the body
// there). A vertex that is held keeps the last term only. Known contacts become vertices with their
// own stiffness; their correction S (symmetric, S K S is what is known) acts on the other vertices,
// turned into their normals, by inverse squares of the distances.
class StiffnessField {
 public:
  // `compliance` of `mesh` (first order), factorised. Error(kBadInput): a known contact off the
  // surface by more than a tenth of its size, or not positive definite. `like`: a field of another
  // material on the same mesh, whose choices are kept, so that the stiffness is a smooth function
  // of the material.
  StiffnessField(const TetMesh& mesh, const SurfaceCompliance& compliance,
                 const FieldMaterial& material, double tool_radius,
                 const std::vector<KnownStiffness>& known = {},
                 const StiffnessField* like = nullptr);

  // The body's boundary, split where contacts are known.
  const Surface& surface() const { return surface_; }
  const Eigen::Matrix3d& at_vertex(int vertex) const { return K_[vertex]; }
  // At a point of a face of surface() [N/m]; a table look-up: allocates and throws nothing.
  Eigen::Matrix3d at(int face, const Vec3& point) const noexcept;
  // Of the face's corners there: not negative, they sum to one.
  Vec3 weights(int face, const Vec3& point) const noexcept;

 private:
  void correct(const std::vector<KnownStiffness>& known);

  Surface surface_;
  std::vector<Eigen::Matrix3d> K_;
  std::vector<char> plain_;  // one a vertex of the mesh; 1: the nodes' own stiffness, no disc's
};

}  // namespace hapsim
