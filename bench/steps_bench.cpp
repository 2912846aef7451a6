// Every effect of the catalogue in the real-time loop: how far it is from the batch mode at places
// that were prepared, and what a step costs, a million each by the clock, whose own 20 to 40 ns are
// in it, with the memory that they took. Where a step cannot be what a whole press would have, the
// effect's card says why, and it is printed. No effect is named.
//
//   bench_steps [EFFECT...]
//
// Exit code 1 where a limit is missed that is not the machine's: the difference, or memory.
// Recorded in bench/results/effects-live.txt (bench/record.sh).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "base/blas.h"
#include "model/model_edit.h"
#include "realtime/force_loop.h"
#include "realtime/latency.h"
#include "realtime/real_time.h"
#include "support/allocations.h"
#include "support/live_against_batch.h"

namespace {

using namespace hapsim;

constexpr int kSteps = 1'000'000;
constexpr double kSame = 1e-9;  // of the largest force

struct Failures {
  int different = 0, with_memory = 0, not_finite = 0;
};

// A tool that wanders over the top and presses as it goes, up to 3 mm deep.
void steps(const std::string& name, const std::string& difference, const PreparedBody& body,
           bool slides, Failures& failures) {
  ToolLoopOptions options;
  options.contact.slides = slides;
  ForceLoop loop(body, options);
  LatencyHistogram histogram;
  long touching = 0;
  double work = 0;
  bool finite = true;
  const long before = test::allocations;
  for (int i = 0; i < kSteps; ++i) {
    const double t = 1e-3 * i;
    const Vec3 tool(0.04 + 0.02 * std::sin(0.37 * t), 0.04 + 0.02 * std::sin(0.53 * t + 1),
                    0.0395 - 0.0025 * std::sin(5 * t));
    loop.set_temperature(20 + std::sin(0.1 * t));
    const std::int64_t start = monotonic_ns();
    const Vec3 f = loop.step(t, tool);
    histogram.add(monotonic_ns() - start);
    finite = finite && f.allFinite();
    work += f.z();
    touching += loop.tool().touching() ? 1 : 0;
  }
  const long taken = test::allocations - before;
  fmt::print(
      "{:<16} {:>10} {:>6} {:>5.0f} % {:>8.2f} {:>8.2f} {:>8.2f} {:>9.2f} {:>9.1f} {:>11} {:>7}   "
      "{:.3g}\n",
      name, difference, slides ? "slides" : "holds", 100.0 * static_cast<double>(touching) / kSteps,
      1e-3 * histogram.quantile(0.5), 1e-3 * histogram.quantile(0.99),
      1e-3 * histogram.quantile(0.999), 1e-3 * histogram.quantile(0.9999),
      1e-3 * histogram.largest(), taken, finite ? "yes" : "NO", work / kSteps);
  failures.with_memory += taken != 0 ? 1 : 0;
  failures.not_finite += finite ? 0 : 1;
}

// Straight presses and bent ones; an effect that asks for what comes later is compared in straight
// ones, and one of a recording with the model without it.
double difference_of(Model model, const PreparedBody& body, const EffectCard* card) {
  const bool looks_ahead = card == nullptr || card->looks_ahead;
  if (card != nullptr && card->of_recording) remove_effect(model, card->name);
  double largest = 0;
  for (const bool straight : {true, false}) {
    if (looks_ahead && !straight) continue;
    static const Experiment straight_one = test::rich_experiment(true);
    static const Experiment bent = test::rich_experiment(false);
    const Experiment& experiment = straight ? straight_one : bent;
    largest = std::max(
        largest, test::live_difference(body, experiment, test::batch_forces(model, experiment)));
  }
  return largest;
}

bool asked_for(const std::string& name, const std::vector<std::string>& names) {
  return names.empty() || std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

int main(int argc, char** argv) {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  const std::vector<std::string> names(argv + 1, argv + argc);
  prepare_blas_for_many_threads();
  const Experiment experiment = test::rich_experiment(true);
  PreparedBodyOptions options;
  options.tool_radius = 0.004;
  options.most_samples = 16;  // places in between are the other bench's
  options.contacts = [&](const MaterialSpec& m) { return known_contacts(experiment.places, m); };
  fmt::print("{}\none step of the loop, {} steps [us]; difference: largest, of the largest force\n",
             enter_real_time(), kSteps);
  fmt::print(
      "{:<16} {:>10} {:>6} {:>7} {:>8} {:>8} {:>8} {:>9} {:>9} {:>11} {:>7}   mean force [N]\n",
      "effect", "difference", "tool", "touch", "median", "99 %", "99.9 %", "99.99 %", "longest",
      "allocations", "finite");
  Failures failures;
  const auto measure = [&](const std::string& name, const Model& model, const EffectCard* card) {
    const PreparedBody body(test::pressed_block(), model, options);
    const double difference = difference_of(model, body, card);
    failures.different += difference > kSame ? 1 : 0;
    for (const bool slides : {false, true})
      steps(name, fmt::format("{:.1e}", difference), body, slides, failures);
    if (card != nullptr && !card->live.empty()) fmt::print("  its card: {}\n", card->live);
  };
  Model all;
  int count = 0;
  for (const Effect* effect : catalogue()) {
    const EffectCard& card = effect->card();
    Random random(7);
    const Model model = test::model_with(*effect, random, 4);
    if (asked_for(card.name, names)) measure(card.name, model, &card), ++count;
    if (card.solved || card.moves_body || card.is_map || card.of_recording) continue;
    for (const Parameter& p : model.parameters)
      if (p.effect == card.name) all.parameters.push_back(p);
  }
  if (names.empty()) measure("all at once", all, nullptr);
  leave_real_time();
  fmt::print("{} effects: {} differ by more than {:g}, {} loops took memory, {} were not finite\n",
             count, failures.different, kSame, failures.with_memory, failures.not_finite);
  return failures.different + failures.with_memory + failures.not_finite > 0 ? 1 : 0;
}
