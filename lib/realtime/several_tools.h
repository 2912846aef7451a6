// Several tools on one body, each with its position and orientation: the forces and torques of
// every sample within microseconds.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "realtime/force_loop.h"
#include "realtime/tool_coupling.h"

namespace hapsim {

constexpr std::size_t kMostTools = 4;  // that press a body at once
// Beside the bits of Beyond: another tool touches nearer than twice the radius, where no two of
// them have room.
constexpr int kBeyondClose = 64;

// Where a tool is.
struct ToolPose {
  Vec3 point = Vec3::Zero();  // of its tip, or (press()) the contact point on the surface [m]
  Vec3 u = Vec3::Zero();      // press(): displacement of the tip from there [m]
  // Rotation vector [rad], in the body's frame: of the tool, or (press()) since it touched.
  Vec3 turn = Vec3::Zero();
  int press = 1;        // press(): another one begins anew
  bool in_air = false;  // press()
};

// What it feels.
struct ToolFeel {
  int press = 0;  // of step(): touches of all tools are counted together; before its first -tool
  bool in_air = true;
  Vec3 point = Vec3::Zero();   // contact point on the undeformed surface [m]
  Vec3 u = Vec3::Zero();       // of the tip from there [m], as it is held
  Vec3 turn = Vec3::Zero();    // since it touched [rad]
  Vec3 force = Vec3::Zero();   // of the body on the tool [N]
  Vec3 torque = Vec3::Zero();  // about the tip, the middle of the patch [N m]
  int beyond = 0;              // ToolLoop::beyond(), and kBeyondClose
  // Standard, of the length of the force, that the place leaves [N]; NaN: not known.
  double uncertainty = std::numeric_limits<double>::quiet_NaN();
  // For a hand, set by who limits them (SafeTools): why force and torque are not what was asked
  // for, and that.
  int safety = 0;
  Vec3 asked_force = Vec3::Zero(), asked_torque = Vec3::Zero();
  // About another point of the tool [m], as it is now.
  Vec3 torque_about(const Vec3& other) const { return torque + (point + u - other).cross(force); }
};

// The tools touch, hold and let go each as a ForceLoop has it. The surface under each has been
// moved by the others: by Betti's reciprocal theorem the motions d of the patches of all tools that
// touch are d = C p, p the forces and moments on the body, C put together from the tools' own
// stiffnesses and ToolCoupling. A tool then presses by its way less that of the surface under it,
// so all laws of the contact act on what it is pressed into the body. A flat tool's patch turns
// with it; torques are those of the linear body, relaxing as it does; contact laws and the sensor's
// change forces alone. What moves under a tool are the linear, relaxed forces of the others. step()
// and press() allocate nothing, lock nothing, throw nothing and make no system call. Not to be
// shared between threads.
class SeveralTools {
 public:
  // `body` outlives it, and `coupling`, of the same body, which more than one tool needs.
  SeveralTools(const PreparedBody& body, const ToolCoupling* coupling, std::size_t tools,
               const ToolLoopOptions& options = {});
  ~SeveralTools();

  std::size_t tools() const { return tools_.size(); }
  void set_temperature(double temperature) noexcept;  // [degC]; NaN: not known
  // At time t [s], one pose a tool: anywhere; contacts are found, on the surface as the others have
  // moved it. A pose that is not finite repeats the last.
  std::span<const ToolFeel> step(double t, std::span<const ToolPose> poses) noexcept;
  // Recorded motions, whose contact points are known.
  std::span<const ToolFeel> press(double t, std::span<const ToolPose> poses) noexcept;

 private:
  struct Tool;
  using Matrix =
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6 * kMostTools, 6 * kMostTools>;
  using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 6 * kMostTools, 1>;

  // Forces and moments on the patches of tools that touch, in their order.
  struct Loads {
    std::size_t tools = 0;
    std::array<std::size_t, kMostTools> tool;
    std::array<Vector6, kMostTools> p;
  };

  void touch(std::size_t tool, const Vec3& point) noexcept;
  void find_contact(std::size_t tool, const ToolPose& pose) noexcept;
  void find_loads(std::size_t but, Loads& loads) const noexcept;
  void feel(double t) noexcept;

  const PreparedBody& body_;
  const ToolCoupling* coupling_;
  ToolLoopOptions options_;
  std::vector<std::unique_ptr<Tool>> tools_;
  std::vector<ToolFeel> feel_;
  int touches_ = 0;
};

}  // namespace hapsim
