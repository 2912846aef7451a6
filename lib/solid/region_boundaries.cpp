// How the boundaries of a body's regions lie.
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <map>

#include "mesh/drop_unused.h"
#include "solid/body_regions.h"

namespace hapsim {

std::vector<std::pair<Vec3, double>> BodyRegions::across(const TetMesh& mesh, std::size_t t) const {
  constexpr double kLeast = 1e-3;  // of a weight
  const auto& n = mesh.tets[t];
  std::array<Vec3, 5> p{mesh.nodes[n[0]], mesh.nodes[n[1]], mesh.nodes[n[2]], mesh.nodes[n[3]],
                        Vec3::Zero()};
  for (std::size_t k = 0; k < 4; ++k) p[4] += p[k] / 4;
  Eigen::Matrix3d mean = Eigen::Matrix3d::Zero();
  for (const Vec3& at : p) {
    const SurfacePoint nearest = between_->nearest(at);
    Vec3 normal = at - nearest.point;
    if (!(normal.norm() > 1e-9)) normal = face_normal(between_->surface(), nearest.face);
    normal.normalize();
    mean += normal * normal.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> principal(mean);
  const Vec3 weight = principal.eigenvalues() / principal.eigenvalues().sum();
  std::vector<std::pair<Vec3, double>> result;
  double sum = 0;
  for (int k = 0; k < 3; ++k) {
    if (!(weight[k] > kLeast)) continue;
    result.emplace_back(principal.eigenvectors().col(k), weight[k]);
    sum += weight[k];
  }
  for (auto& [direction, share] : result) share /= sum;
  return result;
}

std::vector<Surface> BodyRegions::enclosed() const {
  const Surface& all = between_->surface();
  // Faces that share an edge are of one boundary: each edge has two.
  std::map<std::pair<int, int>, std::vector<int>> at_edge;
  for (std::size_t f = 0; f < all.faces.size(); ++f)
    for (int k = 0; k < 3; ++k)
      at_edge[std::minmax({all.faces[f][k], all.faces[f][(k + 1) % 3]})].push_back(
          static_cast<int>(f));
  for (const auto& [edge, faces] : at_edge)
    if (faces.size() != 2) return {};  // it ends at the body's surface, or a third region begins
  std::vector<char> taken(all.faces.size(), 0);
  std::vector<Surface> result;
  for (std::size_t first = 0; first < all.faces.size(); ++first) {
    if (taken[first]) continue;
    Surface part;
    part.vertices = all.vertices;
    std::vector<int> open{static_cast<int>(first)};
    taken[first] = 1;
    const int side = sides_[first].first;
    while (!open.empty()) {
      const auto f = static_cast<std::size_t>(open.back());
      open.pop_back();
      Triangle face = all.faces[f];
      if (sides_[f].first != side) std::swap(face[1], face[2]);
      part.faces.push_back(face);
      for (int k = 0; k < 3; ++k)
        for (const int next : at_edge[std::minmax({face[k], face[(k + 1) % 3]})])
          if (!taken[static_cast<std::size_t>(next)]) {
            taken[static_cast<std::size_t>(next)] = 1;
            open.push_back(next);
          }
    }
    drop_unused(part);
    if (signed_volume(part) < 0)
      for (Triangle& face : part.faces) std::swap(face[1], face[2]);
    if (!is_closed(part)) return {};
    result.push_back(std::move(part));
  }
  return result;
}

}  // namespace hapsim
