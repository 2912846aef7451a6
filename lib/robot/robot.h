// A serial robot from its URDF description: forward and inverse kinematics by Orocos KDL.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "robot/pose.h"

namespace hapsim {

struct RobotJoint {
  std::string name;
  bool turns = true;  // rad; else it slides, m
  double lower = 0;   // limits; infinite for a joint that turns on and on
  double upper = 0;
};

class Robot {
 public:
  // The chain of joints from link `root` ("" for the model's) to link `tip` ("" for the only end).
  // Error(kBadInput, name): no URDF, a link that is not there (with the nearest), several ends, no
  // moving joint on the way, joints that follow others, float or move in a plane.
  Robot(const std::string& urdf, const std::string& name, const std::string& root,
        const std::string& tip);
  ~Robot();
  Robot(Robot&&) noexcept;

  const std::string& name() const;
  const std::string& root() const;
  const std::string& tip() const;
  const std::vector<RobotJoint>& joints() const;

  // Frame of the tip in the root's at joint values q, in the order of joints().
  Pose forward(const Eigen::VectorXd& q) const;

  // Joint values within the limits that bring the tip to `pose` (to 1e-10 m and rad), near `start`
  // where that can be: damped least squares (Levenberg-Marquardt on the pose's twist) from `start`,
  // then from the middle of the limits and some places between them. Empty when none is found.
  std::optional<Eigen::VectorXd> inverse(const Pose& pose, const Eigen::VectorXd& start) const;

  // Joint values half way between the limits, 0 where there are none.
  Eigen::VectorXd middle() const;
  // No tip position lies farther from the origin of the first joint than this [m].
  double reach() const;
  // Of the first joint that moves, in the root's frame.
  Vec3 shoulder() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hapsim
