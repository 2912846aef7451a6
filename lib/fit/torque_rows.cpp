#include "fit/torque_rows.h"

#include <algorithm>
#include <cmath>

#include "effects/catalogue.h"
#include "fit/press_offsets.h"
#include "recording/torque_columns.h"

namespace hapsim {
namespace {

bool has_sensor(const Model& model) {
  return std::any_of(model.parameters.begin(), model.parameters.end(), [](const Parameter& p) {
    return require_effect(p.effect).card().stage == Stage::kSensor;
  });
}

}  // namespace

TorqueRows::TorqueRows(const Model& start, const Experiment& experiment, const Selection& selection,
                       const FitOptions& options, bool offsets)
    : experiment_(&experiment),
      selection_(&selection),
      exact_regions_(options.exact_regions),
      offsets_(offsets),
      floor_(options.floor) {
  const Recording& recording = experiment.dataset.recording;
  Torques torques = read_torques(recording);
  unused_ = torques.unused;
  if (torques.values.empty()) return;
  if (const std::string why = torque_refusal(start, experiment.dataset); !why.empty()) {
    unused_ = "torques of the recording do not count: " + why;
    return;
  }
  noise_ = torque_noise(recording, torques.values);
  measured_ = stacked(torques.values, experiment.dataset, selection);
  const MaterialSpec material = material_of(start);
  solve(material);
  // The weights are constant, by the forces that the start has. Where these leave so many times
  // their noise, the model is thought to leave as many times that of torques.
  const double scale = std::max(1.0, options.noise / experiment.noise.value);
  weights_ = std::make_shared<const TorqueWeights>(
      experiment.dataset, selection, solved_forces(start, experiment, selection, false).f, levers_,
      material, scale * noise_.value, floor_);
}

void TorqueRows::solve(const MaterialSpec& material) {
  if (empty()) return;
  levers_ = TorqueLevers(experiment_->places, material, exact_regions_);
}

Signal TorqueRows::modelled(const Model& model, const Linearisation& about, const Signal* forces,
                            bool derivatives) const {
  const MaterialSpec material = material_of(model);
  Signal torques =
      forces != nullptr && !has_sensor(model)
          ? model_torques(*forces, experiment_->dataset, levers_, material, *selection_)
          : model_torques(
                forces_before_sensor(model, *experiment_, about, *selection_, derivatives),
                experiment_->dataset, levers_, material, *selection_);
  torques.f -= measured_;
  if (offsets_) {
    take_out_press_means(experiment_->dataset, *selection_, torques.f);
    if (derivatives) take_out_press_means(experiment_->dataset, *selection_, torques.df);
  }
  return torques;
}

void TorqueRows::append(const Model& model, const Linearisation& about, const Signal& forces,
                        Eigen::VectorXd& r, Eigen::MatrixXd* J) const {
  if (empty()) return;
  Signal torques = modelled(model, about, &forces, J != nullptr);
  weights_->whiten(torques.f);
  const Eigen::Index before = r.size();
  r.conservativeResize(before + torques.f.size());
  r.tail(torques.f.size()) = torques.f;
  if (J == nullptr) return;
  weights_->whiten(torques.df);
  J->conservativeResize(before + torques.f.size(), Eigen::NoChange);
  J->bottomRows(torques.f.size()) = torques.df;
}

TorqueError torque_error(const Fit& fitted, const Experiment& experiment,
                         const Selection& selection, const FitOptions& options) {
  return TorqueRows(fitted.model, experiment, selection, options,
                    offset_effect(fitted.model) != nullptr)
      .error(fitted.model, fitted.about);
}

TorqueError TorqueRows::error(const Model& model, const Linearisation& about) const {
  TorqueError error;
  error.unused = unused_;
  if (empty()) return error;
  Signal left = modelled(model, about, nullptr, false);
  const auto count = static_cast<double>(left.f.size());
  error.rows = static_cast<std::size_t>(left.f.size() / 3);
  error.rms = std::sqrt(left.f.squaredNorm() / count);
  error.size = std::sqrt(measured_.squaredNorm() / count);
  error.noise = noise_.value;
  error.noise_origin = noise_.origin;
  weights_->whiten(left.f);
  error.whitened = std::sqrt(left.f.squaredNorm() / count);
  return error;
}

}  // namespace hapsim
