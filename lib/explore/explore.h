// The closed loop of measuring: what is known of a body, and which presses to record next.
#pragma once

#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "explore/goals.h"
#include "plan/press_plan.h"

namespace hapsim {

// What the next presses are for. Spread: over the body, where least is known. Test: effects that
// the motions so far could not show. Tell apart: rivals of the diagnosis. Sharpen: a parameter.
// Unseen: what places that were left out were foretold worst. Lump: where it lies.
enum class Aim { kNone, kSpread, kTest, kTellApart, kSharpen, kUnseen, kLump };
std::string aim_name(Aim aim);

struct ExploreOptions {
  Goals goals;
  std::size_t presses = 1;        // of the next motion
  std::size_t most_presses = 60;  // of all; then no more are asked for
  double depth = 0;               // of the deepest path [m]; 0: as deep as so far (press_depths.h)
  double steepest = M_PI / 4;     // between a place's normal and +z [rad]
  ExperimentOptions experiment;
  DiagnoseOptions diagnose;
};

struct Exploration {
  std::size_t presses = 0, places = 0;  // so far
  std::vector<GoalState> goals;
  bool reached = false;  // all of them
  bool ended = false;    // not reached, and no more presses are asked for; `why` says why
  Aim aim = Aim::kNone;
  std::string why;  // the aim in a sentence, with what its presses promise; "" when reached
  // Standard deviations of the noise that rivals will be apart; the share that is left of a
  // parameter's standard error; not finite for other aims.
  double promise = std::numeric_limits<double>::quiet_NaN();
  std::vector<std::string> rivals;
  std::string parameter;
  MeasurementPlan plan;  // numbers and times go on after the recording's; empty when done
  std::optional<Diagnosis> diagnosis;  // not before kLeastPresses
  std::vector<Lump> lumps;             // seen inside, strongest first
  std::vector<std::string> inside;     // what is seen there in words, where it was looked for
  std::vector<Sight> sight;            // and how deep these presses see
  // Effects of which the verdict says nothing, since no plan of presses can test them.
  std::vector<UntestedEffect> untested;
  bool no_times = false;  // the recording has none: what goes on in time cannot be told
  // How far the body goes on beyond the presses (PlaceFinder::widest_gap()) [m], once judged.
  double gap = std::numeric_limits<double>::quiet_NaN();
  std::vector<std::string> shallower;  // planned presses that the body is too thin for, in words
  bool done() const { return reached || ended; }
};

// `recording`: all presses so far; without rows: none. `model`: to diagnose; without parameters an
// elastic one. Before kLeastPresses, of which nothing can be settled, presses are spread and
// nothing is fitted. Deterministic. Error(kBadInput): there is
// no place to press, or a contact point lies off the body.
Exploration explore(const TetMesh& body, const std::vector<Vec3>& window, const Model& model,
                    const Recording& recording, const ExploreOptions& options);

}  // namespace hapsim
