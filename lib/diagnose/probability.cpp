#include "diagnose/probability.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "effects/catalogue.h"

namespace hapsim {
namespace {

// Of the trials (bench/diagnosis/run.sh, probabilities.py): the temper of the likelihoods, and how
// often what was said was true.
constexpr double kTemper = 15;
constexpr double kMissingAlone = 0.96, kMissingAndMore = 0.85;  // by whether noise alone is left
constexpr double kOneOfMany = 0.1;                              // of one kind: none of eleven was
constexpr double kSetHolds = 0.95;
constexpr double kPossible = 0.08, kAbsent = 0.002;

// By the shape of the body, which is no effect.
bool is_doubted(const Finding& f) {
  return std::find(f.confused_with.begin(), f.confused_with.end(), "shape") !=
         f.confused_with.end();
}

bool has_kind(const Finding& f, const std::string& kind) {
  const std::vector<std::string>& kinds = require_effect(f.effect).card().kinds;
  return std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
}

}  // namespace

double share_among(const Finding& first, const std::vector<const Finding*>& others) {
  double sum = 1;
  for (const Finding* f : others)
    sum += std::exp((f->criterion_gain - first.criterion_gain) /
                    (2 * kTemper * std::max(1.0, first.memory)));
  return 1 / sum;
}

void set_probabilities(Diagnosis& d) {
  const double missing = d.left.noise_alone() ? kMissingAlone : kMissingAndMore;
  std::vector<const Finding*> rivals;
  for (const Finding& f : d.findings)
    if (f.verdict == Verdict::kIndistinguishable && !is_doubted(f)) rivals.push_back(&f);
  const auto among_rivals = [&](const Finding& f) {
    std::vector<const Finding*> others = rivals;
    std::erase(others, &f);
    return kSetHolds * share_among(f, others);
  };
  for (Finding& f : d.findings) {
    switch (f.verdict) {
      case Verdict::kMissing:
        f.probability = f.share_among * (has_kind(f, d.one_kind) ? kOneOfMany : missing);
        break;
      case Verdict::kIndistinguishable:
        f.probability = is_doubted(f) ? kSetHolds / 2 : among_rivals(f);
        break;
      case Verdict::kPossible: {
        const auto rival = std::find_if(rivals.begin(), rivals.end(),
                                        [&](const Finding* r) { return r->effect == f.beside; });
        f.probability = rival == rivals.end() ? kPossible : missing * among_rivals(**rival);
        break;
      }
      case Verdict::kAbsent:
        f.probability = kAbsent;
        break;
      default:
        f.probability = std::numeric_limits<double>::quiet_NaN();
    }
  }
}

std::string probability_in_words() {
  return fmt::format(
      "that it acts (of a curve of no law: that the cause is of its kind), as verdicts like it "
      "were "
      "borne out in simulated trials: what is missing and leaves noise alone {:g} %, {:g} where it "
      "leaves more, {:g} where three or more are of one kind, less where others passed beside it; "
      "a set that cannot be told apart holds it "
      "in "
      "{:g} % of these, shared by the likelihoods; possible {:g} %, absent {:g} %. Empty of fewer "
      "than "
      "{} presses",
      100 * kMissingAlone, 100 * kMissingAndMore, 100 * kOneOfMany, 100 * kSetHolds,
      100 * kPossible, 100 * kAbsent, kLeastPresses);
}

}  // namespace hapsim
