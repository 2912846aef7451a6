// How far a model's forces are off at places that nobody has pressed, by those that were left out.
#pragma once

#include <vector>

#include "experiment/experiment.h"
#include "fit/fit.h"
#include "plan/spread_places.h"

namespace hapsim {

// By position of the experiment.
struct LeftOut {
  std::vector<double> error;  // mean square of what was foretold wrongly of a component [N^2]
  std::vector<double> force;  // and of the force itself
  double noise = 0;           // [N]
};

// Each position foretold by a model that was fitted, and its map made, without it: what the fit
// leaves there, and by how much it would have said something else had it not seen the position.
// That difference is one between two maps of first order, and free of what these err by. No
// positions where a single one is all.
LeftOut places_left_out(const Model& model, const Experiment& experiment,
                        const Allowance& allowance);

// Of a press anywhere, over the surface, where each position that was left out stands for its share
// (PlaceFinder::shares()). Rather too large than too small: a position that was left out lay
// farther from what was pressed than any place does now (bench/explore/unseen.py: seven of eight).
// NaN of no positions.
struct Unseen {
  double times_noise = 0;     // root mean square error over the noise
  double share_of_force = 0;  // the same without the noise, of the force's root mean square
};
Unseen unseen_of(const LeftOut& left_out, const std::vector<double>& shares);

// What a press at each of `places` may be wrong by, relative: the mean square error beyond the
// noise of the positions that were left out near it, those a spacing away counting less (local
// errors of cross-validation as the guide of the next sample: Li, Aute and Azarm, Struct.
// Multidiscip. Optim. 40, 2010). `seen`: the positions, in their order.
std::vector<double> doubt_at(const std::vector<PressablePlace>& places,
                             const std::vector<SeenPlace>& seen, const LeftOut& left_out);

}  // namespace hapsim
