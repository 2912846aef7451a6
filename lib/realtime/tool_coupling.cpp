#include "realtime/tool_coupling.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "contact/feature_zone.h"
#include "experiment/forces.h"
#include "experiment/labels.h"
#include "experiment/nearest_region.h"
#include "realtime/half_space_surface.h"
#include "realtime/insert_vertex.h"
#include "solid/inhomogeneity.h"
#include "solid/surface_compliance.h"

namespace hapsim {
namespace {

// Larger bodies are condensed in first order.
constexpr std::size_t kMostSecondOrder = 20000;
// Distances below this share of a tool's radius count as it: tools do not lie in each other.
constexpr double kLeastDistance = 0.2;

TetMesh condensed_mesh(const TetMesh& body, bool second_order) {
  TetMesh mesh = body;
  mesh.order = 1;
  for (auto& t : mesh.tets) std::fill(t.begin() + 4, t.end(), -1);
  if (!second_order) return mesh;
  // Middles that the body had are nodes that no element uses: they are left out.
  std::vector<int> number(mesh.nodes.size(), -1);
  TetMesh corners;
  for (auto& t : mesh.tets)
    for (int k = 0; k < 4; ++k) {
      int& n = number[static_cast<std::size_t>(t[k])];
      if (n < 0) {
        n = static_cast<int>(corners.nodes.size());
        corners.nodes.push_back(mesh.nodes[t[k]]);
        corners.fixed.push_back(mesh.fixed[t[k]]);
      }
      t[k] = n;
    }
  corners.tets = std::move(mesh.tets);
  corners.region = std::move(mesh.region);
  corners.faces = boundary_faces(corners);
  return to_second_order(corners);
}

double region_modulus(const MaterialSpec& material, const BodyRegions* labels, const Vec3& p) {
  const int region = labels != nullptr ? labels->at(p) : region_at(material, p);
  return material.modulus[static_cast<std::size_t>(region)];
}

std::vector<Lame> constants_of(const TetMesh& mesh, const MaterialSpec& material, bool apart) {
  std::vector<double> modulus(mesh.tets.size(), 1.0);
  if (!apart)
    for (std::size_t t = 0; t < modulus.size(); ++t)
      modulus[t] = material.modulus[static_cast<std::size_t>(region_of_tet(material, mesh, t))];
  std::shared_ptr<const SurfaceTree> outside;
  for (const FeatureSpec& f : material.features) {
    if (!outside) outside = free_surface(make_contact_base(mesh));
    const std::vector<double> factors = stiffness_factors(
        inside_shares(mesh, zone_level(f.feature, outside)).share, f.feature.value.back());
    for (std::size_t t = 0; t < modulus.size(); ++t) modulus[t] *= factors[t];
  }
  const Lame unit = lame(1, material.nu);
  std::vector<Lame> constants;
  for (const double E : modulus) constants.push_back({E * unit.lambda, E * unit.mu});
  return constants;
}

// What a point at `arm` from a patch's centre, in its plane, has to do with the patch's motion: a
// share of its mean, and of its turn, m points at this distance each.
Eigen::Matrix<double, 6, 3> turn_share(const Vec3& arm, const Vec3& normal, double m) {
  // Force at the point of a unit moment along axis k: (2 M_t + M_n) x arm / (m |arm|^2).
  Eigen::Matrix<double, 6, 3> share = Eigen::Matrix<double, 6, 3>::Zero();
  for (int k = 0; k < 3; ++k) {
    const Vec3 M = Vec3::Unit(k), along = M.dot(normal) * normal;
    share.row(3 + k) = (2 * (M - along) + along).cross(arm) / (m * arm.squaredNorm());
  }
  return share;
}

void require_shown(const MaterialSpec& material, const std::string& name) {
  if (material.shift != Vec3::Zero() || material.rotation != Vec3::Zero())
    fail_input(name, "the body has moved, which its own mesh does not know",
               "move the mesh, or press with one tool");
  for (const FeatureSpec& f : material.features)
    if (!is_zone(f.feature.kind))
      fail_input(name,
                 "how the tools press on each other is not known for the body's support or "
                 "direction in this model",
                 "press with one tool, or simulate with --full");
}

}  // namespace

ToolCoupling::ToolCoupling(const TetMesh& body, const Model& model, double tool_radius, int threads)
    : radius_(tool_radius) {
  const MaterialSpec material = material_of(model);
  nu_ = material.nu;
  require_shown(material, model.name);
  apart_ = material.local || material.modulus.size() == 1;
  second_order_ = body.tets.size() <= kMostSecondOrder;
  const TetMesh mesh = condensed_mesh(body, second_order_);
  SurfaceCompliance compliance(mesh, second_order_ ? Dilatation::kElement : Dilatation::kPointwise,
                               SurfaceNodes::kCorners);
  compliance.factorise(constants_of(mesh, material, apart_), threads);
  std::vector<int> node;
  surface_ = std::make_unique<SignedDistance>(boundary_surface(mesh, &node), "body");
  const Surface& surface = surface_->surface();
  const std::size_t count = node.size();
  const auto labels = apart_ ? nullptr : acting_labels(material, mesh);
  for (const int n : node)
    corner_modulus_.push_back(apart_ ? 1 : region_modulus(material, labels.get(), mesh.nodes[n]));
  const auto size = 3 * static_cast<Eigen::Index>(count);
  beyond_.setZero(size, size);
  const auto block = [&](std::size_t i, std::size_t j) {
    return beyond_.block<3, 3>(3 * static_cast<Eigen::Index>(i), 3 * static_cast<Eigen::Index>(j));
  };
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t j = 0; j < count; ++j) {
      if (i == j) continue;
      const int a = compliance.index_of(node[i]), b = compliance.index_of(node[j]);
      if (a >= 0 && b >= 0) block(i, j) = compliance.block(a, b);
      block(i, j) -= half_space_surface(nu_, surface.vertices[i], surface_->vertex_normal(i),
                                        surface.vertices[j], surface_->vertex_normal(j), 0) /
                     std::sqrt(corner_modulus_[i] * corner_modulus_[j]);
    }
  // A place by itself: the mean of it with its neighbours, whose slopes cancel.
  std::vector<double> neighbours(count, 0);
  for (const Triangle& f : surface.faces)
    for (int k = 0; k < 3; ++k) {
      const auto i = static_cast<std::size_t>(f[k]), j = static_cast<std::size_t>(f[(k + 1) % 3]);
      block(i, i) += 0.5 * (block(i, j) + block(j, i));
      ++neighbours[i];
    }
  for (std::size_t i = 0; i < count; ++i) block(i, i) /= neighbours[i];
}

ToolCoupling::Patch ToolCoupling::patch(const Vec3& point, const Vec3& normal,
                                        double modulus) const noexcept {
  Patch p;
  p.point = point;
  p.normal = normal;
  p.modulus = modulus;
  const Surface& surface = surface_->surface();
  const SurfaceSide side = surface_->at(point);
  p.vertex = surface.faces[side.face];
  const auto corner = [&](int k) -> const Vec3& { return surface.vertices[p.vertex[k % 3]]; };
  const Vec3 weight = corner_weights(side.point, corner(0), corner(1), corner(2)).cwiseMax(0.0);
  const Vec3 area = (corner(1) - corner(0)).cross(corner(2) - corner(0));
  const Vec3 first = normal.unitOrthogonal(), second = normal.cross(first);
  constexpr int m = 4;
  for (int q = 0; q < m; ++q) {
    const double angle = 0.5 * std::numbers::pi * q;
    const Vec3 arm = std::cos(angle) * first + std::sin(angle) * second;
    // Radii of gyration of the two tractions.
    const Vec3 moved = std::sqrt(2.0 / 3) * radius_ * arm, turned = std::sqrt(0.8) * radius_ * arm;
    p.ring[q] = point + moved;
    p.of_ring[q].setZero();
    p.of_ring[q].topRows<3>().setIdentity();
    p.of_ring[q] /= m;
    p.ring[m + q] = point + turned;
    p.of_ring[m + q] = turn_share(turned, normal, m);
  }
  for (int k = 0; k < 3; ++k) {
    p.of_corner[k].setZero();
    p.of_corner[k].topRows<3>() = weight[k] / weight.sum() * Eigen::Matrix3d::Identity();
    // Gradient of the corner's weight in its face.
    const Vec3 slope = area.cross(corner(k + 2) - corner(k + 1)) / area.squaredNorm();
    for (int q = 0; q < m; ++q)
      p.of_corner[k] += slope.dot(p.ring[m + q] - point) * p.of_ring[m + q];
  }
  return p;
}

Matrix6 ToolCoupling::between(const Patch& a, const Patch& b) const noexcept {
  Matrix6 motion = Matrix6::Zero();
  const double least = kLeastDistance * radius_;
  for (std::size_t p = 0; p < b.ring.size(); ++p) {
    Eigen::Matrix<double, 6, 3> of = Eigen::Matrix<double, 6, 3>::Zero();
    for (std::size_t q = 0; q < a.ring.size(); ++q)
      of += a.of_ring[q] * half_space_surface(nu_, a.ring[q], a.normal, b.ring[p], b.normal, least);
    motion += of * b.of_ring[p].transpose();
  }
  const double modulus = std::sqrt(a.modulus * b.modulus);
  motion /= modulus;
  const double scale = apart_ ? 1 / modulus : 1;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      motion += scale * (a.of_corner[i] * beyond_half_space(a.vertex[i], b.vertex[j]) *
                         b.of_corner[j].transpose());
  return motion;
}

}  // namespace hapsim
