#include "realtime/far_compliance.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "realtime/half_space_surface.h"
#include "solid/surface_compliance.h"
#include "tetmesh/even_mesh.h"

namespace hapsim {
namespace {

// Corners about a place so far off, in edges, speak for it: some twenty.
constexpr double kReach = 2.5;

std::vector<Lame> constants_of(const TetMesh& mesh, const Material& material) {
  const Lame unit = lame(1, material.nu);
  std::vector<Lame> constants;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const double E = material.modulus[material.group_at(tet_centroid(mesh, t))];
    constants.push_back({E * unit.lambda, E * unit.mu});
  }
  return constants;
}

}  // namespace

FarCompliance::FarCompliance(const ContactBase& base, double tool_radius, const Material& material,
                             int threads) {
  // Even triangles of edge e about kCorners corners, each of area sqrt(3) / 2 e^2.
  const double edge =
      std::max(std::sqrt(surface_area(base.fine) / (0.866 * kCorners)), tool_radius);
  reach_ = kReach * edge;
  const TetMesh mesh = make_even_mesh(base, edge);
  SurfaceCompliance compliance(mesh, Dilatation::kElement, SurfaceNodes::kCorners);
  compliance.factorise(constants_of(mesh, material), threads);
  std::vector<int> node;
  const Surface surface = boundary_surface(mesh, &node);
  corners_ = surface.vertices;
  areas_.assign(corners_.size(), 0);
  normals_.assign(corners_.size(), Vec3::Zero());
  for (std::size_t f = 0; f < surface.faces.size(); ++f) {
    const Vec3 n = face_normal(surface, static_cast<int>(f));
    for (const int v : surface.faces[f]) {
      areas_[static_cast<std::size_t>(v)] += n.norm() / 6;
      normals_[static_cast<std::size_t>(v)] += n;
    }
  }
  std::vector<double> root;  // of the modulus
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    normals_[i].normalize();
    root.push_back(std::sqrt(material.modulus[material.group_at(corners_[i])]));
  }
  const auto count = static_cast<Eigen::Index>(corners_.size());
  beyond_.setZero(3 * count, 3 * count);
  for (Eigen::Index i = 0; i < count; ++i)
    for (Eigen::Index j = 0; j < count; ++j) {
      if (i == j) continue;
      auto block = beyond_.block<3, 3>(3 * i, 3 * j);
      // Corners that are held do not move.
      const int a = compliance.index_of(node[i]), b = compliance.index_of(node[j]);
      if (a >= 0 && b >= 0) block = compliance.block(a, b);
      block -=
          half_space_surface(material.nu, corners_[i], normals_[i], corners_[j], normals_[j], 0) /
          (root[i] * root[j]);
    }
}

Eigen::Matrix3d FarCompliance::at(const Vec3& point, const Vec3& normal) const {
  std::vector<std::pair<Eigen::Index, double>> near;  // with their weights
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    const double square = (corners_[i] - point).squaredNorm() / (reach_ * reach_);
    const double facing = normals_[i].dot(normal);
    if (square < 1 && facing > 0)
      near.emplace_back(3 * static_cast<Eigen::Index>(i),
                        areas_[i] * facing * std::pow(1 - square, 2));
  }
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  double weights = 0;
  for (std::size_t a = 0; a < near.size(); ++a)
    for (std::size_t b = 0; b < a; ++b) {
      const double weight = near[a].second * near[b].second;
      sum += weight * beyond_.block<3, 3>(near[a].first, near[b].first);
      weights += weight;
    }
  if (!(weights > 0)) return Eigen::Matrix3d::Zero();
  return (sum + sum.transpose()) / (2 * weights);
}

}  // namespace hapsim
