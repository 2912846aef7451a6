// What friction under a flat tool takes from the force of one that holds, at finite strain.
#pragma once

#include <algorithm>
#include <vector>

#include "realtime/rim_slip.h"
#include "realtime/slip_presses.h"

namespace hapsim {

struct StrainSlip {
  // Rings, and where they hold.
  struct Range {
    RimSlip rim;
    double deepest = 0;  // tool radii: so deep places were pressed
    double doubt = 0;    // standard relative uncertainty of forces, beside those of a held tool
  };
  // No numbers of rings are right both where the tool is hardly pressed in and where the surface
  // about it is drawn in with it: `deep` follows where the tool has been deeper than `near` was
  // pressed since it came down. Not where deep.deepest is no deeper than near.deepest.
  Range near, deep;
  double seen = 1;  // of mu N, how much the tool was seen to bear sideways: beyond, extrapolated

  // Plain data.
  struct State {
    RimSlip::State near, deep;
    double deepest = 0;  // tool radii, since it came down
    static constexpr int kNumbers = 2 * RimSlip::kNumbers + 1;

    void store(double* numbers) const noexcept;  // kNumbers
    static State load(const double* numbers) noexcept;
  };

  // As RimSlip::step(); `held` is asked of one range after the other where both count.
  template <class Held>
  RimSlip::Force step(double depth, const Eigen::Vector2d& aside, State& state,
                      Held&& held) const noexcept {
    state.deepest = depth > 0 ? std::max(depth, state.deepest) : 0;
    const double share = deep_share(state.deepest);
    if (share <= 0) {
      const RimSlip::Force force = near.rim.step(depth, aside, state.near, held);
      state.deep = state.near;
      return force;
    }
    RimSlip::Force beside;
    if (share < 1) beside = near.rim.step(depth, aside, state.near, held);
    RimSlip::Force force = deep.rim.step(depth, aside, state.deep, held);
    if (share < 1) {
      force.normal += (1 - share) * (beside.normal - force.normal);
      force.along += (1 - share) * (beside.along - force.along);
      force.slipped += (1 - share) * (beside.slipped - force.slipped);
    }
    return force;
  }

  double deepest() const noexcept { return std::max(near.deepest, deep.deepest); }
  // How much `deep` counts where the tool has been that deep: from 0 to 1.
  double deep_share(double deepest) const noexcept;

  // Whether that was seen of this tool: nowhere deeper since it came down, slipped no farther than
  // where its contact is another, and borne as much sideways, or slipped as a whole.
  bool within(const State& state, const RimSlip::Force& force) const noexcept;
  // Standard relative uncertainty of a force, of which slip has taken the part `lost`: where the
  // tool has been deeper than it was pressed, as much of that part as there are tool radii beyond.
  double doubt_of(const State& state, double lost) const noexcept;
};

struct SlipPlace {
  StrainSample sample;
  SlipPresses presses;
};

// The rings whose forces over those of a tool that holds, by each place's own sample, are those of
// the presses there: least squares of all motions of all places, relative to each force with a
// floor of 5 % of a motion's largest. What is left of them, and the elements' own, is the doubt.
// Takes a few seconds. At least one place; threads as LargeStrainOptions has them.
StrainSlip fit_strain_slip(const std::vector<SlipPlace>& places, int threads);

}  // namespace hapsim
