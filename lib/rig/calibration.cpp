#include "rig/calibration.h"

#include "rig/rotation_vector.h"

namespace hapsim {

const std::array<CalibratedName, kCalibratedNumbers>& calibrated_names() {
  static const char* const turn = "rotation of the sensor against the tool, axis times angle";
  static const char* const talk = "what one axis of the sensor shows of another's force; its gain";
  static const char* const free_fall = "gravity in the robot's base";
  static const char* const offset = "force that the sensor shows without load, at temp_ref";
  static const char* const drift = "change of the offset by temperature";
  static const char* const com = "centre of mass of the tool from the sensor's origin";
  static const char* const torque = "torque that the sensor shows without load, at temp_ref";
  static const char* const torque_drift = "change of the torque's offset by temperature";
  static const char* const hung = "where the known weight hangs, from the sensor's origin";
  static const char* const arm = "compliance of the arm along the recording's axes";
  static const std::array<CalibratedName, kCalibratedNumbers> all{
      {{"rotation_x", "rad", turn},
       {"rotation_y", "rad", turn},
       {"rotation_z", "rad", turn},
       {"crosstalk_xx", "1", talk},
       {"crosstalk_yy", "1", talk},
       {"crosstalk_zz", "1", talk},
       {"crosstalk_xy", "1", talk},
       {"crosstalk_xz", "1", talk},
       {"crosstalk_yz", "1", talk},
       {"mass", "kg", "mass of what the sensor carries"},
       {"gravity_x", "m/s2", free_fall},
       {"gravity_y", "m/s2", free_fall},
       {"gravity_z", "m/s2", free_fall},
       {"offset_x", "N", offset},
       {"offset_y", "N", offset},
       {"offset_z", "N", offset},
       {"drift_x", "N/K", drift},
       {"drift_y", "N/K", drift},
       {"drift_z", "N/K", drift},
       {"com_x", "m", com},
       {"com_y", "m", com},
       {"com_z", "m", com},
       {"torque_offset_x", "N m", torque},
       {"torque_offset_y", "N m", torque},
       {"torque_offset_z", "N m", torque},
       {"torque_drift_x", "N m/K", torque_drift},
       {"torque_drift_y", "N m/K", torque_drift},
       {"torque_drift_z", "N m/K", torque_drift},
       {"weight_at_x", "m", hung},
       {"weight_at_y", "m", hung},
       {"weight_at_z", "m", hung},
       {"arm_xx", "m/N", arm},
       {"arm_yy", "m/N", arm},
       {"arm_zz", "m/N", arm},
       {"arm_xy", "m/N", arm},
       {"arm_xz", "m/N", arm},
       {"arm_yz", "m/N", arm}}};
  return all;
}

Vec3 Calibration::vector(CalibratedNumber first) const {
  return {numbers[first].value, numbers[first + 1].value, numbers[first + 2].value};
}

Eigen::Matrix3d Calibration::symmetric(CalibratedNumber first) const {
  Eigen::Matrix3d M;
  for (std::size_t k = 0; k < kSymmetric; ++k) {
    const MatrixPlace& at = kSymmetricPlaces[k];
    M(at.row, at.column) = M(at.column, at.row) = numbers[first + k].value;
  }
  return M;
}

Eigen::Matrix3d Calibration::rotation() const {
  return rotation_of(vector(kRotation));
}

Eigen::Matrix3d Calibration::crosstalk() const {
  return has(kCrosstalk) ? symmetric(kCrosstalk) : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
}

double Calibration::sign() const {
  return crosstalk().trace() < 0 ? -1 : 1;
}

double Calibration::temp_ref() const {
  return metadata.number("temp_ref", name).value_or(0);
}

}  // namespace hapsim
