// A surface under tension against closed forms.
#include "solid/membrane.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "mesh/tetmesh.h"
#include "support/block_mesh.h"

namespace hapsim {
namespace {

// Energy of a displacement of the nodes under unit tension of some faces.
template <class Field>
double energy(const TetMesh& mesh, const std::vector<MembraneFace>& faces, const Field& field) {
  double sum = 0;
  for (const MembraneFace& face : faces) {
    Eigen::VectorXd u(3 * static_cast<Eigen::Index>(face.nodes.size()));
    for (std::size_t a = 0; a < face.nodes.size(); ++a)
      u.segment<3>(3 * static_cast<Eigen::Index>(a)) = field(mesh.nodes[face.nodes[a]]);
    sum += 0.5 * u.dot(face.matrix * u);
  }
  return sum;
}

std::vector<Triangle> top_of(const TetMesh& mesh, double height) {
  std::vector<Triangle> top;
  for (const Triangle& f : boundary_faces(mesh))
    if (std::all_of(f.begin(), f.end(),
                    [&](int n) { return std::abs(mesh.nodes[n].z() - height) < 1e-9; }))
      top.push_back(f);
  return top;
}

// Slopes of a plane: half of the sum of their squares an area; what moves along the face, as one,
// or only changes across it, costs nothing.
TEST(Membrane, CostsTheSlopeAlongIt) {
  for (const int order : {1, 2}) {
    const TetMesh mesh = test::block_mesh({0.06, 0.04, 0.02}, 6, 4, 2, order);
    const auto faces = membrane_faces(mesh, top_of(mesh, 0.02));
    const double area = 0.06 * 0.04;
    const auto of = [&](const auto& field) { return energy(mesh, faces, field); };
    EXPECT_NEAR(of([](const Vec3& x) { return Vec3(0, 0, 0.3 * x.x() - 0.4 * x.y()); }),
                0.5 * 0.25 * area, 1e-12);
    EXPECT_NEAR(of([](const Vec3& x) { return Vec3(0.3 * x.y(), 0.1 * x.x(), 0); }), 0, 1e-12);
    EXPECT_NEAR(of([](const Vec3& x) { return Vec3(1, 2, 3 + 0.5 * x.z()); }), 0, 1e-12);
  }
}

// A disc of radius a that is pushed a unit way through a membrane held at radius b costs
// T pi / ln(b/a): the exact field, interpolated.
TEST(Membrane, ARingCarriesItsDisc) {
  const double a = 0.01, b = 0.03, exact = M_PI / std::log(b / a);
  const auto error = [&](int order, int n) {
    const TetMesh mesh = test::block_mesh({0.06, 0.06, 0.01}, n, n, 1, order);
    const auto faces = membrane_faces(mesh, top_of(mesh, 0.01));
    return std::abs(energy(mesh, faces,
                           [&](const Vec3& x) {
                             const double r = std::hypot(x.x() - 0.03, x.y() - 0.03);
                             return Vec3(0, 0, std::log(std::clamp(r, a, b) / b) / std::log(a / b));
                           }) -
                    exact);
  };
  for (const int order : {1, 2}) {
    std::printf("order %d: %.4f %.4f %.4f of %.4f\n", order, error(order, 12), error(order, 24),
                error(order, 48), exact);
    EXPECT_LT(error(order, 48), 0.02 * exact);
  }
}

}  // namespace
}  // namespace hapsim
