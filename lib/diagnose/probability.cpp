#include "diagnose/probability.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "effects/catalogue.h"

namespace hapsim {
namespace {

// Of trials with effects and with causes that no effect covers (bench/diagnosis/run.sh,
// bench/open-world/statements.py, probabilities.py): the temper of the likelihoods, and how often
// what was said was true.
constexpr double kTemper = 15;
// Where noise alone is left, of one name and of each of several; where more is, of what takes half
// of the misfit at least, and less.
constexpr double kMissingAlone = 0.97, kMissingOfSeveral = 0.8;
constexpr double kMissingAndMore = 0.75, kMissingOfLittle = 0.25;
// Beside a value of each press, which takes what any cause leaves that differs by press.
constexpr double kBesideValues = kMissingOfLittle;
constexpr double kOneOfTwo = 0.5, kOneOfMany = 0.1;  // of one kind
constexpr double kSetHolds = 0.95, kSetAndMoreHolds = 0.75;
// Where nothing is missing, where noise alone is left beside what is, and where more is.
constexpr double kAbsentOfComplete = 0.0002, kAbsentAlone = 0.002, kAbsentAndMore = 0.008;
constexpr double kPossibleAlone = 0.03, kPossibleAndMore = 0.1;

// By the shape of the body, which is no effect.
bool is_doubted(const Finding& f) {
  return std::find(f.confused_with.begin(), f.confused_with.end(), "shape") !=
         f.confused_with.end();
}

// Of what is named missing each, by what else is.
double of_missing(const Diagnosis& d, const Finding& finding) {
  constexpr double kLittle = 0.5;
  const std::vector<std::string>& alike = d.one_kind.effects;
  std::set<std::string> named;
  for (const Finding& f : d.findings)
    if (f.verdict == Verdict::kMissing) named.insert(f.effect);
  const double alone = named.size() > 1 ? kMissingOfSeveral : kMissingAlone,
               and_more = finding.share < kLittle ? kMissingOfLittle : kMissingAndMore;
  const auto is_per_press = [](const std::string& effect) {
    return require_effect(effect).card().per_press;
  };
  double p = d.left.noise_alone() ? alone : and_more;
  if (std::any_of(named.begin(), named.end(), is_per_press) && !is_per_press(finding.effect))
    p = std::min(p, kBesideValues);
  if (std::find(alike.begin(), alike.end(), finding.effect) == alike.end()) return p;
  return alike.size() == 2 ? std::min(p, kOneOfTwo) : kOneOfMany;
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
  const bool alone = d.left.noise_alone();
  const double absent = d.verdict == ModelVerdict::kComplete ? kAbsentOfComplete
                        : alone                              ? kAbsentAlone
                                                             : kAbsentAndMore,
               possible = alone ? kPossibleAlone : kPossibleAndMore,
               set_holds = alone ? kSetHolds : kSetAndMoreHolds;
  std::vector<const Finding*> rivals;
  for (const Finding& f : d.findings)
    if (f.verdict == Verdict::kIndistinguishable && !is_doubted(f)) rivals.push_back(&f);
  const auto among_rivals = [&](const Finding& f) {
    std::vector<const Finding*> others = rivals;
    std::erase(others, &f);
    return set_holds * share_among(f, others);
  };
  for (Finding& f : d.findings) {
    switch (f.verdict) {
      case Verdict::kMissing:
        f.probability = f.share_among * of_missing(d, f);
        break;
      case Verdict::kIndistinguishable:
        f.probability = is_doubted(f) ? set_holds / 2 : among_rivals(f);
        break;
      case Verdict::kPossible: {
        const auto rival = std::find_if(rivals.begin(), rivals.end(),
                                        [&](const Finding* r) { return r->effect == f.beside; });
        f.probability = rival == rivals.end() ? possible : of_missing(d, f) * among_rivals(**rival);
        break;
      }
      case Verdict::kAbsent:
        f.probability = absent;
        break;
      default:
        f.probability = std::numeric_limits<double>::quiet_NaN();
    }
  }
}

std::string probability_in_words() {
  return fmt::format(
      "that it acts (of a curve of no law: that the cause is of its kind), as verdicts like it "
      "were borne out in simulated trials, a part of them with causes that no effect covers: what "
      "is missing and leaves noise alone {:g} %, {:g} where several are; where more is left {:g}, "
      "{:g} of what takes less than half of the misfit or stands beside a value of each press; "
      "{:g} where two are of one kind, {:g} of "
      "more, less where others passed beside it; a set that cannot be told apart holds it in {:g} "
      "% of these, {:g} where more is left, shared by the likelihoods; possible {:g} %, {:g} where "
      "more is left; absent "
      "{:g} % of a complete model, {:g} where noise alone is left, {:g} where more is. Empty of "
      "fewer than {} presses",
      100 * kMissingAlone, 100 * kMissingOfSeveral, 100 * kMissingAndMore, 100 * kMissingOfLittle,
      100 * kOneOfTwo, 100 * kOneOfMany, 100 * kSetHolds, 100 * kSetAndMoreHolds,
      100 * kPossibleAlone, 100 * kPossibleAndMore, 100 * kAbsentOfComplete, 100 * kAbsentAlone,
      100 * kAbsentAndMore, kLeastPresses);
}

}  // namespace hapsim
