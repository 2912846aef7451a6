#include "safety/safe_tools.h"

namespace hapsim {

SafeTools::SafeTools(const SafetyLimits& limits, std::size_t tools, double period)
    : limits_(limits), tools_(tools) {
  for (std::size_t k = 0; k < tools; ++k) tool_[k].emplace(limits, period);
}

void SafeTools::set(const SafeSample& force, const SafeSample& torque,
                    ToolFeel& feel) const noexcept {
  feel.force = force.force;
  feel.torque = limits_.lever * torque.force;
  feel.safety = force.flags | torque.flags;
}

void SafeTools::limit(std::size_t k, double now, const Vec3& tip, const Vec3& turn, ToolFeel& feel,
                      double fresh) noexcept {
  Tool& tool = *tool_[k];
  if (feel.press != tool.press) {
    tool.press = feel.press;
    tool.force.begin_press();
    tool.torque.begin_press();
  }
  const Vec3 asked = feel.torque;
  const Vec3 wanted = limits_.contains(tip) ? Vec3(asked / limits_.lever) : Vec3(Vec3::Zero());
  const SafeSample force = tool.force.pass(now, tip, feel.force, fresh);
  const SafeSample torque = tool.torque.pass(now, limits_.lever * turn, wanted, fresh);
  set(force, torque, feel);
  if (torque.flags == 0 && (force.flags & kSafeOutside) == 0) feel.torque = asked;  // to the bit
  feel.asked_force = force.unlimited;
  feel.asked_torque = asked.allFinite() ? asked : Vec3(Vec3::Zero());
}

void SafeTools::miss(std::size_t k, double now, ToolFeel& feel) noexcept {
  set(tool_[k]->force.miss(now), tool_[k]->torque.miss(now), feel);
  feel.asked_force.setZero();
  feel.asked_torque.setZero();
}

void SafeTools::zero(std::size_t k, ToolFeel& feel) noexcept {
  set(tool_[k]->force.zero(), tool_[k]->torque.zero(), feel);
  feel.asked_force.setZero();
  feel.asked_torque.setZero();
}

bool SafeTools::lost() const {
  for (std::size_t k = 0; k < tools_; ++k)
    if (tool_[k]->force.lost()) return true;
  return false;
}

}  // namespace hapsim
