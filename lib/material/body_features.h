// What makes a body more than one isotropic solid on a rigid base.
#pragma once

#include <vector>

#include "base/vec3.h"

namespace hapsim {

// Values in this order, SI units. The identity does nothing.
enum class Feature {
  // A skin under the free surface (what is not bonded): thickness [m], modulus over that below.
  kLayer,
  // A ball inside: centre x, y, z [m], radius [m], modulus over that around it.
  kInclusion,
  // Transverse isotropy (hooke_law.h): Ea/Ep; Ga over sqrt(Ea Ep) / (2 (1 + nu)); the axis's angle
  // to z and its azimuth from x [rad]. The body's modulus is Ep, nup = nu, nua = nu sqrt(Ea/Ep): of
  // positive energy for every nu below 0.5.
  kTransverse,
  // A support that gives (foundation.h) where the plan view's coordinate along the azimuth, from
  // the middle of the base, exceeds the edge: give [m], azimuth [rad], edge [m]. A give of h is a
  // bed of modulus E and of thickness h: k_n = E/h, k_t = E/(3 h); a large one is no support.
  kSupport,
  // A tension of the free surface before the press, the same along every direction of it: over the
  // body's modulus (of region 0) [m].
  kTension,
  // A region of the body's numbered tetrahedra whose boundary lies further out: its number, by how
  // much along the boundary's normals [m].
  kGrowth,
};

struct BodyFeature {
  Feature kind = Feature::kLayer;
  std::vector<double> value;
};

std::size_t feature_size(Feature kind);

}  // namespace hapsim
