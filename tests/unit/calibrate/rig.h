// A simulated rig: a sensor with every fault, from the equations alone and with rotations of
// another library than the code under test uses.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "base/random.h"
#include "calibrate/sensor_model.h"
#include "calibrate/static_poses.h"

namespace hapsim::test {

struct Rig {
  Eigen::Matrix3d R = Eigen::AngleAxisd(0.6, Vec3(1, 2, -1).normalized()).toRotationMatrix();
  Eigen::Matrix3d C =
      (Eigen::Matrix3d() << 1.03, 0.02, -0.015, 0.02, 0.97, 0.01, -0.015, 0.01, 1.01).finished();
  double mass = 1.2;
  Vec3 gravity = Vec3(0, 0, -9.80665);
  Vec3 offset = Vec3(3, -2, 5), drift = Vec3(0.05, -0.02, 0.1);
  Vec3 com = Vec3(0.004, -0.003, 0.06);
  Vec3 torque_offset = Vec3(0.2, -0.1, 0.05), torque_drift = Vec3(0.002, 0.001, -0.001);
  Vec3 weight_at = Vec3(0, 0.01, 0.12);
  double temp_ref = 20;
  double force_noise = 0.02, torque_noise = 0.002;
  double pose_noise = 0;  // of the robot's orientation, about each axis [rad]
};

inline Eigen::Matrix3d any_orientation(Random& random) {
  return Eigen::Quaterniond(random.normal(), random.normal(), random.normal(), random.normal())
      .normalized()
      .toRotationMatrix();
}

inline Vec3 normals(Random& random, double sigma) {
  return sigma * Vec3(random.normal(), random.normal(), random.normal());
}

// What the sensor shows at the pose's orientation, load and temp.
inline void show(const Rig& rig, Random& random, StaticPose& p) {
  const Vec3 error = normals(random, rig.pose_noise);
  const Eigen::Matrix3d truly = p.orientation * (Eigen::AngleAxisd(error.x(), Vec3::UnitX()) *
                                                 Eigen::AngleAxisd(error.y(), Vec3::UnitY()) *
                                                 Eigen::AngleAxisd(error.z(), Vec3::UnitZ()))
                                                    .toRotationMatrix();
  const Vec3 g = truly.transpose() * rig.gravity;
  const double kelvin = p.temp - rig.temp_ref;
  p.force = rig.C * rig.R * ((rig.mass + p.load) * g) + rig.offset + kelvin * rig.drift +
            normals(random, rig.force_noise);
  p.torque = rig.R * (rig.mass * rig.com.cross(g) + p.load * rig.weight_at.cross(g)) +
             rig.torque_offset + kelvin * rig.torque_drift + normals(random, rig.torque_noise);
}

// Poses all around; every third with a weight of 1 kg where `loads`, temperatures between 18
// and 28.
inline StaticPoses recorded(const Rig& rig, int count, Random& random, bool loads = true,
                            bool torques = true, bool temps = true) {
  StaticPoses poses;
  poses.name = "poses.csv";
  poses.metadata.set("temp_ref", "20");
  poses.torques = torques;
  poses.temps = temps;
  poses.loads = loads;
  for (int i = 0; i < count; ++i) {
    StaticPose p;
    p.line = i + 2;
    p.orientation = any_orientation(random);
    p.load = loads && i % 3 == 2 ? 1 : 0;
    p.temp = temps ? 18 + 10 * random.uniform() : 20;
    show(rig, random, p);
    poses.poses.push_back(p);
  }
  return poses;
}

// The same numbers as the code under test names them.
inline SensorState state_of(const Rig& rig) {
  SensorState s;
  s.rotation = rig.R;
  s.crosstalk = rig.C;
  s.mass = rig.mass;
  s.gravity = rig.gravity;
  s.offset = rig.offset;
  s.drift = rig.drift;
  s.com = rig.com;
  s.torque_offset = rig.torque_offset;
  s.torque_drift = rig.torque_drift;
  s.weight_at = rig.weight_at;
  s.temp_ref = rig.temp_ref;
  return s;
}

// The rig whose mean gain is 1, which no weight tells from this one.
inline Rig of_mean_gain_one(Rig rig) {
  const double gain = rig.C.trace() / 3;
  rig.C /= gain;
  rig.mass *= gain;
  rig.com /= gain;  // the torques tell mass times centre
  return rig;
}

}  // namespace hapsim::test
