#include "calibrate/sensor_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "calibrate/sensor_start.h"
#include "estimate/least_squares.h"

namespace hapsim {
namespace {

constexpr double kSpareNumbers = 3;  // beyond the unknowns, to know the noise by

Eigen::Index components(const SensorTerms& terms) {
  return terms.torque ? 6 : 3;
}

Eigen::MatrixXd residuals_of(const SensorState& state, const StaticPoses& poses,
                             Eigen::Index columns) {
  Eigen::MatrixXd r(static_cast<Eigen::Index>(poses.poses.size()), columns);
  for (Eigen::Index i = 0; i < r.rows(); ++i) {
    const StaticPose& p = poses.poses[static_cast<std::size_t>(i)];
    const Wrench shown = shown_wrench(state, p);
    r.row(i).head<3>() = (p.force - shown.value.head<3>()).transpose();
    if (columns == 6) r.row(i).tail<3>() = (p.torque - shown.value.tail<3>()).transpose();
  }
  return r;
}

// The whitened residuals as one column, pose by pose.
Eigen::VectorXd whitened(const Eigen::MatrixXd& residual, double force_noise, double torque_noise) {
  Eigen::MatrixXd w = residual.transpose();
  w.topRows<3>() /= force_noise;
  if (w.rows() == 6) w.bottomRows<3>() /= torque_noise;
  return w.reshaped();
}

// The noise of three columns by the degrees of freedom that the fit leaves them.
struct NoiseShare {
  double sigma = 0, freedom = 0;
};
NoiseShare noise_of(const SensorFit& fit, const Eigen::MatrixXd& J, Eigen::Index first,
                    double least) {
  const Eigen::Index n = fit.residual.rows(), width = fit.residual.cols();
  double used = 0;  // trace of the hat matrix over these rows
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto rows = J.middleRows(width * i + first, 3);
    used += (rows * fit.covariance).cwiseProduct(rows).sum();
  }
  NoiseShare share;
  share.freedom = 3 * static_cast<double>(n) - used;
  share.sigma =
      std::sqrt(fit.residual.middleCols(first, 3).squaredNorm() / std::max(share.freedom, 1e-3));
  share.sigma = std::max(share.sigma, least);
  return share;
}

double rms(const StaticPoses& poses, Vec3 StaticPose::*what) {
  double sum = 0;
  for (const StaticPose& p : poses.poses) sum += (p.*what).squaredNorm();
  return std::sqrt(sum / static_cast<double>(3 * poses.poses.size()));
}

// The fit of these terms, from a start; noise and fit in turn until both stand.
SensorFit fit_terms(const StaticPoses& poses, const SensorTerms& terms, const SensorState& start) {
  constexpr double kExact = 1e-9;  // of the forces: data without noise
  const double least_f = std::max(kExact * rms(poses, &StaticPose::force), 1e-12),
               least_t = std::max(kExact * rms(poses, &StaticPose::torque), 1e-12);
  SensorFit fit;
  fit.terms = terms;
  fit.state = start;
  fit.force_noise = std::max(1e-2 * rms(poses, &StaticPose::force), least_f);
  fit.torque_noise = std::max(1e-2 * rms(poses, &StaticPose::torque), least_t);
  const Eigen::Index width = components(terms);
  for (int round = 0; round < 30; ++round) {
    fit.unknowns = sensor_unknowns(terms, fit.state);
    const auto misfit = [&](const Eigen::VectorXd& x, Eigen::VectorXd& r, Eigen::MatrixXd* J) {
      const SensorState at = moved(fit.state, fit.unknowns.basis * x);
      r = -whitened(residuals_of(at, poses, width), fit.force_noise, fit.torque_noise);
      // Small turns count from the state here, which differs from those in x by second order.
      if (J != nullptr)
        *J = whitened_slopes(at, fit.unknowns, poses.poses, fit.force_noise, fit.torque_noise);
    };
    const LeastSquaresResult found = minimise(fit.unknowns.unknowns, misfit,
                                              {.max_iterations = 60, .decrease_tolerance = 1e-10});
    fit.state = moved(fit.state, fit.unknowns.basis * found.x);
    const Eigen::MatrixXd J =
        whitened_slopes(fit.state, fit.unknowns, poses.poses, fit.force_noise, fit.torque_noise);
    fit.covariance = found.covariance;
    fit.residual = residuals_of(fit.state, poses, width);
    const double before_f = fit.force_noise, before_t = fit.torque_noise;
    const NoiseShare f = noise_of(fit, J, 0, least_f);
    fit.force_noise = f.sigma;
    fit.force_freedom = f.freedom;
    if (terms.torque) {
      const NoiseShare t = noise_of(fit, J, 3, least_t);
      fit.torque_noise = t.sigma;
      fit.torque_freedom = t.freedom;
    }
    double move = 0;
    for (std::size_t k = 0; k < fit.unknowns.unknowns.size(); ++k)
      move = std::max(
          move, std::abs(found.x[static_cast<Eigen::Index>(k)]) / fit.unknowns.unknowns[k].scale);
    const bool stands = std::abs(fit.force_noise - before_f) < 1e-6 * before_f &&
                        (!terms.torque || std::abs(fit.torque_noise - before_t) < 1e-6 * before_t);
    if (stands && move < 1e-6) break;
  }
  const Eigen::MatrixXd J =
      whitened_slopes(fit.state, fit.unknowns, poses.poses, fit.force_noise, fit.torque_noise);
  fit.blind = blind_directions(fit.unknowns.unknowns, fit.unknowns.names, J);
  const auto spare = static_cast<double>(fit.residual.size() - J.cols());
  fit.determined = fit.blind.empty() && spare >= kSpareNumbers && fit.force_freedom > 1;
  if (fit.determined)
    fit.covariance =
        (J.transpose() * J).ldlt().solve(Eigen::MatrixXd::Identity(J.cols(), J.cols()));
  return fit;
}

// From several directions of gravity where that is asked for: the one that leaves least.
SensorFit best_fit(const StaticPoses& poses, const SensorTerms& terms, const SensorState& start) {
  std::vector<Vec3> directions{start.gravity};
  if (terms.gravity)
    for (int k = 0; k < 3; ++k)
      for (const double sign : {1.0, -1.0})
        directions.emplace_back(sign * start.gravity.norm() * Vec3::Unit(k));
  SensorFit best;
  for (const Vec3& gravity : directions) {
    SensorState from = start;
    from.gravity = gravity;
    SensorFit fit = fit_terms(poses, terms, closed_form(poses, terms.scale, from));
    if (best.residual.size() == 0 ||
        fit.residual.squaredNorm() < 0.999 * best.residual.squaredNorm())
      best = std::move(fit);
  }
  return best;
}

// The term that can be left out and has the largest part in what is not seen; kAlways: none.
SensorGroup most_open(const SensorFit& fit, bool crosstalk_asked, bool gravity_asked) {
  double share[kOfTorqueDrift + 1] = {};
  for (const BlindDirection& blind : fit.blind)
    for (std::size_t k = 0; k < fit.unknowns.group.size(); ++k)
      share[fit.unknowns.group[k]] += blind.direction[static_cast<Eigen::Index>(k)] *
                                      blind.direction[static_cast<Eigen::Index>(k)];
  if (fit.blind.empty())  // too few numbers to know the noise by
    share[kOfDrift] = share[kOfTorqueDrift] = 2, share[kOfCrosstalk] = 1;
  if (crosstalk_asked || !fit.terms.crosstalk) share[kOfCrosstalk] = 0;
  if (gravity_asked) share[kOfGravity] = 0;
  if (!fit.terms.drift) share[kOfDrift] = 0;
  if (!fit.terms.torque_drift) share[kOfTorqueDrift] = 0;
  share[kAlways] = share[kOfTorque] = 0;
  const auto* const most = std::max_element(std::begin(share), std::end(share));
  constexpr double kLeast = 0.02;
  return *most < kLeast ? kAlways : static_cast<SensorGroup>(most - share);
}

void leave_out(SensorTerms& terms, SensorGroup group) {
  if (group == kOfCrosstalk) terms.crosstalk = false;
  if (group == kOfDrift) terms.drift = false;
  if (group == kOfTorqueDrift) terms.torque_drift = false;
  if (group == kOfGravity) terms.gravity = false;
}

}  // namespace

SensorTerms wanted_terms(const StaticPoses& poses, const SensorOptions& options) {
  const auto [low, high] =
      std::minmax_element(poses.poses.begin(), poses.poses.end(),
                          [](const StaticPose& a, const StaticPose& b) { return a.load < b.load; });
  const auto [cold, warm] =
      std::minmax_element(poses.poses.begin(), poses.poses.end(),
                          [](const StaticPose& a, const StaticPose& b) { return a.temp < b.temp; });
  const bool any = !poses.poses.empty();
  SensorTerms terms;
  terms.scale = options.mass                    ? Scale::kKnownMass
                : any && high->load > low->load ? Scale::kKnownWeight
                                                : Scale::kMeanGain;
  terms.crosstalk = options.crosstalk != "off";
  terms.drift = any && poses.temps && warm->temp > cold->temp;
  terms.gravity = !options.gravity;
  terms.torque = poses.torques;
  terms.torque_drift = terms.torque && terms.drift;
  terms.weight_at = terms.torque && any && high->load > 0;
  return terms;
}

SensorFit fit_sensor(const StaticPoses& poses, const SensorOptions& options) {
  SensorState start;
  start.mass = options.mass.value_or(1);
  if (options.gravity) start.gravity = *options.gravity;
  double mean = 0;
  for (const StaticPose& p : poses.poses) mean += p.temp / static_cast<double>(poses.poses.size());
  start.temp_ref = poses.metadata.number("temp_ref", poses.name).value_or(mean);
  SensorTerms terms = wanted_terms(poses, options);
  std::vector<SensorGroup> left_out;
  for (;;) {
    SensorFit fit = best_fit(poses, terms, start);
    const SensorGroup open =
        fit.determined ? kAlways : most_open(fit, options.crosstalk == "on", !options.gravity);
    if (open == kAlways) {
      fit.left_out = left_out;
      return fit;
    }
    left_out.push_back(open);
    leave_out(terms, open);
  }
}

Eigen::MatrixXd whitened_slopes(const SensorState& state, const SensorUnknowns& unknowns,
                                const std::vector<StaticPose>& poses, double force_noise,
                                double torque_noise) {
  const bool torque = std::any_of(unknowns.group.begin(), unknowns.group.end(),
                                  [](int group) { return group == kOfTorque; });
  const Eigen::Index width = torque ? 6 : 3;
  Eigen::MatrixXd J(width * static_cast<Eigen::Index>(poses.size()), unknowns.basis.cols());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Eigen::MatrixXd slope = shown_wrench(state, poses[i]).slope * unknowns.basis;
    const Eigen::Index row = width * static_cast<Eigen::Index>(i);
    J.middleRows(row, 3) = slope.topRows<3>() / force_noise;
    if (torque) J.middleRows(row + 3, 3) = slope.bottomRows<3>() / torque_noise;
  }
  return J;
}

}  // namespace hapsim
