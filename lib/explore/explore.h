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

// What the next presses are for. Spread: over the body, where least is known. Tell apart: rivals of
// the diagnosis. Sharpen: a parameter. Lump: where it lies.
enum class Aim { kNone, kSpread, kTellApart, kSharpen, kLump };
std::string aim_name(Aim aim);

struct ExploreOptions {
  Goals goals;
  std::size_t presses = 1;        // of the next motion
  std::size_t most_presses = 60;  // of all; then no more are asked for
  double depth =
      0;  // that of a full press [m]; 0: two thirds of the deepest so far, at first three
          // quarters of the tool's radius, a tenth of the body's least extent at most
  double steepest = M_PI / 4;  // between a place's normal and +z [rad]
  ExperimentOptions experiment;
  DiagnoseOptions diagnose;
};

struct Exploration {
  std::size_t presses = 0, places = 0;  // so far
  std::vector<GoalState> goals;
  bool reached = false;  // all of them
  bool ended = false;    // most_presses are there
  Aim aim = Aim::kNone;
  std::string why;  // the aim in a sentence, with what its presses promise
  // Standard deviations of the noise that rivals will be apart; the share that is left of a
  // parameter's standard error; not finite for other aims.
  double promise = std::numeric_limits<double>::quiet_NaN();
  std::vector<std::string> rivals;
  std::string parameter;
  MeasurementPlan plan;  // numbers and times go on after the recording's; empty when done
  std::optional<Diagnosis> diagnosis;  // not before kLeastPresses
  std::vector<Lump> lumps;             // seen inside, strongest first
  std::vector<std::string> inside;     // what is seen there in words, where it was looked for
  bool done() const { return reached || ended; }
};

// `recording`: all presses so far; without rows: none. `model`: to diagnose; without parameters an
// elastic one. Before kLeastPresses, of which nothing can be settled, presses are spread and
// nothing is fitted. Deterministic. Error(kBadInput): there is no place to press.
Exploration explore(const TetMesh& body, const std::vector<Vec3>& window, const Model& model,
                    const Recording& recording, const ExploreOptions& options);

}  // namespace hapsim
