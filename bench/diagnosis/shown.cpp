#include "shown.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

namespace hapsim::bench {

double strength_that_shows(const Truth& truth, const Model& base, const Diagnosis& of_nothing) {
  if (!truth.model || truth.sizes > 0 || truth.effects.size() != 1) return -1;
  const std::string& effect = truth.effects.front();
  const auto finding = std::find_if(of_nothing.findings.begin(), of_nothing.findings.end(),
                                    [&](const Finding& f) { return f.effect == effect; });
  if (finding == of_nothing.findings.end()) return -1;
  const FittedValue& shown = finding->smallest;
  if (!std::isfinite(shown.value) || !std::isfinite(shown.identity)) return -1;
  const auto off = [&](double strength) {
    const Parameter* p = truth.model(base, strength).find(effect, 0, shown.name);
    return p == nullptr ? 0 : std::abs(p->value - shown.identity);
  };
  double low = 1e-9 * truth.most, high = truth.most;
  if (off(low) >= shown.value || off(high) < shown.value) return -1;
  for (int k = 0; k < 60; ++k) {
    const double middle = std::sqrt(low * high);
    (off(middle) < shown.value ? low : high) = middle;
  }
  return high;
}

void print_shown(const std::vector<Trial>& trials) {
  struct Row {
    int named = 0, all = 0;
    double level = 0;
  };
  std::map<std::string, Row> rows;
  Row sum;
  for (const Trial& t : trials) {
    std::istringstream missing(t.missing + " " + t.rivals);
    bool named = false;
    for (std::string name; missing >> name;) named = named || name == t.effects;
    for (Row* row : {&rows[t.truth], &sum}) {
      row->named += named;
      ++row->all;
      row->level += t.level;
    }
  }
  fmt::print("{:<24} {:>6} {:>6} {:>22}\n", "truth", "named", "of", "mean error over noise");
  for (const auto& [truth, row] : rows)
    fmt::print("{:<24} {:>6} {:>6} {:>22.2f}\n", truth, row.named, row.all, row.level / row.all);
  if (sum.all > 0)
    fmt::print(
        "\nnamed at the size from which they would show: {} of {} = {:.0f} %  (half asked)\n",
        sum.named, sum.all, 100.0 * sum.named / sum.all);
}

}  // namespace hapsim::bench
