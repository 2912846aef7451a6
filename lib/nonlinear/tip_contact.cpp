#include "nonlinear/tip_contact.h"

#include <Eigen/Geometry>
#include <cmath>

namespace hapsim {

using Eigen::Index;
using Eigen::VectorXd;

TipContact::TipContact(const TetMesh& mesh, const SphericalTip& tip, bool small)
    : tip_(tip),
      small_(small),
      surface_(mesh, tip.point, tip.normal.normalized(), tip.reach),
      unknowns_(3 * static_cast<Index>(mesh.nodes.size())) {
  tip_.normal.normalize();
  axis_[0] = tip_.normal.unitOrthogonal();
  axis_[1] = tip_.normal.cross(axis_[0]);
  start_ = VectorXd::Zero(unknowns_);
  evaluate(start_, Vec3::Zero());
}

Vec3 TipContact::displacement(const TipSurface::Point& p, const VectorXd& u) const {
  Vec3 sum = Vec3::Zero();
  const std::vector<int>& nodes = surface_.faces[p.face];
  for (std::size_t a = 0; a < nodes.size(); ++a)
    sum += p.shape[a] * u.segment<3>(3 * static_cast<Index>(nodes[a]));
  return sum;
}

void TipContact::mark(const VectorXd& u, const Vec3& motion) {
  start_ = u;
  start_motion_ = motion;
}

void TipContact::evaluate(const VectorXd& u, const Vec3& motion) {
  const Vec3 down = -tip_.normal;
  const Vec3 lowest = tip_.point + motion;
  const auto count = static_cast<std::size_t>(hats());
  give_ = 0;
  std::vector<Vec3> away(surface_.points.size());  // from the tip into the body, at each point
  std::vector<Vec3> mean(count, Vec3::Zero());
  std::vector<double> gap(surface_.points.size());
  for (std::size_t q = 0; q < surface_.points.size(); ++q) {
    const TipSurface::Point& p = surface_.points[q];
    const Vec3 moved = displacement(p, u);
    give_ = std::max(give_, std::abs(moved.dot(tip_.normal)));
    if (tip_.flat()) {
      away[q] = down;
      gap[q] = (motion - moved).dot(tip_.normal);
    } else if (small_) {
      const Vec3 x = p.position - tip_.point;
      const double z = x.dot(tip_.normal);
      away[q] = down;
      gap[q] = sphere_height(tip_.radius, (x - z * tip_.normal).norm()).height - z +
               (motion - moved).dot(tip_.normal);
    } else {
      // The distance from the centre less the radius, without their cancellation.
      const Vec3 d = p.position + moved - lowest, x = d + tip_.radius * down;
      const double distance = x.norm();
      away[q] = distance > 0 ? Vec3(x / distance) : down;
      gap[q] = (d.squaredNorm() + 2 * tip_.radius * d.dot(down)) / (distance + tip_.radius);
    }
    for (std::size_t i = 0; i < 3; ++i) mean[p.hat[i]] += p.area * p.corner[i] * away[q];
  }
  std::vector<std::array<Vec3, 2>> tangent(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 n = mean[i].norm() > 0 ? Vec3(mean[i].normalized()) : down;
    tangent[i][0] = (axis_[0] - n.dot(axis_[0]) * n).normalized();
    tangent[i][1] = n.cross(tangent[i][0]);
  }
  apart_ = VectorXd::Zero(3 * static_cast<Index>(count));
  const bool same = small_ && directions_.nonZeros() > 0;
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t q = 0; q < surface_.points.size(); ++q) {
    const TipSurface::Point& p = surface_.points[q];
    const std::vector<int>& nodes = surface_.faces[p.face];
    const Vec3 slip = displacement(p, u) - displacement(p, start_) - (motion - start_motion_);
    for (std::size_t i = 0; i < 3; ++i) {
      const int h = p.hat[i];
      const double share = p.area * p.corner[i];
      apart_[3 * h] += share * gap[q];
      for (int k = 0; k < 2; ++k) apart_[3 * h + 1 + k] += share * tangent[h][k].dot(slip);
      if (same) continue;
      for (std::size_t a = 0; a < nodes.size(); ++a)
        for (int c = 0; c < 3; ++c) {
          const Index row = 3 * static_cast<Index>(nodes[a]) + c;
          const double weight = share * p.shape[a];
          entries.emplace_back(row, 3 * h, weight * away[q][c]);
          for (int k = 0; k < 2; ++k)
            entries.emplace_back(row, 3 * h + 1 + k, weight * tangent[h][k][c]);
        }
    }
  }
  if (same) return;
  directions_.resize(unknowns_, apart_.size());
  directions_.setFromTriplets(entries.begin(), entries.end());
}

Vec3 TipContact::force(const VectorXd& traction) const {
  const VectorXd nodal = directions_ * traction;
  return Eigen::Map<const Eigen::Matrix<double, 3, Eigen::Dynamic>>(nodal.data(), 3, unknowns_ / 3)
      .rowwise()
      .sum();
}

double TipContact::contact_radius(const VectorXd& traction) const {
  double force = 0, moment = 0;
  for (const TipSurface::Point& p : surface_.points) {
    const Vec3 x = p.position - tip_.point;
    const double r2 = (x - x.dot(tip_.normal) * tip_.normal).squaredNorm();
    for (std::size_t i = 0; i < 3; ++i) {
      const double share = p.area * p.corner[i] * traction[3 * p.hat[i]];
      force += share;
      moment += share * r2;
    }
  }
  return force > 0 ? std::sqrt(2.5 * moment / force) : 0;
}

bool TipContact::at_rim(const VectorXd& traction) const {
  if (tip_.flat()) return false;
  for (Index i = 0; i < surface_.area.size(); ++i)
    if (surface_.rim[static_cast<std::size_t>(i)] && traction[3 * i] > 0) return true;
  return false;
}

}  // namespace hapsim
