// Contact positions on a body and their stiffness on meshes with half of every length (or
// another share): what models
// and fits are measured against, in benchmarks.
#pragma once

#include <algorithm>
#include <atomic>
#include <cmath>
#include <thread>
#include <vector>

#include "base/random.h"
#include "contact/contact_stiffness.h"
#include "contact/featured_body.h"
#include "tetmesh/body_mesh.h"

namespace hapsim::test {

constexpr double kFiner = 2;

// Random points of the upper surface, three tool radii away from the base and from sharp edges.
inline std::vector<Vec3> positions_on(const TetMesh& body, int count, std::uint64_t seed,
                                      double tool_radius) {
  const Surface surface = boundary_surface(body);
  double floor = 1e300;
  for (const Vec3& v : surface.vertices) floor = std::min(floor, v.z());
  std::vector<double> area_up_to;
  for (std::size_t f = 0; f < surface.faces.size(); ++f)
    area_up_to.push_back((f > 0 ? area_up_to.back() : 0) +
                         face_normal(surface, static_cast<int>(f)).norm());
  Random random(seed);
  std::vector<Vec3> chosen;
  while (static_cast<int>(chosen.size()) < count) {
    const auto face = static_cast<int>(std::upper_bound(area_up_to.begin(), area_up_to.end() - 1,
                                                        random.uniform() * area_up_to.back()) -
                                       area_up_to.begin());
    const Triangle& t = surface.faces[face];
    const double a = std::sqrt(random.uniform()), b = random.uniform();
    const Vec3 p = (1 - a) * surface.vertices[t[0]] + a * (1 - b) * surface.vertices[t[1]] +
                   a * b * surface.vertices[t[2]];
    const Vec3 n = face_normal(surface, face).normalized();
    if (p.z() < floor + 3 * tool_radius || n.z() < 0.2) continue;
    bool near_edge = false;
    for (std::size_t f = 0; f < surface.faces.size() && !near_edge; ++f)
      if (face_normal(surface, static_cast<int>(f)).normalized().dot(n) < 0.3)
        for (const int v : surface.faces[f])
          near_edge = near_edge || (surface.vertices[v] - p).norm() < 3 * tool_radius;
    if (!near_edge) chosen.push_back(p);
  }
  return chosen;
}

// The surface of the body, coarsened half as much as a model's.
inline ContactBase finer_base(const TetMesh& body, double finer = kFiner) {
  return make_contact_base(body, std::cbrt(3 * signed_volume(boundary_surface(body))) / 9 / finer);
}

inline ContactMesh finer_mesh(const ContactBase& base, const Vec3& position, double tool_radius,
                              double finer = kFiner) {
  return make_contact_mesh(base, position, tool_radius, kRimEdge / finer * tool_radius,
                           kGrowth / finer);
}

// The stiffness of each position for one material [N/m], on two threads.
inline std::vector<Eigen::Matrix3d> finer_stiffness(const ContactBase& base,
                                                    const std::vector<Vec3>& positions,
                                                    double tool_radius, const Material& material,
                                                    double finer = kFiner) {
  const auto surface = free_surface(base);
  std::vector<Eigen::Matrix3d> K(positions.size());
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t p = next++; p < positions.size(); p = next++) {
      const ContactMesh contact = finer_mesh(base, positions[p], tool_radius, finer);
      K[p] = FeaturedBody(contact, surface).solve(material).K;
    }
  };
  std::thread other(work);
  work();
  other.join();
  return K;
}

}  // namespace hapsim::test
