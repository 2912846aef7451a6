#include "realtime/force_loop.h"

#include "material/maxwell_memory.h"

namespace hapsim {

ForceLoop::ForceLoop(const PreparedBody& body, const ToolLoopOptions& options)
    : ToolLoop(&body.distance(), options), body_(body) {
  state_.h.fill(Vec3::Zero());
  state_.driver.fill(Vec3::Zero());
  state_.maxwell.fill(Eigen::Matrix3d::Zero());
}

ForceLoopState ForceLoop::state() const {
  ForceLoopState state = state_;
  state.tool = tool();
  return state;
}

void ForceLoop::restore(const ForceLoopState& state) noexcept {
  state_ = state;
  restore_tool(state.tool);
}

void ForceLoop::take_place(const Place& place) noexcept {
  state_.anchor = place.point;
  state_.normal = place.normal;
  state_.K = body_.field().at(place.face, place.point);
  if (body_.is_regional()) body_.maxwell_at(place.face, place.point, state_.maxwell.data());
}

Vec3 ForceLoop::advance(double t, const Vec3& u) noexcept {
  const Vec3 elastic = -(state_.K * u);
  Vec3 force = elastic;
  const bool first = !state_.begun;
  const double dt = t > state_.t ? t - state_.t : 0;
  const std::vector<MaxwellTerm>& terms = body_.terms();
  for (std::size_t i = 0; i < terms.size(); ++i) {
    Vec3& h = state_.h[i];
    const Vec3 driver = body_.is_regional() ? Vec3(-(state_.maxwell[i] * u)) : elastic;
    if (first) {
      h = driver;  // relaxed until now, then a jump
    } else {
      const MemoryStep s = memory_step(dt, times_ * terms[i].tau);
      h = s.a * h + s.c * (driver - state_.driver[i]);
    }
    state_.driver[i] = driver;
    force += moduli_ * terms[i].share * h;
  }
  if (first || t > state_.t) state_.t = t;
  state_.begun = true;
  return force;
}

}  // namespace hapsim
