// A model that notices that the world has changed, says how, and goes on with what it has learned.
#pragma once

#include <vector>

#include "watch/change_test.h"
#include "watch/explain_change.h"
#include "watch/usual_stiffness.h"

namespace hapsim {

struct WatchOptions {
  ChangeTestOptions test;
  double evidence = 0.5;  // time from the change on before it is named [s]
  double blend = 0.05;    // over which the new model takes over [s]
  bool adapts = true;     // false: alarms are told, the model stays
};

struct WatchEvent {
  double begun = 0, alarm = 0, named = 0;  // times [s] of the stream: change, alarm, verdict
  Change change = Change::kNone;
  Correction correction;  // in all, from now on
  // Of a body that has moved: standard error [m], where the model is as wrong at one press as at
  // another by chance. Along a face it rests on how the model's stiffness goes with the place.
  Vec3 shift_error = Vec3::Zero();
  double error_before = 0;  // usual error [N]
  double error_with = 0;    // of the samples since the change, corrected [N]
  int presses = 0;          // that the correction rests on; grows while it is refined
  bool settled = true;      // false: still refined
  double updated = -1;      // when the correction was known well enough [s]; negative: not yet
  // Whether the correction brings the error back to about the usual.
  bool explains() const { return error_with <= 2 * error_before; }
};

// Forces of a model beside measured ones, sample by sample (thesis 5.6, Algorithm 5.9): a
// sequential test of the residuals raises an alarm, what changed is named from the samples since
// and the model corrected. Three presses tell a moved body along their normals only, so its shift
// is found anew after each further press, until kRefinedPresses of them, together with where the
// surface there lies and with the factor of the stiffness that the presses before have shown; then
// the test learns anew what is usual. A material is first given one factor; whether what relaxes
// has changed otherwise is told by whole presses, up to six. Every correction takes over gradually.
// Not real-time where it names or refines (some 50 ms, 150 at most, in that step alone).
class ModelWatch {
 public:
  static constexpr int kRefinedPresses = 15;

  // `body` outlives it.
  ModelWatch(const PreparedBody& body, const WatchOptions& options);

  // The next sample with its measured force. The model's force for it, by what is known so far [N].
  Vec3 step(const MotionLine& line, const Vec3& measured);
  // The last one changes while it is refined.
  const std::vector<WatchEvent>& events() const { return events_; }
  bool learned() const { return learned_; }
  double usual_error() const;  // root mean square of a component of late [N]; after learning
  double limit() const { return test_.limit(); }
  // By which share of it the stiffness must change before an alarm can follow; after learning.
  double least_change() const;

 private:
  const WatchedSample& kept(std::size_t i) const { return kept_[i % kept_.size()]; }
  std::size_t oldest() const;
  // Samples from `begin` on, thinned; those before `from` not counted.
  void append(std::size_t begin, std::size_t from, std::vector<WatchedSample>& window) const;
  void name();
  void refine();
  void refine_material(std::size_t begin);
  void refine_shift(std::size_t begin);
  void settle();
  void take_over(const Correction& correction, std::size_t begin);

  const PreparedBody& body_;
  WatchOptions options_;
  ChangeTest test_;
  PressFactors factors_;
  SurfaceOffsets known_offsets_, offsets_;  // the latter with what a refined shift has shown
  CorrectedModel model_, before_;
  Correction correction_, old_;
  Correction known_;      // before the change that is refined
  UsualStiffness usual_;  // then
  double share_ = 1;      // of the new correction in the model's force
  std::int32_t press_ = 0;
  std::size_t press_begun_ = 0;      // its first sample
  std::vector<WatchedSample> kept_;  // ring
  std::size_t count_ = 0;            // samples so far
  bool learned_ = false;
  double alarm_ = -1;  // [s]
  std::size_t change_ = 0, waits_until_ = 0;
  std::vector<WatchedSample> since_;  // the change, while a shift is refined
  std::vector<WatchEvent> events_;
};

}  // namespace hapsim
