// How right the stiffness of a contact position is: the graded mesh that the models are made of
// against one with half its element size, on a block, a ball and an uneven lump. Prints one row an
// object and Poisson's ratio: largest and typical error of the normal and sideways stiffness, and
// in how many positions the stated mesh uncertainty covers the error.
//
//   bench_contact_accuracy [positions an object, default 20]
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdlib>
#include <vector>

#include "base/random.h"
#include "fem/contact_library.h"
#include "geometry/body_mesh.h"
#include "linalg/blas.h"
#include "support/block_mesh.h"
#include "support/objects.h"

namespace {

using namespace hapsim;

constexpr double kToolRadius = 0.004;  // [m]
constexpr double kLimit = 0.015;       // relative error that is asked for
constexpr double kReferenceEdge = kRimEdge / 2;

struct Object {
  const char* name;
  TetMesh body;
};

TetMesh body_of(const Surface& surface) {
  BodyOptions options;
  options.preserve_surface = true;
  return make_body_mesh(surface, options);
}

// Random points of the upper surface, three radii away from the base and from sharp edges.
std::vector<Vec3> positions_on(const TetMesh& body, int count, std::uint64_t seed) {
  const Surface surface = boundary_surface(body);
  Random random(seed);
  std::vector<Vec3> chosen;
  while (static_cast<int>(chosen.size()) < count) {
    const auto face = static_cast<int>(random.integer(surface.faces.size()));
    const Triangle& t = surface.faces[face];
    const double a = std::sqrt(random.uniform()), b = random.uniform();
    const Vec3 p = (1 - a) * surface.vertices[t[0]] + a * (1 - b) * surface.vertices[t[1]] +
                   a * b * surface.vertices[t[2]];
    const Vec3 n = face_normal(surface, face).normalized();
    if (p.z() < 3 * kToolRadius || n.z() < 0.2) continue;
    bool near_edge = false;
    for (std::size_t f = 0; f < surface.faces.size() && !near_edge; ++f)
      if (face_normal(surface, static_cast<int>(f)).normalized().dot(n) < 0.3)
        for (const int v : surface.faces[f])
          near_edge = near_edge || (surface.vertices[v] - p).norm() < 3 * kToolRadius;
    if (!near_edge) chosen.push_back(p);
  }
  return chosen;
}

}  // namespace

int main(int argc, char** argv) {
  const int count = argc > 1 ? std::atoi(argv[1]) : 20;
  std::vector<Object> objects;
  objects.push_back({"block", test::block_mesh({0.12, 0.21, 0.06}, 12, 21, 6, 1)});
  objects.push_back({"ball", body_of(test::half_ball())});
  objects.push_back({"lump", body_of(test::lump())});
  fmt::print("blas: {}; tool radius {} m; {} positions an object\n", blas_name(), kToolRadius,
             count);
  fmt::print("{:6} {:>5} {:>10} {:>10} {:>10} {:>10} {:>9} {:>9} {:>9}\n", "object", "nu",
             "max normal", "rms normal", "max side", "stated", "covered", "in 1.5 %", "elements");
  int covered_of_all = 0, all = 0;
  for (const Object& object : objects) {
    const ContactBase base = make_contact_base(object.body);
    const std::vector<Vec3> positions = positions_on(object.body, count, 5);
    std::size_t elements = 0;
    for (const Vec3& p : positions)
      elements = std::max(elements,
                          make_contact_mesh(base, p, kToolRadius, kRimEdge * kToolRadius, kGrowth)
                              .mesh.tets.size());
    for (const double nu : {0.3, 0.45}) {
      ContactLibraryOptions options;
      const auto usual =
          ContactLibrary(object.body, kToolRadius, options).prepare(positions, nu, nu);
      options.rim_edge = kReferenceEdge;
      const auto finer =
          ContactLibrary(object.body, kToolRadius, options).prepare(positions, nu, nu);
      double worst = 0, squares = 0, worst_side = 0, stated = 0;
      int covered = 0, good = 0;
      for (std::size_t p = 0; p < positions.size(); ++p) {
        Eigen::Matrix3d K, R, unused;
        usual[p].stiffness.evaluate(nu, K, unused);
        finer[p].stiffness.evaluate(nu, R, unused);
        const Vec3 n = usual[p].normal, s = n.unitOrthogonal();
        const double error = n.dot(K * n) / n.dot(R * n) - 1;
        worst = std::max(worst, std::abs(error));
        squares += error * error;
        worst_side = std::max(worst_side, std::abs(s.dot(K * s) / s.dot(R * s) - 1));
        stated = std::max(stated, usual[p].mesh_uncertainty);
        covered += std::abs(error) <= usual[p].mesh_uncertainty;
        good += std::abs(error) <= kLimit;
      }
      covered_of_all += covered;
      all += count;
      fmt::print("{:6} {:5.2f} {:9.2f}% {:9.2f}% {:9.2f}% {:9.2f}% {:5}/{:<3} {:5}/{:<3} {:9}\n",
                 object.name, nu, 100 * worst, 100 * std::sqrt(squares / count), 100 * worst_side,
                 100 * stated, covered, count, good, count, elements);
      std::fflush(stdout);
    }
  }
  fmt::print("the stated uncertainty covers the error in {} of {}\n", covered_of_all, all);
}
