// Trials of the diagnosis: effects x sizes x seeds. The forces come from another body (the exact
// shape, finer meshes) than the one that is diagnosed (made from the scan), with a random relative
// error of each position's stiffness on top. See run.sh.
//   bench_diagnosis DIAGNOSED.ply TRUE.ply MOTION.csv RESULTS.csv SEEDS LEVELS [TRUTH...]
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <ctime>
#include <set>
#include <sstream>

#include "base/error.h"
#include "diagnose/diagnose.h"
#include "geometry/tetmesh.h"
#include "summary.h"
#include "truths.h"

namespace hapsim::bench {
namespace {

constexpr double kNoise = 0.01;           // [N] per component
constexpr double kStiffnessError = 0.01;  // relative, of each position and direction
constexpr double kTrueRim = 0.08;         // finer than what is diagnosed

Recording motion(const std::string& path, bool open) {
  Input input(path);
  Recording r = read_recording(input, false);
  r.f.assign(r.rows(), Vec3::Zero());
  if (open) r.contact.clear();
  // Each press at its own temperature, in no order; the thermometer has noise.
  Random random(5);
  r.temp.resize(r.rows());
  for (const Press& press : r.presses()) {
    const double t = 20 + 10 * random.uniform();
    for (const int row : press.rows) r.temp[row] = t + 0.05 * random.normal();
  }
  return r;
}

TetMesh body(const std::string& path) {
  Input input(path);
  return read_body(input);
}

struct Pair {
  Workspace truth, diagnosed;
};

Pair make_pair(const std::string& diagnosed, const std::string& truth, const std::string& path,
               bool open) {
  WorkspaceOptions options;
  options.noise = kNoise;
  options.cache = default_cache_directory();
  WorkspaceOptions finer = options;
  finer.rim_edge = kTrueRim;
  finer.nu_low = finer.nu_high = true_base({}).find("elastic", 0, "nu")->value;
  return {make_workspace(body(truth), motion(path, open), finer),
          make_workspace(body(diagnosed), motion(path, open), options)};
}

// Forces of the truth, each position's with a symmetric relative error, and noise.
Eigen::VectorXd measured(const Truth& truth, const Workspace& w, double strength, int seed) {
  Random draw(1000 + static_cast<std::uint64_t>(seed));
  Eigen::VectorXd f = truth.forces(w, true_base(truth.base), strength, draw);
  Random random(static_cast<std::uint64_t>(seed));
  std::vector<Eigen::Matrix3d> error;
  for (std::size_t p = 0; p < w.dataset.positions.size(); ++p) {
    Eigen::Matrix3d S;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j <= i; ++j)
        S(i, j) = S(j, i) = kStiffnessError * (i == j ? 1 : std::sqrt(0.5)) * random.normal();
    error.push_back(Eigen::Matrix3d::Identity() + S);
  }
  Eigen::Index at = 0;
  for (const Episode& e : w.dataset.episodes)
    for (std::size_t i = 0; i < e.rows.size(); ++i, at += 3) {
      f.segment<3>(at) = (error[e.position] * f.segment<3>(at)).eval();
      for (int k = 0; k < 3; ++k) f[at + k] += kNoise * random.normal();
    }
  return f;
}

Trial run(const Truth& truth, Pair& pair, double level, int seed) {
  Trial trial{truth.name, truth.effect, level, seed, "", "", "", 0};
  const std::uint64_t draw = 1000 + static_cast<std::uint64_t>(seed);
  const bool sized = !truth.effect.empty() && truth.effect != "slack";
  const double strength = sized ? strength_for(truth, pair.truth, level * kNoise, draw) : 1;
  if (strength < 0) {
    trial.verdict = "too small";
    return trial;
  }
  Workspace& w = pair.diagnosed;
  const Eigen::VectorXd f = measured(truth, pair.truth, strength, seed);
  const Selection all = all_episodes(w.dataset);
  const std::vector<int> rows = stacked_rows(w.dataset, all);
  for (std::size_t i = 0; i < rows.size(); ++i)
    w.dataset.recording.f[rows[i]] = f.segment<3>(3 * static_cast<Eigen::Index>(i));
  const FitOptions fit_options{w.noise.value, w.floor, true};
  std::vector<Model> starts{elastic_model(w.dataset, all, *w.body)};
  for (const std::string& effect : truth.base) {
    const Model fitted = fit_best(starts, w.dataset, all, *w.body, fit_options).model;
    starts = with_effect(fitted, effect, w.dataset, all, *w.body, {});
  }
  const Model model = fit_best(starts, w.dataset, all, *w.body, fit_options).model;
  const std::clock_t begin = std::clock();  // of the processor: other programs do not count
  const Diagnosis d = diagnose(model, w, {});
  trial.seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  trial.verdict = verdict_name(d.verdict);
  if (std::getenv("VERBOSE") != nullptr)
    for (const Finding& finding : d.findings)
      fmt::print(stderr, "{} {:g} {}: {} {}, gain {:.1f}, p {:.3f}, unseen {:.4g} -> {:.4g}; {}\n",
                 truth.name, level, seed, finding.effect, verdict_name(finding.verdict),
                 finding.criterion_gain, finding.p_value, finding.held_out_now,
                 finding.held_out_after, finding.evidence);
  for (const Finding& finding : d.findings) {
    std::string* list = finding.verdict == Verdict::kMissing             ? &trial.missing
                        : finding.verdict == Verdict::kIndistinguishable ? &trial.rivals
                                                                         : nullptr;
    if (list != nullptr) *list += (list->empty() ? "" : " ") + finding.effect;
  }
  return trial;
}

int run_all(const std::vector<std::string>& a) {
  const std::string results = a[3];
  const int seeds = std::stoi(a[4]);
  std::vector<double> levels;
  std::istringstream text(a[5]);
  for (std::string level; std::getline(text, level, ',');) levels.push_back(std::stod(level));
  const std::set<std::string> chosen(a.begin() + 6, a.end());
  Pair closed = make_pair(a[0], a[1], a[2], false), open = make_pair(a[0], a[1], a[2], true);
  std::vector<Trial> trials = read_trials(results);
  std::set<std::string> known;
  const auto key = [](const std::string& truth, double level, int seed) {
    return fmt::format("{} {:g} {}", truth, level, seed);
  };
  for (const Trial& t : trials) known.insert(key(t.truth, t.level, t.seed));
  for (int seed = 1; seed <= seeds; ++seed)
    for (const Truth& truth : all_truths())
      for (const double level : levels) {
        if (!chosen.empty() && chosen.count(truth.name) == 0) continue;
        if (truth.effect.empty() && level != levels.front()) continue;
        if (truth.effect == "slack" && level != levels.front()) continue;
        if (known.count(key(truth.name, level, seed)) > 0) continue;
        trials.push_back(run(truth, truth.open ? open : closed, level, seed));
        append_trial(results, trials.back());
      }
  std::erase_if(trials, [](const Trial& t) { return t.verdict == "too small"; });
  print_summary(trials);
  return 0;
}

}  // namespace
}  // namespace hapsim::bench

int main(int argc, char** argv) {
  if (argc < 7) {
    fmt::print(stderr,
               "bench_diagnosis DIAGNOSED.ply TRUE.ply MOTION.csv RESULTS.csv SEEDS LEVELS "
               "[TRUTH...]\n");
    return 2;
  }
  try {
    return hapsim::bench::run_all({argv + 1, argv + argc});
  } catch (const hapsim::Error& error) {
    fmt::print(stderr, "bench_diagnosis: {}\n", error.what());
    return 3;
  }
}
