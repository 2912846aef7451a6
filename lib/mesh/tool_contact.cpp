#include "mesh/tool_contact.h"

namespace hapsim {

const ToolState& ToolContact::update(const Vec3& tool) noexcept {
  constexpr double kFarthest = 10;  // [m], as recordings have it: beyond, squares end in overflow
  if (!tool.allFinite() || tool.cwiseAbs().maxCoeff() > kFarthest)
    return state_;  // a lost sample: the last state stands
  const bool was = state_.touching();
  const int last = state_.surface.face;
  SurfaceSide side;
  if (was) {
    // Deep inside, the nearest point of the whole surface may be on the far side.
    side = body_.along(tool, last);
    if (side.distance > 0) side = body_.at(tool, side.face);
  } else {
    side = body_.at(tool, last);
  }
  side.distance -= options_.radius;
  state_.surface = side;
  const bool touching = side.distance <= (was ? options_.release : 0);
  if (!touching) {
    state_.phase = was ? ContactPhase::kEnded : ContactPhase::kAway;
    state_.displacement.setZero();
    return state_;
  }
  if (!was) ++state_.episode;
  state_.phase = was ? ContactPhase::kHeld : ContactPhase::kBegan;
  if (!was || options_.slides) state_.anchor = side.point;
  // The tip of a sphere is its point against the normal; where it touches first, that is the
  // surface point itself.
  state_.displacement = tool - options_.radius * side.normal - state_.anchor;
  return state_;
}

}  // namespace hapsim
