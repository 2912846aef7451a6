// A place of a body pressed by a flat tool that slips, by elements: what its friction is told by.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "contact/contact_stiffness.h"
#include "mesh/tetmesh.h"
#include "model/model.h"
#include "realtime/strain_sample.h"

namespace hapsim {

// A way of the tool from no displacement, or from a step of another motion on.
struct SlipMotion {
  int after = -1, from = 0;  // of that: which, and how many of its steps; -1: from the beginning
  // In the sample's frame: depth and ways aside in tool radii; forces that move the tool, less the
  // sideways part of those that a tool which holds has straight down at the depth in the same
  // elements, over their normal part.
  std::vector<Vec3> way, force;
};

struct SlipPresses {
  static constexpr double kStep = 0.15;  // of depth, in tool radii
  double friction = 0;                   // Coulomb's coefficient
  std::vector<SlipMotion> motions;
  double doubt = 0;    // standard relative uncertainty of the forces, of the elements
  double deepest = 0;  // tool radii, to which each way in came
  double seen = 0;     // of mu N, how much the tool bore sideways at most

  std::string bytes() const;
  static std::optional<SlipPresses> read(const std::string& bytes);  // nothing: damaged
};

// Presses the place of a sample with friction: straight in and out again; in and aside as far as it
// slips, back and over; in while it is drawn aside so far that it hardly holds, and out the same
// way; and five ways from corner to corner that `seed` draws: without these the rings that are
// fitted are off by 2 % and more where a tool goes out after turns. As deep as elements of half a
// radius at the rim converge, the drawn ones to 0.68 radii; `finer`: and as those of a quarter do,
// by Richardson's extrapolation (without, ratios are 1 to 4 % off; with, straight in, within 0.5 %
// of what edges of 1/2 to 1/6 tend to). Takes some two minutes of a processor with finer ones (a
// block of 10,000 tetrahedra, nu 0.4; nearly incompressible ones longer).
// `held`: body and support, static; `slips`: and the effect that slips. Nothing where not even the
// first depths converge.
std::optional<SlipPresses> press_slipping(const TetMesh& body, const ContactBase& base,
                                          const Model& held, const Model& slips,
                                          const StrainSample& sample, double tool_radius,
                                          double friction, std::uint64_t seed, bool finer);

}  // namespace hapsim
