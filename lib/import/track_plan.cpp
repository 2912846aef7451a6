#include "base/error.h"
#include "base/median.h"
#include "import/contact_onset.h"
#include "import/press_track.h"

namespace hapsim {
namespace {

// "dx" may be a desired position as well as a displacement: the latter is not longer than 5 cm.
bool too_long(const Samples& samples) {
  std::vector<double> lengths;
  for (const int row : samples.usable)
    lengths.push_back(samples[VectorRole::kDisplacement][static_cast<std::size_t>(row)].norm());
  return median(std::move(lengths)) > 0.05;
}

}  // namespace

TrackPlan plan_tracks(const Samples& samples, const ColumnMap& map, const std::string& file) {
  const auto get = [&samples](VectorRole role) {
    return samples[role].empty() ? nullptr : &samples[role];
  };
  if (!get(VectorRole::kForce) && samples[ScalarRole::kForce].empty())
    fail_input(file, "no column holds a force",
               "name it: --column force=NAME or fx=..,fy=..,fz=.. (see --list)");

  TrackPlan plan;
  plan.has_normal = get(VectorRole::kNormal) != nullptr;
  const auto* columns = map.find(VectorRole::kPlain);
  plan.plane = columns != nullptr && (*columns)[2] < 0;
  const auto* plain = get(VectorRole::kPlain);
  const auto* still = plain && (plan.plane || positions_stand_still(samples)) ? plain : nullptr;
  const auto* moving = still ? nullptr : plain;
  plan.contact = get(VectorRole::kContact) ? get(VectorRole::kContact) : still;
  const bool elsewhere = get(VectorRole::kTip) || moving || !samples[ScalarRole::kDepth].empty();
  if (get(VectorRole::kDisplacement) && !(elsewhere && too_long(samples))) {
    plan.method = TrackMethod::kDisplacement;
    if (!plan.contact) plan.contact = plain;
    return plan;
  }
  plan.tip = get(VectorRole::kTip) ? get(VectorRole::kTip) : moving;
  const auto* ball = get(VectorRole::kContactBall);
  if (plan.tip && ball) {
    plan.origin = ball;
    plan.ball_centres = true;
  } else if (plan.tip) {
    plan.origin = plan.contact;
  } else if (get(VectorRole::kDeformed) && plan.contact) {
    plan.tip = get(VectorRole::kDeformed);
    plan.origin = plan.contact;
  } else if (get(VectorRole::kDesired) && samples[ScalarRole::kDepth].empty()) {
    plan.tip = get(VectorRole::kDesired);
    plan.origin = ball ? ball : plan.contact;
    plan.ball_centres = ball != nullptr;
  }
  if (plan.tip)
    plan.method = plan.origin ? TrackMethod::kTipAndContact : TrackMethod::kTipAlone;
  else if (samples[ScalarRole::kDepth].empty())
    fail_input(file, "no column holds a depth, a tip position or a displacement",
               "name one: --column depth=NAME or tipx=..,tipy=..,tipz=.. (see --list)");
  return plan;
}

}  // namespace hapsim
