// What further presses are for, and whether it is reached.
#pragma once

#include <string>
#include <vector>

#include "diagnose/diagnose.h"
#include "imaging/stiffness_image.h"

namespace hapsim {

// The relative standard error that a parameter shall have.
struct WantedError {
  std::string parameter;  // "E", "elastic.E"
  double share = 0;
};

struct Goals {
  bool verdict = false;             // settled: settles()
  std::vector<WantedError> errors;  // of the model with all that was found missing
  double lump = 0;  // [m]: one is seen, its centre's intervals no wider than that to each side; 0:
                    // not asked
  bool of_forces() const { return verdict || !errors.empty(); }
};

// "verdict", "E=0.02" or "elastic.E=2%", "lump=2mm"; a parameter asks for the verdict too, for its
// error is none of a model that lacks something. Error(kUsage) beginning with `option`.
Goals parse_goals(const std::vector<std::string>& words, const std::string& option);

// One goal and how far it is. `value` is not finite where nothing is known yet.
struct GoalState {
  std::string name;              // "verdict", "elastic E", "lump"
  std::string said;              // of the verdict: what it is; of a lump: "seen" or "not seen"
  double value = 0, wanted = 0;  // relative error, or the widest half interval [m]; 0: of a verdict
  bool reached = false;
};

// Whether more presses need not change a verdict: it has a false-alarm rate (kLeastPresses), one
// set of effects explains all, or nothing is missing.
bool settles(const Diagnosis& diagnosis, std::size_t presses);

GoalState verdict_state(const Diagnosis& diagnosis, std::size_t presses);
// Error(kUsage): the model has no such free parameter.
GoalState error_state(const WantedError& wanted, const Model& model);
// The strongest lump.
GoalState lump_state(double wanted, const StiffnessImage& image);

}  // namespace hapsim
