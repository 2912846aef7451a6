// From URDF text to the joints between two links; the only file that names urdfdom is its source.
#pragma once

#include <string>
#include <vector>

#include "robot/pose.h"
#include "robot/robot.h"

namespace hapsim {

// A joint and the link it carries, on the way from root to tip.
struct ChainJoint {
  RobotJoint joint;
  bool fixed = false;
  Pose origin = Pose::Identity();  // of the joint in the frame of the link before
  Vec3 axis = Vec3::UnitX();       // unit, in the joint's frame
};

struct UrdfChain {
  std::string root;
  std::string tip;
  std::vector<ChainJoint> joints;
};

// Errors as Robot's.
UrdfChain read_urdf_chain(const std::string& urdf, const std::string& name, const std::string& root,
                          const std::string& tip);

}  // namespace hapsim
