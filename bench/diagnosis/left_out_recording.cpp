// A recording whose hidden effect is taken from the catalogue: what is said then?
//   bench_left_out RESULTS.csv [NAME EFFECT BODY.ply RECORDING.csv]
// Adds the recording to RESULTS, unless it is there, and prints the table of all.
// Recorded in bench/results/left-out.txt (bench/record.sh).
#include <algorithm>
#include <cmath>
#include <ctime>

#include "base/error.h"
#include "diagnose/diagnose.h"
#include "fit/fit.h"
#include "formats/tetmesh_io.h"
#include "left_out.h"
#include "mesh/tetmesh.h"
#include "summary.h"

namespace hapsim::bench {
namespace {

Experiment experiment(const std::string& body, const std::string& recording) {
  Input of_body(body), of_recording(recording);
  ExperimentOptions options;
  options.cache = default_cache_directory();
  options.draft = true;  // as hs-diagnose
  return make_experiment(read_body(of_body), read_recording(of_recording), options);
}

Trial diagnosed(const std::string& name, const std::string& effect, const Experiment& w) {
  const Selection all = all_episodes(w.dataset);
  const Model model =
      fit_best({elastic_model(w, all)}, w, all, {w.noise.value, w.floor, true}).model;
  DiagnoseOptions how;
  how.unknown = effect;
  const std::clock_t begin = std::clock();
  const Diagnosis d = diagnose(model, w, w.allowance(), how);
  Trial t;
  t.truth = name;
  t.effects = effect;
  t.level = d.rmse.told() / d.noise;
  t.verdict = verdict_name(d.verdict);
  for (const Finding& f : d.findings) {
    if (f.verdict == Verdict::kMissing) t.missing += (t.missing.empty() ? "" : " ") + f.effect;
    if (f.verdict == Verdict::kIndistinguishable)
      t.rivals += (t.rivals.empty() ? "" : " ") + f.effect;
  }
  t.left = d.left.kind;
  const double floor = std::hypot(d.noise, d.floor * d.force_rms.told());
  t.now = d.held_out.told() / floor;
  t.after = d.held_out_end.told() / floor;
  t.seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  return t;
}

}  // namespace
}  // namespace hapsim::bench

int main(int argc, char** argv) {
  using namespace hapsim::bench;
  if (argc != 2 && argc != 6) {
    std::fprintf(stderr, "bench_left_out RESULTS.csv [NAME EFFECT BODY.ply RECORDING.csv]\n");
    return 2;
  }
  try {
    std::vector<Trial> trials = read_trials(argv[1]);
    const auto known = [&](const Trial& t) { return t.truth == argv[2]; };
    if (argc == 6 && std::none_of(trials.begin(), trials.end(), known)) {
      trials.push_back(diagnosed(argv[2], argv[3], experiment(argv[4], argv[5])));
      append_trial(argv[1], trials.back());
    }
    print_left_out(trials);
  } catch (const hapsim::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 3;
  }
  return 0;
}
