#include "calibrate/sensor_model.h"

#include "rig/calibration.h"
#include "rig/rotation_vector.h"
#include "robot/pose.h"

namespace hapsim {

Matrix32 tilt_axes(const Vec3& gravity) {
  Matrix32 axes;
  axes.col(0) = any_square_to(gravity);
  axes.col(1) = gravity.normalized().cross(axes.col(0));
  return axes;
}

SensorState moved(const SensorState& state, const Eigen::VectorXd& d) {
  SensorState s = state;
  s.rotation = rotation_of(d.segment<3>(kTurn)) * state.rotation;
  for (std::size_t k = 0; k < kSymmetric; ++k) {
    const MatrixPlace& at = kSymmetricPlaces[k];
    const double change = d[kTalk + static_cast<Eigen::Index>(k)];
    s.crosstalk(at.row, at.column) += change;
    if (at.row != at.column) s.crosstalk(at.column, at.row) += change;
  }
  s.mass += d[kToolMass];
  s.gravity = rotation_of(tilt_axes(state.gravity) * d.segment<2>(kTilt)) * state.gravity;
  s.offset += d.segment<3>(kZero);
  s.drift += d.segment<3>(kZeroDrift);
  s.com += d.segment<3>(kCentre);
  s.torque_offset += d.segment<3>(kTorqueZero);
  s.torque_drift += d.segment<3>(kTorqueZeroDrift);
  s.weight_at += d.segment<3>(kHung);
  return s;
}

Wrench shown_wrench(const SensorState& s, const StaticPose& pose) {
  Wrench w;
  w.slope.setZero();
  const double kelvin = pose.temp - s.temp_ref;
  const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
  const Vec3 g = pose.orientation.transpose() * s.gravity;  // in the tool's frame
  const Matrix32 dg =
      -pose.orientation.transpose() * cross_matrix(s.gravity) * tilt_axes(s.gravity);

  const Vec3 load = s.rotation * ((s.mass + pose.load) * g);
  w.value.head<3>() = s.crosstalk * load + s.offset + kelvin * s.drift;
  auto force = w.slope.topRows<3>();
  force.middleCols<3>(kTurn) = -s.crosstalk * cross_matrix(load);
  for (std::size_t k = 0; k < kSymmetric; ++k) {
    const MatrixPlace& at = kSymmetricPlaces[k];
    const auto column = kTalk + static_cast<Eigen::Index>(k);
    force(at.row, column) = load[at.column];
    if (at.row != at.column) force(at.column, column) = load[at.row];
  }
  force.col(kToolMass) = s.crosstalk * s.rotation * g;
  force.middleCols<2>(kTilt) = (s.mass + pose.load) * s.crosstalk * s.rotation * dg;
  force.middleCols<3>(kZero) = I;
  force.middleCols<3>(kZeroDrift) = kelvin * I;

  const Vec3 lever = s.mass * s.com + pose.load * s.weight_at;  // first moment of the masses
  const Vec3 moment = s.sign * s.rotation * lever.cross(g);
  w.value.tail<3>() = moment + s.torque_offset + kelvin * s.torque_drift;
  auto torque = w.slope.bottomRows<3>();
  const Eigen::Matrix3d by_lever = -s.sign * s.rotation * cross_matrix(g);
  torque.middleCols<3>(kTurn) = -cross_matrix(moment);
  torque.col(kToolMass) = s.sign * s.rotation * s.com.cross(g);
  torque.middleCols<2>(kTilt) = s.sign * s.rotation * cross_matrix(lever) * dg;
  torque.middleCols<3>(kCentre) = s.mass * by_lever;
  torque.middleCols<3>(kTorqueZero) = I;
  torque.middleCols<3>(kTorqueZeroDrift) = kelvin * I;
  torque.middleCols<3>(kHung) = pose.load * by_lever;
  return w;
}

}  // namespace hapsim
