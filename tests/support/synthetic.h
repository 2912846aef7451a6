// A small body and presses on it, for tests of models and fits. Coarse meshes: what measure() takes
// from them is of the model's own making, so those tests judge the fit, not the physics; what names
// effects is tried on measure_finer().
#pragma once

#include <array>
#include <cmath>

#include "base/random.h"
#include "effects/catalogue.h"
#include "experiment/experiment.h"
#include "fit/extend.h"
#include "support/block_mesh.h"

namespace hapsim::test {

// Six positions, each pressed slowly and fast with a hold, and sideways.
inline Recording presses() {
  Recording r;
  r.name = "synthetic";
  r.metadata.set("tool_radius", "0.004");
  int press = 0;
  double session = 0;
  for (int p = 0; p < 6; ++p)
    for (int kind = 0; kind < 3; ++kind, ++press) {
      const Vec3 point(0.02 + 0.02 * (p % 3), 0.03 + 0.02 * (p / 3), 0.04);
      const double rise = kind == 1 ? 0.2 : 1.0, depth = 0.002 + 0.0003 * p;
      for (int i = 0; i <= 40; ++i) {
        const double t = 0.05 * i;
        const double share = std::min(1.0, t / rise);
        r.line.push_back(static_cast<long>(r.line.size()) + 2);
        r.press.push_back(press);
        r.t.push_back(session + t);
        r.position.push_back(point);
        r.u.push_back(share * depth * (kind == 2 ? Vec3(0.6, -0.3, -1) : Vec3(0, 0, -1)));
        r.f.push_back(Vec3::Zero());
      }
      session += 10;
    }
  return r;
}

// The edges under the tool are a share of its radius; the body is a block of `cells` each way.
inline Experiment experiment(double rim_edge = 0.3, std::array<int, 3> cells = {6, 6, 4}) {
  ExperimentOptions options;
  options.rim_edge = rim_edge;
  options.noise = 0.01;
  options.floor = 0.01;
  return make_experiment(block_mesh({0.08, 0.08, 0.04}, cells[0], cells[1], cells[2], 1), presses(),
                         options);
}

// Replaces the measured forces by the model's on the body of `truth`, and noise.
inline void measure(Experiment& w, const Experiment& truth, const Model& model, double noise,
                    std::uint64_t seed) {
  const Selection all = all_episodes(w.dataset);
  const Eigen::VectorXd f = solved_forces(model, truth, all, false).f;
  const std::vector<int> rows = stacked_rows(w.dataset, all);
  Random random(seed);
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (int k = 0; k < 3; ++k)
      w.dataset.recording.f[rows[i]][k] =
          f[3 * static_cast<Eigen::Index>(i) + k] + noise * random.normal();
}

inline void measure(Experiment& w, const Model& model, double noise, std::uint64_t seed) {
  measure(w, w, model, noise, seed);
}

// By meshes with half of the edge under the tool, of a block that is divided otherwise.
inline void measure_finer(Experiment& w, const Model& model, double noise, std::uint64_t seed) {
  static const Experiment truth = experiment(0.15, {9, 9, 5});
  measure(w, truth, model, noise, seed);
}

inline Model elastic(double modulus, double nu) {
  Model model;
  model.parameters = effect_rows(*find_effect("elastic"), 1, {modulus, nu});
  return model;
}

inline Model with(Model model, const std::string& effect, const std::vector<double>& values) {
  for (const Parameter& p : effect_rows(*find_effect(effect), 1, values))
    model.parameters.push_back(p);
  return model;
}

}  // namespace hapsim::test
