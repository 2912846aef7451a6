// A place of a body pressed by a flat tool that slips, by elements: what its friction is told by.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "contact/contact_stiffness.h"
#include "mesh/tetmesh.h"
#include "model/model.h"
#include "realtime/slip_ways.h"
#include "realtime/strain_sample.h"

namespace hapsim {

struct SlipPresses {
  double friction = 0;  // Coulomb's coefficient
  std::vector<SlipMotion> motions;
  // To where all meshes that are compared came, and to where the coarse ones alone did.
  double deepest = 0, coarse_deepest = 0;  // tool radii: straight in and drawn aside
  double doubt = 0, coarse_doubt = 0;      // standard relative uncertainty of forces there
  double seen = 0;                         // of mu N, how much the tool bore sideways at most

  std::string bytes() const;
  static std::optional<SlipPresses> read(const std::string& bytes);  // nothing: damaged
};

// Presses the place of a sample with friction along planned_slip_ways(), as deep as elements of
// half a radius at the rim converge; `finer`: as those of a quarter do, by Richardson's
// extrapolation (straight in, within 0.5 % of what edges of 1/2 to 1/6 tend to), and from where
// they end with the last correction. Without, ratios are 2 to 5 % off straight in, and `doubt` says
// so. Takes some four minutes of a processor with finer ones (a block of 10,000 tetrahedra, nu 0.4;
// nearly incompressible ones longer).
// `held`: body and support, static; `slips`: and the effect that slips. Nothing where not even the
// first depths converge.
std::optional<SlipPresses> press_slipping(const TetMesh& body, const ContactBase& base,
                                          const Model& held, const Model& slips,
                                          const StrainSample& sample, double tool_radius,
                                          double friction, std::uint64_t seed, bool finer);

}  // namespace hapsim
