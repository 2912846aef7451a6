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
      contact_(surface != nullptr ? *surface : no_surface(), options.contact) {}

Vec3 ToolLoop::step(double t, const Vec3& tool) noexcept {
  assert(surface_ != nullptr);
  const ToolState& now = contact_.update(tool);
  if (!now.touching()) return advance(t, Vec3::Zero()), Vec3::Zero();
  const bool began = now.phase == ContactPhase::kBegan;
  if (began && options_.relaxed) forget();
  if (began || options_.contact.slides)
    take_place({now.anchor, now.surface.normal, now.surface.face});
  return advance(t, now.displacement);
}

void ToolLoop::begin(const Vec3& contact) noexcept {
  if (surface_ != nullptr) {
    const SurfaceSide side = surface_->at(contact);
    take_place({side.point, side.normal, side.face});
  } else {
    take_place({contact, Vec3::Zero(), -1});
  }
  if (options_.relaxed) forget();
}

Vec3 ToolLoop::press(double t, const Vec3& u, bool in_air) noexcept {
  if (in_air) return advance(t, Vec3::Zero()), Vec3::Zero();
  return advance(t, u);
}

}  // namespace hapsim
