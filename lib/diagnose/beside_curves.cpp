#include "diagnose/beside_curves.h"

#include <algorithm>
#include <utility>

#include "diagnose/search.h"
#include "effects/catalogue.h"
#include "model/model_edit.h"

namespace hapsim {
namespace {

// The curve beside which the law of `name` is not the cause's; "": none.
std::string curve_beside(const std::string& name, const std::vector<Finding>& findings) {
  for (const Finding& f : findings) {
    const EffectCard& card = require_effect(f.effect).card();
    if (f.verdict == Verdict::kMissing && card.learned && !card.is_field &&
        std::count(card.confounders.begin(), card.confounders.end(), name) > 0)
      return f.effect;
  }
  return "";
}

}  // namespace

void doubt_beside_curves(Baseline& base, const TrialGround& g, const Folds& folds, Diagnosis& d) {
  if (!d.rivals.empty()) return;
  for (std::size_t k = 0; k < d.findings.size(); ++k) {
    const Finding& f = d.findings[k];
    if (f.verdict != Verdict::kMissing || require_effect(f.effect).card().learned) continue;
    const std::string effect = f.effect, curve = curve_beside(effect, d.findings);
    if (curve.empty()) continue;
    Model lesser = base.fitted.model;
    remove_effect(lesser, effect);
    Baseline without = make_baseline(lesser, g, folds);
    if (!without.fitted.converged) continue;
    base = std::move(without);
    for (Finding& each : d.findings) {  // with all of its terms
      if (each.effect != effect || each.verdict != Verdict::kMissing) continue;
      each.verdict = Verdict::kPossible;
      each.doubted = true;
      each.curve = curve;
      each.evidence += "; beside it " + curve + " is needed: its form is not the cause's";
    }
  }
  put_in_order(d.findings);
}

}  // namespace hapsim
