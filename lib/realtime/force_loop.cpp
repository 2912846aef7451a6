#include "realtime/force_loop.h"

#include "fem/memory.h"

namespace hapsim {

ForceLoop::ForceLoop(const PreparedBody& body, const ForceLoopOptions& options)
    : body_(body), options_(options), contact_(body.distance(), options.contact) {
  state_.h.fill(Vec3::Zero());
  state_.driver.fill(Vec3::Zero());
  state_.maxwell.fill(Eigen::Matrix3d::Zero());
}

void ForceLoop::restore(const ForceLoopState& state) noexcept {
  state_ = state;
  contact_.restore(state.tool);
}

Vec3 ForceLoop::step(double t, const Vec3& tool) noexcept {
  const ToolState& now = state_.tool = contact_.update(tool);
  if (!now.touching()) return advance(t, Vec3::Zero()), Vec3::Zero();
  const bool began = now.phase == ContactPhase::kBegan;
  if (began && options_.relaxed) state_.begun = false;
  if (began || options_.contact.slides) {
    state_.anchor = now.anchor;
    state_.normal = now.surface.normal;
    take_stiffness(now.surface.face);
  }
  return advance(t, now.displacement);
}

void ForceLoop::begin(const Vec3& contact) noexcept {
  const SurfaceSide side = body_.distance().at(contact);
  state_.anchor = side.point;
  state_.normal = side.normal;
  take_stiffness(side.face);
  if (options_.relaxed) state_.begun = false;
}

Vec3 ForceLoop::press(double t, const Vec3& u, bool in_air) noexcept {
  if (in_air) return advance(t, Vec3::Zero()), Vec3::Zero();
  return advance(t, u);
}

void ForceLoop::take_stiffness(int face) noexcept {
  state_.K = body_.field().at(face, state_.anchor);
  if (body_.is_regional()) body_.maxwell_at(face, state_.anchor, state_.maxwell.data());
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
      const MemoryStep s = memory_step(dt, terms[i].tau);
      h = s.a * h + s.c * (driver - state_.driver[i]);
    }
    state_.driver[i] = driver;
    force += terms[i].share * h;
  }
  if (first || t > state_.t) state_.t = t;
  state_.begun = true;
  return force;
}

}  // namespace hapsim
