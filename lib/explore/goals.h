// What further presses are for, and whether it is reached.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "explore/coverage.h"
#include "explore/unseen.h"
#include "imaging/stiffness_image.h"

namespace hapsim {

// The relative standard error that a parameter shall have.
struct WantedError {
  std::string parameter;  // "E", "elastic.E"
  double share = 0;
};

// Root mean square error at places that nobody has pressed.
struct WantedUnseen {
  double value = 0;       // 0: not asked
  bool of_force = false;  // a share of the force, without the noise; otherwise times the noise
};

struct Goals {
  bool verdict = false;             // settled: settles()
  std::vector<WantedError> errors;  // of the model with all that was found missing
  WantedUnseen unseen;
  double lump = 0;  // [m]: one is seen, its centre's intervals no wider than that to each side; 0:
                    // not asked
  bool of_forces() const { return verdict || !errors.empty(); }
};

// "verdict", "E=0.02", "elastic.E=2%" (or "elastic E=2%"), "unseen=2" (times the noise) or
// "unseen=5%" (of the force), "lump=2mm"; a parameter asks for the verdict too, for its error is
// none of a model that lacks something, and so does unseen. Error(kUsage) beginning with `option`:
// no such goal, a parameter of no effect, two goals of one kind.
Goals parse_goals(const std::vector<std::string>& words, const std::string& option);

// One goal and how far it is. `value` is not finite where nothing is known yet.
struct GoalState {
  std::string name;              // "verdict", "elastic E", "unseen", "lump"
  std::string said;              // of the verdict: what it is; of a lump: "seen" or "not seen"
  double value = 0, wanted = 0;  // relative error, that of unseen places over the noise or the
                                 // force, or the widest half interval [m]; 0: of a verdict
  bool reached = false;
  std::string note = {};       // what stands in the way; "": nothing but more presses
  bool unreachable = false;    // no number of presses will do
  std::string determine = {};  // the parameter to know better next, "elastic nu"; "": none
  int region = 0;              // of that parameter
};

// What stands in the way of calling a verdict final, in words; "": more presses need not change it.
// It must have a false-alarm rate (kLeastPresses), places that were held out (kSettledPlaces), and
// motions in which all effects could have shown; and one set of effects explains all, or nothing
// is missing.
std::string unsettled(const Diagnosis& diagnosis, const Coverage& coverage);

GoalState verdict_state(const Diagnosis& diagnosis, const Coverage& coverage);
// Error(kUsage): the model has no such free parameter. `floor`: relative error that all positions
// share (Allowance::floor), below which no modulus of the body is known. A parameter at its bound
// is not known, nor is a modulus while Poisson's ratio is: its error is conditional on that.
GoalState error_state(const WantedError& wanted, const Model& model, double floor);
// The same before anything is known: of the body's modulus wanted better than `floor`, else none.
std::optional<GoalState> hopeless(const WantedError& wanted, double floor);
// Of the wanted number or share. Where what is left is no more than the `floor` by which mesh and
// shape may err everywhere, no more presses make it less.
GoalState unseen_state(const WantedUnseen& wanted, const Unseen& unseen, double floor);
// The strongest lump.
GoalState lump_state(double wanted, const StiffnessImage& image);

}  // namespace hapsim
