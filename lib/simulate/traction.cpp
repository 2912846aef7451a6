#include "simulate/traction.h"

#include <Eigen/LU>
#include <algorithm>
#include <limits>

#include "base/error.h"
#include "material/maxwell_memory.h"

namespace hapsim {
namespace {

[[noreturn]] void refuse_traction(const Model& model, const std::string& effect) {
  fail_input(model.name, "forces are given to the linear body itself, without " + effect,
             "take it out of the model, or add --full where elements have it");
}

// Maxwell elements of the whole body, as shares of its stiffness.
std::vector<MaxwellTerm> common_terms(const Model& model, const MaterialSpec& material) {
  std::vector<MaxwellTerm> terms;
  for (const EffectInstance& i : effect_instances(model, false)) {
    const Stage stage = i.effect->card().stage;
    if (stage != Stage::kBody && stage != Stage::kSupport)
      refuse_traction(model, i.effect->card().name);
    FullSpec elements;
    if (i.effect->full(i.values, material.modulus[0], elements) && elements.finite)
      refuse_traction(model, i.effect->card().name);
    i.effect->relaxation(i.values, material.modulus[0], terms);
  }
  return terms;
}

// One press: the elements remember what moved them.
void move_episode(const Recording& recording, const Episode& episode, const PositionStiffness& s,
                  const std::vector<MaxwellTerm>& terms, std::vector<Vec3>& motion) {
  std::vector<MaxwellStiffness> elements = s.relaxing;
  if (elements.empty() && !episode.view.t.empty())
    for (const MaxwellTerm& term : terms) elements.push_back({term.share * s.K, term.tau});
  std::vector<Vec3> h(elements.size(), Vec3::Zero());
  Vec3 before = Vec3::Zero();
  for (std::size_t i = 0; i < episode.rows.size(); ++i) {
    const auto row = static_cast<std::size_t>(episode.rows[i]);
    const double dt =
        i == 0 || episode.view.t.empty() ? 0 : episode.view.t[i] - episode.view.t[i - 1];
    Eigen::Matrix3d K = s.K;
    Vec3 load = -recording.f[row];
    for (std::size_t j = 0; j < elements.size(); ++j) {
      const MemoryStep step = memory_step(dt, elements[j].tau);
      K += step.c * elements[j].K;
      load -= elements[j].K * (step.a * h[j] - step.c * before);
    }
    const Vec3 u = episode.view.in_air[i] ? Vec3(Vec3::Zero()) : Vec3(K.inverse() * load);
    for (std::size_t j = 0; j < elements.size(); ++j) {
      const MemoryStep step = memory_step(dt, elements[j].tau);
      h[j] = step.a * h[j] + step.c * (u - before);
    }
    motion[row] = before = u;
  }
}

}  // namespace

std::vector<Vec3> displacements_of_forces(const Model& model, const Dataset& dataset,
                                          const StiffnessAt& stiffness_at) {
  const std::vector<MaxwellTerm> terms = common_terms(model, material_of(model));
  std::vector<Vec3> motion(dataset.rows(), Vec3::Zero());
  for (const Episode& episode : dataset.episodes)
    move_episode(dataset.recording, episode,
                 stiffness_at(static_cast<std::size_t>(episode.position)), terms, motion);
  return motion;
}

Recording with_displacements(const Model& model, const Dataset& dataset,
                             const StiffnessAt& stiffness_at) {
  Recording out = dataset.recording;
  out.metadata.remove("mesh_uncertainty");  // of the forces that were given
  out.u = displacements_of_forces(model, dataset, stiffness_at);
  // An effect of the body that is not linear, whatever it is, shows in the forces of this motion.
  Dataset moved = dataset;
  moved.recording.u = out.u;
  for (Episode& episode : moved.episodes)
    for (std::size_t i = 0; i < episode.rows.size(); ++i)
      episode.view.u[i] = out.u[static_cast<std::size_t>(episode.rows[i])];
  const Selection all = all_episodes(moved);
  const Eigen::VectorXd f = model_forces(model, moved, stiffness_at, all, false).f;
  const std::vector<int> rows = stacked_rows(moved, all);
  double largest = 0, off = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto row = static_cast<std::size_t>(rows[i]);
    if (out.in_air(row)) continue;
    largest = std::max(largest, out.f[row].norm());
    off = std::max(off, (f.segment<3>(3 * static_cast<Eigen::Index>(i)) - out.f[row]).norm());
  }
  if (off > 1e-6 * largest) {
    std::string names;
    for (const EffectInstance& i : effect_instances(model, false))
      names += (names.empty() ? "" : ", ") + i.effect->card().name;
    fail_input(
        model.name,
        "forces are given to the linear body itself, and one of its effects is not linear (" +
            names + ")",
        "take it out of the model, or add --full where elements have it");
  }
  return out;
}

}  // namespace hapsim
