// What a step of the real-time loop costs with each effect of the catalogue: a million steps each
// by the clock, whose own 20 to 40 ns are in it, with the memory that they took. No effect is
// named.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "linalg/blas.h"
#include "realtime/force_loop.h"
#include "realtime/latency.h"
#include "realtime/real_time.h"
#include "support/allocations.h"
#include "support/every_effect.h"

namespace {

using namespace hapsim;

constexpr int kSteps = 1'000'000;

// A tool that wanders over the top and presses as it goes, up to 3 mm deep.
void steps(const std::string& name, const PreparedBody& body, bool slides) {
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
      "{:<16} {:>6} {:>5.0f} % {:>8.2f} {:>8.2f} {:>8.2f} {:>9.2f} {:>9.1f} {:>11} {:>7}   "
      "{:.3g}\n",
      name, slides ? "slides" : "holds", 100.0 * static_cast<double>(touching) / kSteps,
      1e-3 * histogram.quantile(0.5), 1e-3 * histogram.quantile(0.99),
      1e-3 * histogram.quantile(0.999), 1e-3 * histogram.quantile(0.9999),
      1e-3 * histogram.largest(), taken, finite ? "yes" : "NO", work / kSteps);
}

}  // namespace

int main() {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  prepare_blas_for_many_threads();
  const Experiment experiment = test::rich_experiment(true);
  PreparedBodyOptions options;
  options.tool_radius = 0.004;
  options.contacts = [&](const MaterialSpec& m) { return known_contacts(experiment.places, m); };
  fmt::print("{}\none step of the loop, {} steps [us]\n", enter_real_time(), kSteps);
  fmt::print("{:<16} {:>6} {:>7} {:>8} {:>8} {:>8} {:>9} {:>9} {:>11} {:>7}   mean force [N]\n",
             "effect", "tool", "touch", "median", "99 %", "99.9 %", "99.99 %", "longest",
             "allocations", "finite");
  Model all;
  for (const Effect* effect : catalogue()) {
    Random random(7);
    const Model model = test::model_with(*effect, random, 4);
    const EffectCard& card = effect->card();
    const PreparedBody body(test::pressed_block(), model, options);
    for (const bool slides : {false, true}) steps(card.name, body, slides);
    if (card.solved || card.moves_body || card.is_map) continue;
    for (const Parameter& p : model.parameters)
      if (p.effect == card.name) all.parameters.push_back(p);
  }
  const PreparedBody body(test::pressed_block(), all, options);
  for (const bool slides : {false, true}) steps("all at once", body, slides);
  leave_real_time();
  return 0;
}
