// Trials of the diagnosis: effects x sizes x seeds. The forces come from another body (the exact
// shape, finer meshes) than the one that is diagnosed (made from the scan), with a random relative
// error of each position's stiffness on top. See run.sh.
//   bench_diagnosis DIAGNOSED.ply TRUE.ply MOTION.csv RESULTS.csv FROM:TO LOW:HIGH [TRUTH...]
// Seeds FROM to TO, each with a level drawn between LOW and HIGH (or the largest that the effect
// can do): the error, over the noise, that what is hidden leaves of the model that is diagnosed. A
// truth `nothing*` means all that begin so. --leave-out: each truth's effect is taken from the
// catalogue (one hidden effect on the plain body, all presses): what is said of what no effect is?
// --at-shown: as large as a diagnosis of the body without it says that it would show from.
// Recorded in bench/results/diagnosis*.txt (bench/record.sh).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <set>

#include "base/error.h"
#include "diagnose/candidate.h"
#include "diagnose/diagnose.h"
#include "diagnose/held_out.h"
#include "diagnose/wording.h"
#include "left_out.h"
#include "made_recordings.h"
#include "shown.h"
#include "statements.h"
#include "summary.h"
#include "truths.h"

namespace hapsim::bench {
namespace {

struct Drawn {
  Eigen::VectorXd forces;  // empty: too small
  Model model;             // no parameters when the truth is none of the catalogue's
};

// From `low` to `high` times the noise, or to the largest that the truth can do, by seed.
struct Levels {
  double low = 3, high = 10;
  double of(const Truth& truth, const Experiment& w, int seed) const {
    Random random(500 + static_cast<std::uint64_t>(seed));
    const double most =
        largest_misfit(truth, w, 1000 + static_cast<std::uint64_t>(seed)) / kNoise / 1.01;
    return low * std::pow(std::min(high, most) / low, random.uniform());
  }
};

std::uint64_t own_seed(int seed) {
  return 1000 + static_cast<std::uint64_t>(seed);
}

Drawn draw_at(double strength, const Truth& truth, const Model& base, const Experiment& w,
              int seed) {
  if (strength < 0) return {};
  Drawn drawn;
  Random random(own_seed(seed));
  drawn.forces = truth.forces(w, base, strength, random);
  if (truth.model && strength > 0) drawn.model = truth.model(base, strength);
  return drawn;
}

Drawn draw(const Truth& truth, const std::vector<Truth>& all, const Experiment& w,
           const Levels& levels, int seed) {
  const std::uint64_t own = own_seed(seed);
  Drawn drawn;
  const Model base = true_base(truth.base);
  if (!truth.parts.empty()) {
    drawn.model = base;
    for (std::size_t k = 0; k < truth.parts.size(); ++k) {
      const Truth& part = find_truth(all, truth.parts[k]);
      const double level = truth.levels.empty() ? levels.of(part, w, seed) : truth.levels[k];
      const double strength =
          part.sizes > 0 ? 1 + (seed - 1) % part.sizes : strength_for(part, w, level * kNoise, own);
      if (strength < 0) return {};
      drawn.model = part.model(drawn.model, strength);
    }
    drawn.forces = forces_of(w, drawn.model);
    return drawn;
  }
  double strength = truth.effects.empty() ? 0 : 1 + (seed - 1) % std::max(truth.sizes, 1);
  if (!truth.effects.empty() && truth.sizes == 0)
    strength = strength_for(truth, w, levels.of(truth, w, seed) * kNoise, own);
  return draw_at(strength, truth, base, w, seed);
}

std::string joined(const std::vector<std::string>& names) {
  return fmt::format("{}", fmt::join(names, " "));
}

struct Options {
  bool verbose = false;
  std::string statements;  // files
  std::string sizes;
  std::string keep;        // folder for the recordings; "": not kept
  bool leave_out = false;  // the truth's effect is taken from the catalogue
  bool at_shown = false;   // sizes are those from which it would show
};

// What is diagnosed: the base, fitted.
Model fitted_base(const Truth& truth, const Experiment& w) {
  const Selection everything = all_episodes(w.dataset);
  const FitOptions options{w.noise.value, w.floor, true};
  std::vector<Model> starts{elastic_model(w, everything)};
  for (const std::string& effect : truth.base)
    starts = with_effect(fit_best(starts, w, everything, options), effect, w, everything, {});
  return fit_best(starts, w, everything, options).model;
}

// As large as it would show from, by a diagnosis of the body without it and other noise.
Drawn draw_at_shown(const Truth& truth, const Pair& pair, int seed) {
  constexpr int kOtherNoise = 10000;
  const Model base = true_base(truth.base);
  Eigen::VectorXd forces = forces_of(pair.truth, base);
  measure(truth, pair.truth, seed + kOtherNoise, forces);
  const Experiment w = with_forces(pair.diagnosed, forces);
  const Diagnosis d = diagnose(fitted_base(truth, w), w, w.allowance(), {});
  return draw_at(strength_that_shows(truth, base, d), truth, base, pair.truth, seed);
}

Trial run(const Truth& truth, const std::vector<Truth>& all, Pairs& pairs, const Levels& levels,
          int seed, const Options& options) {
  const Pair& pair = pairs.of(truth);
  Trial trial;
  trial.truth = truth.name;
  trial.effects = joined(truth.effects);
  trial.seed = seed;
  Drawn drawn = options.at_shown ? draw_at_shown(truth, pair, seed)
                                 : draw(truth, all, pair.truth, levels, seed);
  if (drawn.forces.size() == 0) {
    trial.verdict = "too small";
    return trial;
  }
  trial.level = misfit_of(drawn.forces, truth, pair.truth) / kNoise;
  if (!options.at_shown && !truth.effects.empty() && trial.level < 0.9 * levels.low) {
    trial.verdict = "too small";
    return trial;
  }
  measure(truth, pair.truth, seed, drawn.forces);
  const Experiment w = with_forces(pair.diagnosed, drawn.forces);
  if (!options.keep.empty()) {
    Output output(fmt::format("{}/{}-{}.csv", options.keep, truth.name, seed));
    write_recording(output.stream(), w.dataset.recording);
    output.commit();
  }
  const Model model = fitted_base(truth, w);
  const std::clock_t begin = std::clock();  // of the processor: other programs do not count
  DiagnoseOptions how;
  if (options.leave_out) how.unknown = truth.effects.front();
  const Diagnosis d = diagnose(model, w, w.allowance(), how);
  trial.seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  trial.verdict = verdict_name(d.verdict);
  append_statements(options.statements, truth, trial, d);
  for (const Finding& finding : d.findings) {
    if (options.verbose)
      fmt::print(stderr,
                 "{} {:.2g} {}: {} {}, gain {:.1f}, p {:.3f}, unseen {:.4g} -> {:.4g}; {}\n",
                 truth.name, trial.level, seed, finding.effect, verdict_name(finding.verdict),
                 finding.criterion_gain, finding.p_value, finding.held_out_now.told(),
                 finding.held_out_after.told(), evidence_words(finding));
    std::string* list = finding.verdict == Verdict::kMissing             ? &trial.missing
                        : finding.verdict == Verdict::kIndistinguishable ? &trial.rivals
                                                                         : nullptr;
    if (list != nullptr) *list += (list->empty() ? "" : " ") + finding.effect;
  }
  trial.left = d.left.kind;
  const double floor = std::hypot(d.noise, d.floor * d.force_rms.told());
  trial.now = d.held_out.told() / floor;
  trial.after = d.held_out_end.told() / floor;
  trial.own_form = truth.model != nullptr;
  if (trial.rivals.empty() && !trial.missing.empty())
    trial.presses = held_out_of(as_it_is(d.rivals.front(), w), {w, {d.noise, d.floor}},
                                make_press_folds(w.dataset, 6), Map::kAnew)
                        .error.told() /
                    floor;
  if (trial.rivals.empty() && !d.rivals.empty())
    count_sizes(d.rivals.front(), truth.effects.empty() ? true_base(truth.base) : drawn.model,
                pair.truth, options.sizes, trial);
  return trial;
}

std::pair<double, double> range(const std::string& text) {
  const std::size_t colon = text.find(':');
  return {std::stod(text.substr(0, colon)), std::stod(text.substr(colon + 1))};
}

bool chosen(const Truth& truth, const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    if (name == truth.name) return true;
    if (name.back() == '*' && truth.name.rfind(name.substr(0, name.size() - 1), 0) == 0)
      return true;
  }
  return names.empty();
}

int run_all(std::vector<std::string> a) {
  Options options;
  options.verbose = std::erase(a, "--verbose") > 0;
  options.leave_out = std::erase(a, "--leave-out") > 0;
  options.at_shown = std::erase(a, "--at-shown") > 0;
  if (const auto flag = std::find(a.begin(), a.end(), "--keep");
      flag != a.end() && flag + 1 != a.end()) {
    options.keep = *(flag + 1);
    a.erase(flag, flag + 2);
  }
  const std::string results = a[3];
  const auto beside = [&](const char* name) {
    return std::filesystem::path(results).replace_filename(name).string();
  };
  options.statements = beside("statements.csv");
  options.sizes = beside("sizes.csv");
  const auto [from, to] = range(a[4]);
  const auto [low, high] = range(a[5]);
  const std::vector<std::string> names(a.begin() + 6, a.end());
  Pairs pairs(a[0], a[1], a[2]);
  const std::vector<Truth> truths = all_truths();
  std::vector<Trial> trials = read_trials(results);
  std::set<std::pair<std::string, int>> known;
  for (const Trial& t : trials) known.insert({t.truth, t.seed});
  for (int seed = static_cast<int>(from); seed <= static_cast<int>(to); ++seed)
    for (const Truth& truth : truths) {
      if (!chosen(truth, names) || known.count({truth.name, seed}) > 0) continue;
      if (options.leave_out && !can_be_left_out(truth)) continue;
      trials.push_back(run(truth, truths, pairs, {low, high}, seed, options));
      append_trial(results, trials.back());
    }
  std::erase_if(trials, [](const Trial& t) { return t.verdict == "too small"; });
  options.leave_out  ? print_left_out(trials)
  : options.at_shown ? print_shown(trials)
                     : print_summary(trials);
  return 0;
}

}  // namespace
}  // namespace hapsim::bench

int main(int argc, char** argv) {
  if (argc < 7) {
    fmt::print(stderr,
               "bench_diagnosis DIAGNOSED.ply TRUE.ply MOTION.csv RESULTS.csv FROM:TO LOW:HIGH "
               "[TRUTH...] [--verbose] [--keep FOLDER]\n");
    return 2;
  }
  try {
    return hapsim::bench::run_all({argv + 1, argv + argc});
  } catch (const hapsim::Error& error) {
    fmt::print(stderr, "bench_diagnosis: {}\n", error.what());
    return 3;
  }
}
