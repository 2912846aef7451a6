#include "experiment/torques.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>

#include "effects/catalogue.h"
#include "model/relaxation_steps.h"
#include "recording/torque_columns.h"

namespace hapsim {
namespace {

// The longest press, as effects see it.
PressView example_press(const Dataset& dataset) {
  const auto longest = std::max_element(
      dataset.episodes.begin(), dataset.episodes.end(),
      [](const Episode& a, const Episode& b) { return a.rows.size() < b.rows.size(); });
  PressView view = longest->view;
  view.modulus = view.contact.modulus = 1e4;
  return view;
}

// The force after an effect of the force f before it; where free values are those at which it does
// nothing, at others.
Eigen::VectorXd after(const EffectInstance& instance, const PressView& view,
                      const Eigen::VectorXd& f) {
  Values values = instance.values;
  for (ParameterValue& v : values) {
    const auto& cards = instance.effect->card().parameters;
    const auto card = std::find_if(cards.begin(), cards.end(),
                                   [&](const ParameterCard& c) { return c.name == v.name; });
    if (v.column >= 0 && card != cards.end() && v.value == card->identity)
      v.value = card->start == card->identity ? card->identity + card->scale : card->start;
    v.column = -1;
  }
  Signal signal{f, Eigen::MatrixXd(f.size(), 0)};
  instance.effect->apply(view, values, signal);
  return signal.f;
}

// Why an effect leaves torque and force no common lever: the tool touches otherwise; what it adds
// to the force comes not through the body (a dashpot at the tool); or the sensor shows the force
// changed, and would show the torque changed as well, nobody knows how. An offset of the forces is
// none of these.
bool has_no_lever(const EffectInstance& instance, const PressView& view) {
  const Stage stage = instance.effect->card().stage;
  if (stage == Stage::kContact) return true;
  const auto n = 3 * static_cast<Eigen::Index>(view.size());
  const Eigen::VectorXd nothing = after(instance, view, Eigen::VectorXd::Zero(n));
  if (stage == Stage::kBody && nothing.norm() > 0) return true;
  if (stage == Stage::kSensor) {
    const Eigen::VectorXd wave = Eigen::VectorXd::LinSpaced(n, 0.1, 3).array().sin().matrix();
    return !(after(instance, view, wave) - nothing).isApprox(wave, 1e-9);
  }
  MaterialSpec material;
  instance.effect->describe(instance.values, material);
  if (!material.features.empty()) return true;
  FullSpec spec;
  return instance.effect->full(instance.values, 1e4, spec) && spec.finite;
}

// The model without what its sensor does, and its columns among the whole one's.
Model before_sensor(const Model& model, std::vector<Eigen::Index>& columns) {
  Model bare = model;
  bare.parameters.clear();
  Eigen::Index column = 0;
  for (const Parameter& p : model.parameters) {
    const bool free = p.state == ParameterState::kFree;
    if (require_effect(p.effect).card().stage != Stage::kSensor) {
      bare.parameters.push_back(p);
      if (free) columns.push_back(column);
    }
    column += free ? 1 : 0;
  }
  return bare;
}

}  // namespace

std::string torque_refusal(const Model& model, const Dataset& dataset) {
  if (dataset.recording.has_ball()) return "under a ball the contact grows";
  if (tool_turns(dataset.recording)) return "the tool turns (thx,thy,thz)";
  for (const Episode& e : dataset.episodes)
    if (e.view.height > 0) return "the tool covers the whole body";
  if (dataset.episodes.empty()) return "";
  const PressView view = example_press(dataset);
  for (const EffectInstance& i : effect_instances(model, true))
    if (has_no_lever(i, view))
      return fmt::format("with '{}' they are no lever times the force", i.effect->card().name);
  if (!regional_relaxation_of(model, material_of(model)).empty())
    return "its regions relax each in its own way";
  return "";
}

Signal forces_before_sensor(const Model& model, const Experiment& experiment,
                            const Linearisation& about, const Selection& selection,
                            bool derivatives) {
  std::vector<Eigen::Index> columns;
  const Model bare = before_sensor(model, columns);
  Signal signal = model_forces(bare, experiment, about, selection, derivatives);
  if (!derivatives) return signal;
  const auto all = static_cast<Eigen::Index>(model.free_parameters().size());
  Eigen::MatrixXd df = Eigen::MatrixXd::Zero(signal.f.size(), all);
  for (std::size_t c = 0; c < columns.size(); ++c)
    df.col(columns[c]) = signal.df.col(static_cast<Eigen::Index>(c));
  signal.df = std::move(df);
  return signal;
}

Signal model_torques(const Signal& forces, const Dataset& dataset, const TorqueLevers& levers,
                     const MaterialSpec& material, const Selection& selection) {
  Signal torques{Eigen::VectorXd(forces.f.size()),
                 Eigen::MatrixXd(forces.df.rows(), forces.df.cols())};
  std::map<int, TorqueLever> known;
  Eigen::Index row = 0;
  for (const int e : selection) {
    const Episode& episode = dataset.episodes[static_cast<std::size_t>(e)];
    const auto [found, is_new] = known.try_emplace(episode.position);
    if (is_new) found->second = levers.at(static_cast<std::size_t>(episode.position), material);
    const TorqueLever& lever = found->second;
    for (std::size_t i = 0; i < episode.rows.size(); ++i, row += 3) {
      const Vec3 force = forces.f.segment<3>(row);
      torques.f.segment<3>(row) = lever.L * force;
      if (forces.df.cols() == 0) continue;
      torques.df.middleRows(row, 3).noalias() = lever.L * forces.df.middleRows(row, 3);
      for (const auto& [column, by] : lever.by_column)
        torques.df.block<3, 1>(row, column) += by * force;
    }
  }
  return torques;
}

Eigen::VectorXd stacked(const std::vector<Vec3>& of_rows, const Dataset& dataset,
                        const Selection& selection) {
  const std::vector<int> rows = stacked_rows(dataset, selection);
  Eigen::VectorXd all(3 * static_cast<Eigen::Index>(rows.size()));
  for (std::size_t i = 0; i < rows.size(); ++i)
    all.segment<3>(3 * static_cast<Eigen::Index>(i)) = of_rows[static_cast<std::size_t>(rows[i])];
  return all;
}

TorqueWeights::TorqueWeights(const Dataset& dataset, const Selection& selection,
                             const Eigen::VectorXd& forces, const TorqueLevers& levers,
                             const MaterialSpec& material, double noise, double floor)
    : noise_(noise) {
  std::map<int, std::vector<Eigen::Index>> rows;  // of each position
  Eigen::Index at = 0;
  for (const int e : selection) {
    const Episode& episode = dataset.episodes[static_cast<std::size_t>(e)];
    for (std::size_t i = 0; i < episode.rows.size(); ++i, at += 3)
      rows[episode.position].push_back(at);
  }
  for (const auto& [position, starts] : rows) {
    const auto p = static_cast<std::size_t>(position);
    const double radius = dataset.setups[static_cast<std::size_t>(dataset.setup_of[p])].tool_radius;
    const double doubt =
        std::hypot(levers.at(p, material).doubt, radius * dataset.floor_at(p, floor));
    Eigen::MatrixXd Z(static_cast<Eigen::Index>(starts.size()), 3);
    for (std::size_t i = 0; i < starts.size(); ++i)
      Z.row(static_cast<Eigen::Index>(i)) = doubt * forces.segment<3>(starts[i]).transpose();
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(Z, Eigen::ComputeThinU);
    const Eigen::VectorXd s = svd.singularValues();
    for (Eigen::Index k = 0; k < 3; ++k) {
      Block block;
      for (const Eigen::Index start : starts) block.rows.push_back(start + k);
      block.Q = svd.matrixU();
      block.shrink = 1 - (1 + (s.array() / noise).square()).sqrt().inverse();
      blocks_.push_back(std::move(block));
    }
  }
}

void TorqueWeights::whiten(Eigen::Ref<Eigen::MatrixXd> columns) const {
  columns /= noise_;
  for (const Block& block : blocks_) {
    const Eigen::MatrixXd part = columns(block.rows, Eigen::all);
    columns(block.rows, Eigen::all) =
        part - block.Q * (block.shrink.asDiagonal() * (block.Q.transpose() * part));
  }
}

TorquePole torque_pole(const Eigen::VectorXd& residual, const Eigen::VectorXd& force,
                       double noise) {
  Eigen::Matrix3d N = Eigen::Matrix3d::Zero();
  Vec3 b = Vec3::Zero();
  const Eigen::Index n = residual.size();
  const auto cross_of = [&](Eigen::Index i) {  // of offset x force by the offset
    const Vec3 f = force.segment<3>(i);
    Eigen::Matrix3d by;
    for (int k = 0; k < 3; ++k) by.col(k) = Vec3::Unit(k).cross(f);
    return by;
  };
  for (Eigen::Index i = 0; i < n; i += 3) {
    const Eigen::Matrix3d by = cross_of(i);
    N += by.transpose() * by;
    b += by.transpose() * residual.segment<3>(i);
  }
  // Forces along one line say nothing of an offset along it.
  const Eigen::CompleteOrthogonalDecomposition<Eigen::Matrix3d> solver = [&] {
    Eigen::CompleteOrthogonalDecomposition<Eigen::Matrix3d> d;
    d.setThreshold(1e-6);
    d.compute(N);
    return d;
  }();
  TorquePole pole;
  pole.offset = solver.solve(b);
  double squares = 0;
  for (Eigen::Index i = 0; i < n; i += 3)
    squares += (residual.segment<3>(i) - cross_of(i) * pole.offset).squaredNorm();
  pole.rms_after = n > 0 ? std::sqrt(squares / static_cast<double>(n)) : 0;
  const Eigen::Matrix3d covariance =
      std::pow(std::max(noise, pole.rms_after), 2) * Eigen::Matrix3d(solver.pseudoInverse());
  pole.std_error = covariance.diagonal().cwiseMax(0).cwiseSqrt();
  return pole;
}

}  // namespace hapsim
