#include "realtime/tool_loop.h"

#include <cassert>

namespace hapsim {
namespace {

// For loops that are given their contact points: nothing is ever near.
const SignedDistance& no_surface() {
  static const SignedDistance none = [] {
    Surface s;
    s.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    s.faces = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
    return SignedDistance(s);
  }();
  return none;
}

}  // namespace

ToolLoop::ToolLoop(const SignedDistance* surface, const ToolLoopOptions& options)
    : surface_(surface),
      options_(options),
      contact_(surface != nullptr ? *surface : no_surface(), options.contact),
      way_(surface) {}

Vec3 ToolLoop::step(double t, const Vec3& tool) noexcept {
  assert(surface_ != nullptr);
  const ToolState& now = contact_.update(tool);
  if (!now.touching()) return leave(t, Vec3::Zero());
  const bool began = now.phase == ContactPhase::kBegan;
  if (began && options_.relaxed) forget();
  if (began) speed_.restart();
  if (began || options_.contact.slides)
    touch({now.anchor, now.surface.normal, now.surface.face}, now.anchor);
  return press_within(t, now.displacement);
}

void ToolLoop::begin(const Vec3& contact) noexcept {
  if (surface_ != nullptr) {
    const SurfaceSide side = surface_->at(contact);
    touch({side.point, side.normal, side.face}, contact);
  } else {
    touch({contact, Vec3::Zero(), -1}, contact);
  }
  speed_.restart();
  if (options_.relaxed) forget();
}

Vec3 ToolLoop::press(double t, const Vec3& u, bool in_air) noexcept {
  return in_air ? leave(t, u) : press_within(t, u);
}

// `told`: as recordings give it, which may lie off the surface.
void ToolLoop::touch(const Place& place, const Vec3& told) noexcept {
  fitted_ = options_.fitted.has_place(told);
  way_.begin(place.point, place.normal);
  take_place(place);
}

int ToolLoop::beyond_at(double t, const Vec3& u, double share) noexcept {
  const double depth = way_.depth(u);
  int beyond = share > kValidShare || !options_.fitted.has_depth(depth) ? kBeyondDepth : 0;
  if (!sampled_) beyond |= kBeyondPlaces;
  if (!fitted_) beyond |= kBeyondFitted;
  if (!options_.fitted.has_speed(speed_.add(t, u))) beyond |= kBeyondSpeed;
  const double square = u.squaredNorm() - depth * depth;
  if (depth > law_.into || square > law_.along * law_.along) beyond |= kBeyondLaw;
  return beyond;
}

Vec3 ToolLoop::press_within(double t, const Vec3& u) noexcept {
  const double share = way_.share(u);
  beyond_ = beyond_at(t, u, share);
  pressed_ = u;
  if (share > kHeldShare) {
    beyond_ |= kBeyondHeld;
    pressed_ *= kHeldShare / share;
  }
  return advance(t, pressed_);
}

Vec3 ToolLoop::leave(double t, const Vec3& u) noexcept {
  beyond_ = 0;
  speed_.restart();
  pressed_ = u;
  return advance_in_air(t, u);
}

Vec3 ToolLoop::advance_in_air(double t, const Vec3& /*u*/) noexcept {
  advance(t, Vec3::Zero());
  return Vec3::Zero();
}

}  // namespace hapsim
