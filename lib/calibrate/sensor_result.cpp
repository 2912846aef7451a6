#include "calibrate/sensor_result.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "calibrate/intervals.h"
#include "io/number.h"
#include "rig/rotation_vector.h"

namespace hapsim {
namespace {

void set_state(Calibration& c, int first, int count, const std::string& state) {
  for (int k = first; k < first + count; ++k) c.numbers[static_cast<std::size_t>(k)].state = state;
}

const char* scale_words(const SensorFit& fit) {
  switch (fit.terms.scale) {
    case Scale::kKnownWeight:
      return "known weight";
    case Scale::kKnownMass:
      return "known mass of the tool";
    default:
      return "mean gain of the three axes taken for 1";
  }
}

}  // namespace

Eigen::MatrixXd number_slopes(const SensorFit& fit) {
  const Eigen::MatrixXd& B = fit.unknowns.basis;
  Eigen::MatrixXd D = Eigen::MatrixXd::Zero(kCalibratedNumbers, B.cols());
  D.middleRows<3>(kRotation) =
      left_jacobian(rotation_vector(fit.state.rotation)).inverse() * B.middleRows<3>(kTurn);
  D.middleRows<6>(kCrosstalk) = B.middleRows<6>(kTalk);
  D.row(kMass) = B.row(kToolMass);
  D.middleRows<3>(kGravity) =
      -cross_matrix(fit.state.gravity) * tilt_axes(fit.state.gravity) * B.middleRows<2>(kTilt);
  constexpr std::pair<CalibratedNumber, SensorNumber> kSame[] = {{kOffset, kZero},
                                                                 {kDrift, kZeroDrift},
                                                                 {kCom, kCentre},
                                                                 {kTorqueOffset, kTorqueZero},
                                                                 {kTorqueDrift, kTorqueZeroDrift},
                                                                 {kWeightAt, kHung}};
  for (const auto& [number, moved] : kSame) D.middleRows<3>(number) = B.middleRows<3>(moved);
  return D;
}

Calibration calibration_of(const SensorState& s) {
  Calibration c;
  const auto set = [&c](CalibratedNumber first, const Vec3& v) {
    for (int k = 0; k < 3; ++k) c.numbers[static_cast<std::size_t>(first + k)].value = v[k];
  };
  set(kRotation, rotation_vector(s.rotation));
  for (std::size_t k = 0; k < kSymmetric; ++k)
    c.numbers[kCrosstalk + k].value =
        s.crosstalk(kSymmetricPlaces[k].row, kSymmetricPlaces[k].column);
  c.numbers[kMass].value = s.mass;
  set(kGravity, s.gravity);
  set(kOffset, s.offset);
  set(kDrift, s.drift);
  set(kCom, s.com);
  set(kTorqueOffset, s.torque_offset);
  set(kTorqueDrift, s.torque_drift);
  set(kWeightAt, s.weight_at);
  return c;
}

Calibration calibration_of(const SensorFit& fit, const StaticPoses& poses,
                           const SensorOptions& options) {
  Calibration c = calibration_of(fit.state);
  const SensorTerms& terms = fit.terms;
  set_state(c, kRotation, 3, "fitted");
  const bool gain = !terms.crosstalk && terms.scale != Scale::kMeanGain;
  if (terms.crosstalk || gain || fit.state.sign < 0) set_state(c, kCrosstalk, 6, "assumed");
  if (terms.crosstalk) set_state(c, kCrosstalk, 6, "fitted");
  if (gain) set_state(c, kCrosstalk, 3, "fitted");
  set_state(c, kMass, 1, options.mass ? "given" : "fitted");
  set_state(c, kGravity, 3, terms.gravity ? "fitted" : "given");
  set_state(c, kOffset, 3, "fitted");
  if (terms.drift) set_state(c, kDrift, 3, "fitted");
  if (terms.torque) {
    set_state(c, kCom, 3, "fitted");
    set_state(c, kTorqueOffset, 3, "fitted");
    if (terms.torque_drift) set_state(c, kTorqueDrift, 3, "fitted");
    if (terms.weight_at) set_state(c, kWeightAt, 3, "fitted");
  }
  const Eigen::MatrixXd D = number_slopes(fit), covariance = D * fit.covariance * D.transpose();
  const double of_force = student_quantile(kCalibrationConfidence, fit.force_freedom),
               of_torque = terms.torque && fit.torque_freedom > 0
                               ? student_quantile(kCalibrationConfidence, fit.torque_freedom)
                               : 0;
  for (int k = 0; k < kCalibratedNumbers; ++k) {
    CalibratedValue& n = c.numbers[static_cast<std::size_t>(k)];
    if (n.state != "fitted") continue;
    n.std_error = std::sqrt(std::max(0.0, covariance(k, k)));
    const double half = (k < kCom ? of_force : of_torque) * n.std_error;
    n.lower = n.value - half;
    n.upper = n.value + half;
  }
  Metadata& m = c.metadata;
  m.set("source", poses.name);
  m.set("poses", std::to_string(poses.poses.size()));
  m.set("scale", scale_words(fit));
  m.set("force_noise", fmt::format("{:.4g}", fit.force_noise));
  if (terms.torque) m.set("torque_noise", fmt::format("{:.4g}", fit.torque_noise));
  if (poses.temps) {
    const auto [cold, warm] = std::minmax_element(
        poses.poses.begin(), poses.poses.end(),
        [](const StaticPose& a, const StaticPose& b) { return a.temp < b.temp; });
    m.set("temp_ref", fmt::format("{:.6g}", fit.state.temp_ref));
    m.set("temp_range", fmt::format("{:.4g},{:.4g}", cold->temp, warm->temp));
  }
  return c;
}

}  // namespace hapsim
