// How a spherical tip's contact grows with depth, and what the rings of its contact carry: private
// to the effect `tip`.
#pragma once

#include <algorithm>
#include <cstddef>

#include "effects/local_contact.h"

namespace hapsim::tip {

// Contact radius over the tool's, beta = min(1, sqrt(z/kappa)/a), at depth z; its integral from 0,
// which is the mean stiffness times z; and the derivatives of both.
struct Growth {
  double beta = 0, by_z = 0, by_kappa = 0;
  double integral = 0, integral_by_kappa = 0;
};
Growth growth(double z, double kappa, double a);

// Mean of beta between two depths, and its derivatives.
struct MeanGrowth {
  double value = 0, by_low = 0, by_high = 0, by_kappa = 0;
};
MeanGrowth mean_growth(double low, double high, double kappa, double a);

// A point of the way in: the ring of the tip that touches at depth z did so at the sideways place
// `side`, when the tangential force over k_t was `force`.
struct Ring {
  double z = 0;
  Vec3 side = Vec3::Zero(), force = Vec3::Zero();
};

// Tangential force over k_t at depth z and sideways place `side`.
struct Tangential {
  Vec3 value = Vec3::Zero(), by_z = Vec3::Zero();
  double by_side = 0;
  bool leaving = false;
  // Leaving: the ring at the contact's border, between which rings of the path it lies and how far.
  Ring touched;
  std::size_t segment = 0;
  double share = 0;
  MeanGrowth mean;
};

// A ring carries what the tool moved sideways since it touched, and lets go when it parts: the sum
// over the rings in contact. `path` runs from the first touch to the last sample, its depths do not
// fall.
template <class Path>
Tangential tangential(const Path& path, double z, const Vec3& side, double kappa, double a) {
  Tangential t;
  const Ring& last = path[path.size() - 1];
  if (z >= last.z) {
    const MeanGrowth mean = mean_growth(last.z, z, kappa, a);
    t.value = last.force + mean.value * (side - last.side);
    t.by_z = mean.by_high * (side - last.side);
    t.by_side = mean.value;
    return t;
  }
  std::size_t k = 0;  // the last ring that is not deeper, or the first of all
  for (std::size_t end = path.size(); end - k > 1;) {
    const std::size_t middle = k + (end - k) / 2;
    (path[middle].z > z ? end : k) = middle;
  }
  const Ring &low = path[k], &high = path[k + 1];
  t.leaving = true;
  t.segment = k;
  t.share = (z - low.z) / (high.z - low.z);
  t.mean = mean_growth(low.z, z, kappa, a);
  t.touched.z = z;
  t.touched.side = low.side + t.share * (high.side - low.side);
  t.touched.force = low.force + t.mean.value * (t.touched.side - low.side);
  const Growth here = growth(z, kappa, a);
  t.value = t.touched.force + here.beta * (side - t.touched.side);
  t.by_z = here.by_z * (side - t.touched.side);
  t.by_side = here.beta;
  return t;
}

// The tip on the way `path` into the material.
template <class Path>
struct TipLaw {
  const Path& path;
  const LocalContact& contact;
  const Vec3& n;
  double kappa, a;
  Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - n * n.transpose();

  LocalForce operator()(const Vec3& x) const {
    LocalForce f;
    const double z = -x.dot(n), k_n = contact.disc().normal, k_t = contact.disc().tangential;
    if (z <= 0) return f;
    const Growth g = growth(z, kappa, a);
    const Tangential t = tangential(path, z, across * x, kappa, a);
    f.F = k_t * t.value - k_n * g.integral * n;
    f.tangent =
        k_n * g.beta * n * n.transpose() + k_t * t.by_side * across - k_t * t.by_z * n.transpose();
    return f;
  }
};

// The sideways place where the straight way from `before`, in the air, to u crosses the surface.
struct FirstTouch {
  double above = 0, all = 0, share = 0;
  Vec3 side = Vec3::Zero();
};
FirstTouch first_touch(const Vec3& n, const Vec3& before, const Vec3& u);

}  // namespace hapsim::tip
