// What friction under a flat tool takes from the force of one that holds, at finite strain.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "contact/contact_stiffness.h"
#include "mesh/tetmesh.h"
#include "model/model.h"
#include "realtime/strain_sample.h"

namespace hapsim {

// The rim slips long before the tool does, and what has slipped bears less. Depths in tool radii;
// the held tool's forces at the same depth are the unit. Sideways the contact is sliders side by
// side (Iwan, J. Appl. Mech. 33, 1966): slider j takes the share w_j of the held tool's force, and
// slips where that would be x_j mu N.
struct StrainSlip {
  static constexpr int kDepths = 8;      // by kStep
  static constexpr double kStep = 0.15;  // tool radii
  static constexpr int kSliders = 8;
  static constexpr int kRetreat = 6;       // even shares of the deepest way in
  double friction = 0;                     // Coulomb's coefficient
  int reached = 0;                         // depths that were solved
  std::array<double, kDepths> straight{};  // normal force of a tool that has come straight down
  std::array<double, kDepths> sliding{};   // and of one that slips as a whole, where it would hold
  std::array<double, kDepths> doubt{};     // standard, of both
  // What a retreat has less than the way in, over that, at shares 0, 1/6, ... of the deepest depth.
  std::array<double, kRetreat> retreat{};
  double retreat_from = 0;  // the depth that it began at
  double aside_at = 0;      // and that of what follows
  std::array<double, kSliders> share{}, bound{};
  // Once the tool has slipped as a whole its rim has no part of its own any more: one slider, which
  // takes this share.
  double share_slid = 1;
  double seen = 1;  // of mu N, how much the tool was seen to bear sideways: beyond is extrapolated

  // Allocate and throw nothing. `depth` beyond what was solved: as there.
  // Of the held tool's normal force. `slid`: 0 straight down, 1 once the tool slips as a whole.
  // `deepest`: that this press has been.
  double normal(double depth, double deepest, double slid) const noexcept;
  // Of all shares, and inversely of the bounds: the more of the rim slips, the deeper the tool.
  double sticks(double depth) const noexcept;
  // `slid` where the tool bears the share `rate` of mu N sideways.
  static double slid_at(double rate) noexcept;
  double doubt_at(double depth) const noexcept;
  double deepest() const noexcept { return kStep * reached; }

  // Normal forces are the mean of two places, as far as both go, and their difference is in the
  // doubt; all else is of this one.
  StrainSlip with(const StrainSlip& other) const;

  std::string bytes() const;
  static std::optional<StrainSlip> read(const std::string& bytes);  // nothing: damaged

 private:
  double at(const std::array<double, kDepths>& table, double depth) const noexcept;
};

// Presses the place of a sample with friction: straight down and back, down while the tool is drawn
// aside, and aside at one depth and back, as deep as elements of half a radius at the rim converge;
// `finer`: and as those of a quarter do, whose forces are within 0.5 % of those of a sixth
// (Richardson's extrapolation; without, ratios are 1 to 4 % off). Takes a minute of a processor,
// and two more for finer ones. `held`: body and support, static; `slips`: and the effect that
// slips. Nothing where not even the first depths converge.
std::optional<StrainSlip> solve_strain_slip(const TetMesh& body, const ContactBase& base,
                                            const Model& held, const Model& slips,
                                            const StrainSample& sample, double tool_radius,
                                            double friction, bool finer);

}  // namespace hapsim
