// What a force sensor showed while the robot stood still, pose by pose.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "base/vec3.h"
#include "io/metadata.h"
#include "io/stream.h"
#include "robot/robot.h"

namespace hapsim {

struct StaticPose {
  long line = 0;                                              // in the source, of its first row
  Eigen::Matrix3d orientation = Eigen::Matrix3d::Identity();  // of the tool in the base
  Vec3 force = Vec3::Zero();                                  // measured [N]
  Vec3 torque = Vec3::Zero();                                 // measured [N m]
  double temp = 0;                                            // [degC]
  double load = 0;                                            // known weight that is added [kg]
};

struct StaticPoses {
  std::string name;  // of the source, for error messages
  Metadata metadata;
  std::vector<StaticPose> poses;
  bool torques = false, temps = false, loads = false;  // whether these columns are there
  std::size_t rows = 0;                                // of the table
  std::size_t repeated = 0;  // rows that stand as the one before and are a pose of their own
};

// CSV fx,fy,fz[,tx,ty,tz][,temp][,load][,pose] with the orientation of the tool in the base
// (rig/orientation.h), or with the joints of `robot` (may be null; angles times `angle_factor` are
// rad). Rows of one number in the column `pose` are one pose, their mean. Error(kBadInput): a
// missing column, text, a negative load or one above 1000 kg, a part of the torques, no row.
StaticPoses read_static_poses(Input& input, const Robot* robot, double angle_factor = 1);

}  // namespace hapsim
