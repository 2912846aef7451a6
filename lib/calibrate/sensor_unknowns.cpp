#include "calibrate/sensor_unknowns.h"

#include "rig/calibration.h"

namespace hapsim {
namespace {

class Collector {
 public:
  explicit Collector(SensorUnknowns& to) : to_(to) {
    to_.basis = Eigen::MatrixXd::Zero(kSensorNumbers, 0);
  }

  // One unknown that moves several numbers of the state.
  void add(const std::string& name, SensorGroup group, double scale,
           const std::vector<std::pair<int, double>>& moves) {
    to_.names.push_back(name);
    to_.group.push_back(group);
    to_.unknowns.push_back({.scale = scale});
    to_.basis.conservativeResize(Eigen::NoChange, to_.basis.cols() + 1);
    to_.basis.rightCols<1>().setZero();
    for (const auto& [number, factor] : moves) to_.basis(number, to_.basis.cols() - 1) = factor;
  }

  void add_three(CalibratedNumber name, int number, SensorGroup group, double scale) {
    for (int k = 0; k < 3; ++k)
      add(calibrated_names()[static_cast<std::size_t>(name + k)].name, group, scale,
          {{number + k, 1.0}});
  }

 private:
  SensorUnknowns& to_;
};

}  // namespace

SensorUnknowns sensor_unknowns(const SensorTerms& terms, const SensorState& state) {
  constexpr double kShare = 0.05, kLength = 0.02, kKelvin = 10;
  const double weight = state.mass * state.gravity.norm();
  SensorUnknowns result;
  Collector to(result);
  to.add_three(kRotation, kTurn, kAlways, kShare);
  const auto talk = [](int k) {
    return calibrated_names()[static_cast<std::size_t>(kCrosstalk + k)].name;
  };
  if (terms.crosstalk) {
    // Without a scale the gains sum up to that of three axes that are right.
    const bool free = terms.scale != Scale::kMeanGain;
    for (int k = 0; k < 6; ++k) {
      if (free || k > 2)
        to.add(talk(k), kOfCrosstalk, kShare, {{kTalk + k, 1.0}});
      else if (k < 2)
        to.add(talk(k), kOfCrosstalk, kShare, {{kTalk + k, 1.0}, {kTalk + 2, -1.0}});
    }
  } else if (terms.scale != Scale::kMeanGain) {
    to.add("gain", kAlways, kShare, {{kTalk, 1.0}, {kTalk + 1, 1.0}, {kTalk + 2, 1.0}});
  }
  if (terms.scale != Scale::kKnownMass)
    to.add(calibrated_names()[kMass].name, kAlways, kShare * state.mass, {{kToolMass, 1.0}});
  if (terms.gravity)
    for (int k = 0; k < 2; ++k) to.add("gravity", kOfGravity, kShare, {{kTilt + k, 1.0}});
  to.add_three(kOffset, kZero, kAlways, kShare * weight);
  if (terms.drift) to.add_three(kDrift, kZeroDrift, kOfDrift, kShare * weight / kKelvin);
  if (terms.torque) {
    to.add_three(kCom, kCentre, kOfTorque, kLength);
    to.add_three(kTorqueOffset, kTorqueZero, kOfTorque, kLength * weight);
    if (terms.torque_drift)
      to.add_three(kTorqueDrift, kTorqueZeroDrift, kOfTorqueDrift, kLength * weight / kKelvin);
    if (terms.weight_at) to.add_three(kWeightAt, kHung, kOfTorque, kLength);
  }
  return result;
}

}  // namespace hapsim
