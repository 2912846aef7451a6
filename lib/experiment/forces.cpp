#include "experiment/forces.h"

#include <algorithm>
#include <numeric>

#include "base/parallel.h"
#include "effects/catalogue.h"
#include "experiment/labels.h"
#include "experiment/nearest_region.h"
#include "material/maxwell_memory.h"
#include "model/relaxation_steps.h"

namespace hapsim {
namespace {

// What contact laws need to know of the body at one position.
ContactStiffness contact_of(const PositionStiffness& s, const MaterialSpec& material,
                            const Vec3& position, int label, bool derivatives) {
  LocalModulus modulus{0, {{is_by_label(material) ? label : region_at(material, position), 1.0}}};
  if (material.local) modulus = local_modulus(material, position);
  const auto at = [&](int region) { return material.modulus[static_cast<std::size_t>(region)]; };
  ContactStiffness contact;
  contact.K = s.K;
  contact.modulus = material.local ? modulus.value : at(modulus.share.front().first);
  contact.nu = material.nu;
  if (!derivatives) return contact;
  for (const auto& [region, share] : modulus.share)
    if (const int column = material.modulus_column[static_cast<std::size_t>(region)]; column >= 0)
      contact.log_modulus_by_column.emplace_back(column, share / at(region));
  contact.nu_column = material.nu_column;
  contact.by_column = s.by_column;
  return contact;
}

void release_in_air(const PressView& view, Signal& signal) {
  for (std::size_t i = 0; i < view.size(); ++i) {
    if (!view.in_air[i]) continue;
    const Eigen::Index row = 3 * static_cast<Eigen::Index>(i);
    signal.f.segment<3>(row).setZero();
    if (signal.df.cols() > 0) signal.df.middleRows(row, 3).setZero();
  }
}

// What Maxwell elements beside the relaxed stiffness add, exact for straight motion.
void add_memory(const PressView& view, const std::vector<MaxwellStiffness>& relaxing,
                Signal& signal) {
  const auto u = [&](std::size_t i) { return view.in_air[i] ? Vec3(Vec3::Zero()) : view.u[i]; };
  for (const MaxwellStiffness& element : relaxing) {
    Vec3 h = Vec3::Zero();
    for (std::size_t i = 0; i < view.size(); ++i) {
      const double dt = i == 0 || view.t.empty() ? 0 : view.t[i] - view.t[i - 1];
      const MemoryStep s = memory_step(dt, element.tau);
      h = s.a * h + s.c * (u(i) - (i == 0 ? Vec3(Vec3::Zero()) : u(i - 1)));
      signal.f.segment<3>(3 * static_cast<Eigen::Index>(i)) -= element.K * h;
    }
  }
}

// A press as the body sees it: its motion has passed all effects that change it.
PressView press_on_body(const std::vector<EffectInstance>& effects, const MaterialSpec& material,
                        const PositionStiffness& s, const Episode& episode, const Dataset& dataset,
                        Eigen::Index columns, bool derivatives) {
  const auto position = static_cast<std::size_t>(episode.position);
  const int label = dataset.label.empty() ? 0 : dataset.label[position];
  PressView view = episode.view;
  view.modulus = material.modulus[0];
  view.modulus_column = derivatives ? material.modulus_column[0] : -1;
  view.contact = contact_of(s, material, dataset.positions[position], label, derivatives);
  Motion motion{view.u, {}, columns};
  for (const EffectInstance& i : effects) i.effect->move(view, i.values, motion);
  view.u = std::move(motion.u);
  view.du = std::move(motion.du);
  return view;
}

// One episode through all effects: from the tool's motion to the sensor's reading.
Signal episode_forces(const std::vector<EffectInstance>& effects, const MaterialSpec& material,
                      const PositionStiffness& s, const Episode& episode, const Dataset& dataset,
                      Eigen::Index columns, bool derivatives) {
  const PressView view =
      press_on_body(effects, material, s, episode, dataset, columns, derivatives);
  const Eigen::Index n = 3 * static_cast<Eigen::Index>(view.size());
  Signal signal{Eigen::VectorXd::Zero(n), Eigen::MatrixXd::Zero(n, columns)};
  for (std::size_t i = 0; i < view.size(); ++i) {
    if (view.in_air[i]) continue;
    const Eigen::Index row = 3 * static_cast<Eigen::Index>(i);
    signal.f.segment<3>(row) = -s.K * view.u[i];
    if (columns == 0) continue;
    if (view.du.cols() > 0)
      signal.df.middleRows(row, 3).noalias() = -s.K * view.du.middleRows(row, 3);
    for (const auto& [column, dK] : s.by_column)
      signal.df.block<3, 1>(row, column) -= dK * view.u[i];
  }
  add_memory(view, s.relaxing, signal);
  // In the air the body exerts nothing, whatever it remembers; the sensor still has its errors.
  bool at_sensor = false;
  for (const EffectInstance& i : effects) {
    if (!at_sensor && i.effect->card().stage == Stage::kSensor) {
      at_sensor = true;
      release_in_air(view, signal);
    }
    i.effect->apply(view, i.values, signal);
  }
  if (!at_sensor) release_in_air(view, signal);
  return signal;
}

}  // namespace

std::vector<EffectInstance> effect_instances(const Model& model, bool derivatives) {
  const std::vector<int> free = model.free_parameters();
  std::vector<int> column(model.parameters.size(), -1);
  for (std::size_t c = 0; derivatives && c < free.size(); ++c)
    column[free[c]] = static_cast<int>(c);
  std::vector<EffectInstance> result;
  for (const Effect* effect : catalogue()) {
    EffectInstance instance{effect, {}};
    for (std::size_t i = 0; i < model.parameters.size(); ++i) {
      const Parameter& p = model.parameters[i];
      if (p.effect == effect->card().name)
        instance.values.push_back({p.region, p.name, p.value, column[i]});
    }
    if (!instance.values.empty()) result.push_back(std::move(instance));
  }
  return result;
}

bool relaxes(const EffectInstance& instance) {
  std::vector<MaxwellTerm> terms;
  return instance.effect->relaxation(instance.values, 1, terms) && !terms.empty();
}

MaterialSpec material_of(const Model& model) {
  MaterialSpec material;
  for (const EffectInstance& i : effect_instances(model, true))
    i.effect->describe(i.values, material);
  return material;
}

std::string implausible(const Model& model, const Effect& effect, const Dataset& dataset) {
  for (const EffectInstance& i : effect_instances(model, false))
    if (i.effect == &effect) return effect.implausible(i.values, dataset.positions);
  return "";
}

Selection all_episodes(const Dataset& dataset) {
  Selection selection(dataset.episodes.size());
  std::iota(selection.begin(), selection.end(), 0);
  return selection;
}

std::vector<int> stacked_rows(const Dataset& dataset, const Selection& selection) {
  std::vector<int> rows;
  for (const int e : selection)
    rows.insert(rows.end(), dataset.episodes[e].rows.begin(), dataset.episodes[e].rows.end());
  return rows;
}

Signal model_forces(const Model& model, const Experiment& experiment, const Linearisation& about,
                    const Selection& selection, bool derivatives) {
  const MaterialSpec material = material_of(model);
  return model_forces(
      model, experiment.dataset, [&](std::size_t p) { return about.at(p, material); }, selection,
      derivatives, experiment.places.threads());
}

Signal solved_forces(const Model& model, const Experiment& experiment, const Selection& selection,
                     bool derivatives) {
  return model_forces(model, experiment, experiment.places.solve(material_of(model)), selection,
                      derivatives);
}

Signal model_forces(const Model& model, const Dataset& dataset, const StiffnessAt& stiffness_at,
                    const Selection& selection, bool derivatives, int threads, Eigen::Index more) {
  std::vector<EffectInstance> effects = effect_instances(model, derivatives);
  const MaterialSpec material = material_of(model);
  const Eigen::Index columns =
      derivatives ? static_cast<Eigen::Index>(model.free_parameters().size()) + more : 0;
  Eigen::Index total = 0;
  std::vector<Eigen::Index> begin;  // of each episode in the stacked vectors
  std::vector<PositionStiffness> stiffness(dataset.positions.size());
  std::vector<char> known(dataset.positions.size(), 0);
  for (const int e : selection) {
    const Episode& episode = dataset.episodes[e];
    begin.push_back(total);
    total += 3 * static_cast<Eigen::Index>(episode.rows.size());
    if (known[episode.position]) continue;
    stiffness[episode.position] = stiffness_at(episode.position);
    known[episode.position] = 1;
  }
  const bool apart = std::any_of(stiffness.begin(), stiffness.end(),
                                 [](const auto& s) { return !s.relaxing.empty(); });
  // The elements stand for all that relaxes.
  if (apart)
    std::erase_if(effects, relaxes);
  else
    refuse_regional_relaxation(model);
  Signal all{Eigen::VectorXd(total), Eigen::MatrixXd(total, columns)};
  const auto one = [&](std::size_t k) {
    const Episode& episode = dataset.episodes[selection[k]];
    const Signal signal = episode_forces(effects, material, stiffness[episode.position], episode,
                                         dataset, columns, derivatives);
    all.f.segment(begin[k], signal.f.size()) = signal.f;
    if (columns > 0) all.df.middleRows(begin[k], signal.f.size()) = signal.df;
  };
  // Threads cost more than they save where there is little to do.
  constexpr Eigen::Index kWorthThreads = 3 * 2000;
  in_parallel(selection.size(), total < kWorthThreads ? 1 : threads, one);
  return all;
}

std::vector<Vec3> motion_on_body(const Model& model, const Experiment& experiment,
                                 const Linearisation& about, const Selection& selection) {
  const std::vector<EffectInstance> effects = effect_instances(model, false);
  const MaterialSpec material = material_of(model);
  std::vector<Vec3> motion;
  for (const int e : selection) {
    const Episode& episode = experiment.dataset.episodes[e];
    const auto p = static_cast<std::size_t>(episode.position);
    const PressView view = press_on_body(effects, material, about.at(p, material), episode,
                                         experiment.dataset, 0, false);
    motion.insert(motion.end(), view.u.begin(), view.u.end());
  }
  return motion;
}

Eigen::VectorXd measured_forces(const Dataset& dataset, const Selection& selection) {
  const std::vector<int> rows = stacked_rows(dataset, selection);
  Eigen::VectorXd f(3 * static_cast<Eigen::Index>(rows.size()));
  for (std::size_t i = 0; i < rows.size(); ++i)
    f.segment<3>(3 * static_cast<Eigen::Index>(i)) = dataset.recording.f[rows[i]];
  return f;
}

ForceError force_error(const Dataset& dataset, const Eigen::VectorXd& residual) {
  const auto count = static_cast<double>(residual.size());
  return {residual.size() == 0 ? 0 : std::sqrt(residual.squaredNorm() / count), dataset.axes()};
}

}  // namespace hapsim
