#include "diagnose/torque_left.h"

#include <fmt/format.h>

#include <algorithm>

#include "compare/torque_comparison.h"
#include "diagnose/gates.h"
#include "diagnose/held_out.h"
#include "diagnose/measure.h"
#include "fit/press_offsets.h"
#include "fit/torque_rows.h"
#include "recording/torque_columns.h"

namespace hapsim {
namespace {

// Measured from differences, noise is too small where it has a colour (left_over.cpp).
constexpr double kMostTold = 1.15, kMostMeasured = 1.3;
constexpr double kMostForce = 1.1;  // of the forces' own error

// What the model leaves, less the means where each press has its offset.
TorquePole pole_of(const Fit& fitted, const TrialGround& g, double noise) {
  const Selection all = all_episodes(g.dataset);
  const Signal forces = forces_before_sensor(fitted.model, g.experiment, fitted.about, all, false);
  const MaterialSpec material = material_of(fitted.model);
  const TorqueLevers levers(g.experiment.places, material, true);
  Eigen::MatrixXd residual = stacked(read_torques(g.dataset.recording).values, g.dataset, all) -
                             model_torques(forces, g.dataset, levers, material, all).f;
  Eigen::MatrixXd f = forces.f;
  if (offset_effect(fitted.model) != nullptr) {
    take_out_press_means(g.dataset, all, residual);
    take_out_press_means(g.dataset, all, f);
  }
  return torque_pole(residual.col(0), f.col(0), noise);
}

}  // namespace

TorqueLeft torque_left(const Fit& fitted, const TrialGround& g) {
  TorqueLeft left;
  if (!has_torques(g.dataset.recording)) {
    left.error.unused = read_torques(g.dataset.recording).unused;
    if (!left.error.unused.empty()) left.words = "T" + left.error.unused.substr(1) + ".";
    return left;
  }
  FitOptions options = trial_fit_options(g);
  options.torques = true;
  const Fit both = fit(fitted.model, g.experiment, all_episodes(g.dataset), options, fitted.about);
  left.error = both.torque;
  if (left.error.rows == 0) {
    if (!left.error.unused.empty()) left.words = "T" + left.error.unused.substr(1) + ".";
    return left;
  }
  left.force_error = both.error.pooled / fitted.error.pooled;
  const bool measured = left.error.noise_origin == "measured from the data";
  const bool torque = !(left.error.whitened <= (measured ? kMostMeasured : kMostTold));
  const bool force =
      left.force_error > kMostForce && both.error.pooled > kLikeNoise * g.allowance.noise;
  left.off = torque || force;
  if (!left.off) return left;
  left.pole = pole_of(torque ? both : fitted, g, left.error.noise);
  left.words = fmt::format(
      "the tool's torques are not those of the model: {:.3g} N m is left of {:.3g}, {:.2g} x their "
      "noise and {:.2g} x what noise and meshes let it be",
      left.error.rms, left.error.size, left.error.rms / left.error.noise, left.error.whitened);
  if (force && !torque)
    left.words = fmt::format(
        "the model has the tool's torques at the price of the forces alone: their error is {:.2g} "
        "times what it is without torques",
        left.force_error);
  const std::string pole = pole_words(left.pole, left.error.rms);
  left.words += pole.empty() ? "; look at the torques' zero, the tool's weight, its tip, and at "
                               "what lies beside the places"
                             : "; " + pole;
  left.words += '.';
  return left;
}

}  // namespace hapsim
