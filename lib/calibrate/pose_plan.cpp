#include "calibrate/pose_plan.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/random.h"
#include "io/csv.h"
#include "rig/calibration.h"
#include "rig/rotation_vector.h"

namespace hapsim {
namespace {

constexpr int kDirections = 300, kJointSets = 600;

// A turn about a horizontal axis of the base tells of gravity's direction what none about gravity
// does: these many spins of each candidate about gravity, where that is asked for.
constexpr int kSpins = 4;

std::vector<PlannedPose> by_hand(const Eigen::Matrix3d& from, const Vec3& gravity, double tilt,
                                 int spins) {
  std::vector<PlannedPose> all;
  const Vec3 start = from.transpose() * gravity.normalized();
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));  // of Fibonacci's lattice
  for (int i = 0; i < kDirections; ++i) {
    const double z = 1 - (2 * i + 1.0) / kDirections, ring = std::sqrt(1 - z * z);
    const Vec3 down(ring * std::cos(i * golden), ring * std::sin(i * golden), z);
    if (std::acos(std::clamp(down.dot(start), -1.0, 1.0)) > tilt) continue;
    // The least turn that brings it there.
    const Eigen::Matrix3d turn = Eigen::Quaterniond::FromTwoVectors(down, start).toRotationMatrix();
    for (int spin = 0; spin < spins; ++spin) {
      const Eigen::Matrix3d about =
          rotation_of(2 * std::numbers::pi * spin / spins * gravity.normalized());
      const Eigen::Matrix3d R = about * from * turn;
      all.push_back({{}, R, R.transpose() * gravity.normalized(), 0, ""});
    }
  }
  return all;
}

std::vector<PlannedPose> by_robot(const Robot& robot, const Eigen::Matrix3d& from,
                                  const Vec3& gravity, double tilt) {
  std::vector<PlannedPose> all;
  Random random(1);
  const Vec3 start = from.transpose() * gravity.normalized();
  for (int i = 0; i < kJointSets; ++i) {
    Eigen::VectorXd q(static_cast<Eigen::Index>(robot.joints().size()));
    for (std::size_t j = 0; j < robot.joints().size(); ++j) {
      const RobotJoint& joint = robot.joints()[j];
      const double low = std::max(joint.lower, -std::numbers::pi),
                   high = std::min(joint.upper, std::numbers::pi);
      q[static_cast<Eigen::Index>(j)] = low + (high - low) * random.uniform();
    }
    const Eigen::Matrix3d R = robot.forward(q).linear();
    const Vec3 down = R.transpose() * gravity.normalized();
    if (std::acos(std::clamp(down.dot(start), -1.0, 1.0)) > tilt) continue;
    all.push_back({q, R, down, 0, ""});
  }
  return all;
}

Eigen::VectorXd errors(const Eigen::MatrixXd& covariance, const SensorUnknowns& unknowns) {
  Eigen::VectorXd e(covariance.rows());
  for (Eigen::Index k = 0; k < e.size(); ++k)
    e[k] = std::sqrt(covariance(k, k)) * unknowns.unknowns[static_cast<std::size_t>(k)].scale;
  return e;
}

}  // namespace

PosePlan plan_poses(const StaticPoses& poses, const SensorFit& fit, const SensorOptions& options,
                    const PosePlanOptions& plan) {
  constexpr double kPrior = 0.1;  // 1 over its standard error, in steps
  const bool any = !poses.poses.empty();
  SensorState state = fit.state;
  if (!any) {
    state.mass = options.mass.value_or(1);
    state.gravity = options.gravity.value_or(state.gravity);
  }
  SensorTerms terms = wanted_terms(poses, options);
  // Other poses do not tell of another temperature.
  terms.drift = fit.terms.drift && any;
  terms.torque_drift = fit.terms.torque_drift && any;
  const SensorUnknowns unknowns = sensor_unknowns(terms, state);
  const double weight = state.mass * state.gravity.norm();
  const double force_noise = any && fit.force_freedom > 1 ? fit.force_noise : 1e-3 * weight;
  const double torque_noise =
      any && fit.torque_freedom > 1 ? fit.torque_noise : 1e-3 * weight * 0.1;
  Eigen::VectorXd scale(unknowns.basis.cols());
  for (Eigen::Index k = 0; k < scale.size(); ++k)
    scale[k] = unknowns.unknowns[static_cast<std::size_t>(k)].scale;

  const auto rows_of = [&](const std::vector<StaticPose>& at) -> Eigen::MatrixXd {
    return whitened_slopes(state, unknowns, at, force_noise, torque_noise) * scale.asDiagonal();
  };
  Eigen::MatrixXd information =
      kPrior * kPrior * Eigen::MatrixXd::Identity(scale.size(), scale.size());
  if (any) {
    const Eigen::MatrixXd J = rows_of(poses.poses);
    information += J.transpose() * J;
  }
  const Eigen::MatrixXd I = Eigen::MatrixXd::Identity(scale.size(), scale.size());
  Eigen::MatrixXd covariance = information.ldlt().solve(I);

  const Eigen::Matrix3d from =
      any ? poses.poses.front().orientation : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
  std::vector<PlannedPose> candidates =
      plan.robot != nullptr ? by_robot(*plan.robot, from, state.gravity, plan.tilt)
                            : by_hand(from, state.gravity, plan.tilt, terms.gravity ? kSpins : 1);
  double largest = 0, temp = state.temp_ref;
  for (const StaticPose& p : poses.poses) largest = std::max(largest, p.load);
  if (largest > 0) {
    const std::vector<PlannedPose> bare = candidates;
    for (PlannedPose p : bare) {
      p.load = largest;
      candidates.push_back(p);
    }
  }
  std::vector<Eigen::MatrixXd> rows;
  for (const PlannedPose& p : candidates)
    rows.push_back(rows_of({{.orientation = p.orientation, .temp = temp, .load = p.load}}));

  PosePlan result;
  result.names = unknowns.names;
  for (const std::string& name : unknowns.names) {
    std::string unit = name == "gravity" ? "rad" : "1";
    for (const CalibratedName& known : calibrated_names())
      if (name == known.name) unit = known.unit;
    result.units.push_back(unit);
  }
  result.known_below = scale;
  result.error_now = errors(covariance, unknowns);
  for (std::size_t chosen = 0; chosen < plan.poses && !candidates.empty(); ++chosen) {
    std::size_t best = 0;
    double most = -1;
    for (std::size_t c = 0; c < candidates.size(); ++c) {
      const Eigen::MatrixXd gain = rows[c] * covariance * rows[c].transpose();
      const double grows =
          (Eigen::MatrixXd::Identity(gain.rows(), gain.cols()) + gain).determinant();
      if (grows > most * (1 + 1e-9)) most = grows, best = c;
    }
    information += rows[best].transpose() * rows[best];
    const Eigen::MatrixXd next = information.ldlt().solve(I);
    Eigen::Index told = 0;
    (covariance.diagonal().array() / next.diagonal().array()).maxCoeff(&told);
    covariance = next;
    result.poses.push_back(candidates[best]);
    candidates.erase(candidates.begin() + static_cast<std::ptrdiff_t>(best));
    rows.erase(rows.begin() + static_cast<std::ptrdiff_t>(best));
    result.poses.back().tells = unknowns.names[static_cast<std::size_t>(told)];
  }
  result.error_then = errors(covariance, unknowns);
  return result;
}

void write_pose_plan(std::ostream& out, const PosePlan& plan, bool loads) {
  std::vector<std::string> header{"pose"};
  const auto joints = plan.poses.empty() ? 0 : plan.poses.front().q.size();
  for (Eigen::Index j = 0; j < joints; ++j) header.push_back(fmt::format("q{}", j + 1));
  for (const char* name : {"qw", "qx", "qy", "qz", "down_x", "down_y", "down_z"})
    header.emplace_back(name);
  if (loads) header.emplace_back("load");
  header.emplace_back("tells");
  CsvWriter writer(out, {}, header);
  for (std::size_t i = 0; i < plan.poses.size(); ++i) {
    const PlannedPose& p = plan.poses[i];
    std::vector<std::string> row{std::to_string(i + 1)};
    const auto put = [&row](double value) { row.push_back(fmt::format("{:.5f}", value + 0.0)); };
    for (Eigen::Index j = 0; j < joints; ++j) put(p.q[j]);
    const Eigen::Quaterniond q(p.orientation);
    for (const double value : {q.w(), q.x(), q.y(), q.z()}) put(value);
    for (int k = 0; k < 3; ++k) put(p.down[k]);
    if (loads) row.push_back(format_number(p.load));
    row.push_back(p.tells);
    writer.row(row);
  }
}

}  // namespace hapsim
