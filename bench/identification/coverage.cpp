// bench_coverage EFFECT[-own] DRAWS [A B]...: how often intervals of a size and its ratio hold the
// true ones. EFFECT: layer (thickness [mm], ratio; of six places 20 mm apart) or inclusion (radius
// [mm], ratio; of nine, 10 mm apart, above it). What is fitted comes from meshes with half of the
// edges, of a block that is divided otherwise, with 5 mN of noise; meshes may err by 1 % a place,
// as hs-identify takes it. With -own the meshes are the model's own and do not err: the noise
// alone. A line a case: draws that converged; of these, held by value +- 1.96 standard errors of
// the curvature, by the intervals that are told, and how wide these are (median factor from value
// to end); seconds of a fit with and without them, by the clock. COVERAGE_DRAWS=1: a line a draw
// too.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "fit/fit.h"
#include "model/interval.h"
#include "support/synthetic.h"

namespace {

using namespace hapsim;

// Nine places above the inclusion, each pressed straight and sideways.
Recording presses_above() {
  Recording r = test::presses();
  for (std::size_t i = 0; i < r.rows(); ++i) {
    const int place = r.press[i] / 3;
    r.position[i] = Vec3(0.03 + 0.01 * (place % 3), 0.03 + 0.01 * (place / 3), 0.04);
  }
  Recording more = r;  // the third row of places
  for (std::size_t i = 0; i < more.rows(); ++i) {
    const int place = more.press[i] / 3;
    if (place >= 3) continue;
    r.line.push_back(static_cast<long>(r.line.size()) + 2);
    r.press.push_back(18 + more.press[i]);
    r.t.push_back(more.t[i] + 180);
    r.position.push_back(more.position[i] + Vec3(0, 0.02, 0));
    r.u.push_back(more.u[i]);
    r.f.push_back(Vec3::Zero());
  }
  return r;
}

Experiment experiment_of(const Recording& recording, double rim_edge, std::array<int, 3> cells) {
  ExperimentOptions options;
  options.rim_edge = rim_edge;
  options.noise = 0.005;
  return make_experiment(test::block_mesh({0.08, 0.08, 0.04}, cells[0], cells[1], cells[2], 1),
                         recording, options);
}

double median(std::vector<double> v) {
  if (v.empty()) return std::nan("");
  std::nth_element(v.begin(), v.begin() + static_cast<long>(v.size() / 2), v.end());
  return v[v.size() / 2];
}

void run(const char* effect, const Model& truth, const char* const names[2], int draws,
         Experiment& w, const Experiment& finer) {
  int converged = 0, before[2] = {0, 0}, after[2] = {0, 0}, unstated[2] = {0, 0};
  std::vector<double> factor[2], plain_time, time;
  const Selection all = all_episodes(w.dataset);
  const auto now = [] { return std::chrono::steady_clock::now(); };
  for (int draw = 1; draw <= draws; ++draw) {
    test::measure(w, finer, truth, 0.005, static_cast<std::uint64_t>(draw));
    FitOptions options{0.005, w.floor, true};
    const Fit plain = fit(test::elastic(2e4, 0.4), w, all, options);
    const auto begin = now();
    const Fit found =
        fit_best(with_effect(plain, effect, w, all, {}), w, all, options, plain.about);
    const auto middle = now();
    if (!found.converged) {
      std::printf("# draw %d: %s\n", draw, found.message.c_str());
      continue;
    }
    options.ridges = true;
    const Fit walked = fit(found.model, w, all, options, found.about);
    const auto end = now();
    if (!walked.converged) {
      std::printf("# draw %d, with ridges: %s\n", draw, walked.message.c_str());
      continue;
    }
    ++converged;
    plain_time.push_back(std::chrono::duration<double>(middle - begin).count());
    time.push_back(std::chrono::duration<double>(end - middle).count());
    for (int k = 0; k < 2; ++k) {
      const double right = truth.find(effect, 0, names[k])->value;
      const Parameter& a = *found.model.find(effect, 0, names[k]);
      const Parameter& b = *walked.model.find(effect, 0, names[k]);
      before[k] += !(std::abs(a.value - right) > 1.96 * a.std_error);
      const ParameterInterval interval = interval95(b);
      after[k] += !(right < interval.lower || right > interval.upper);
      unstated[k] += !std::isfinite(b.std_error);
      if (std::isfinite(b.std_error)) factor[k].push_back(interval.upper / b.value);
      if (std::getenv("COVERAGE_DRAWS") != nullptr)
        std::printf("# draw %d: %s %.4g, then %.4g, +- %.2g, then %.4g to %.4g\n", draw, names[k],
                    a.value, b.value, a.std_error, interval.lower, interval.upper);
    }
  }
  std::printf("%-10s %5.1f mm  ratio %5.2f  %2d draws", effect,
              1e3 * truth.find(effect, 0, names[0])->value, truth.find(effect, 0, "ratio")->value,
              converged);
  for (int k = 0; k < 2; ++k)
    std::printf("  %s %2d, then %2d (%d not stated), factor %.3g", names[k], before[k], after[k],
                unstated[k], median(factor[k]));
  std::printf("  %.1f s, then %.1f s\n", median(plain_time), median(time));
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  std::string effect = argc > 2 ? argv[1] : "";
  const bool own = effect.ends_with("-own");
  if (own) effect.resize(effect.size() - 4);
  const bool layer = effect == "layer";
  if (argc < 3 || argc % 2 == 0 || (!layer && effect != "inclusion")) {
    std::fprintf(stderr, "usage: bench_coverage layer[-own]|inclusion[-own] DRAWS [MM RATIO]...\n");
    return 2;
  }
  const int draws = std::atoi(argv[2]);
  std::vector<std::pair<double, double>> cases;
  for (int i = 3; i + 1 < argc; i += 2)
    cases.emplace_back(std::atof(argv[i]), std::atof(argv[i + 1]));
  if (cases.empty())
    for (const double size : layer ? std::vector{0.8, 2.0, 5.0} : std::vector{3.0, 5.0, 7.0})
      for (const double ratio : {0.2, 3.0, 10.0}) cases.emplace_back(size, ratio);
  const Recording recording = layer ? test::presses() : presses_above();
  Experiment w = experiment_of(recording, 0.3, {6, 6, 4});
  const Experiment finer = own ? w : experiment_of(recording, 0.15, {9, 9, 5});
  if (own) w.floor = 0;
  std::printf("# %s: a place's floor is %.3g\n", argv[1], w.floor);
  for (const auto& [size, ratio] : cases) {
    const char* const names[2] = {layer ? "thickness" : "radius", "ratio"};
    const std::vector<double> values = layer ? std::vector{1e-3 * size, ratio}
                                             : std::vector{0.041, 0.039, 0.028, 1e-3 * size, ratio};
    run(effect.c_str(), test::with(test::elastic(1.5e4, 0.42), effect, values), names, draws, w,
        finer);
  }
}
