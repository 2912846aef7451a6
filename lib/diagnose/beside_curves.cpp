#include "diagnose/beside_curves.h"

#include <algorithm>
#include <utility>

#include "diagnose/held_out.h"
#include "diagnose/in_place.h"
#include "diagnose/left_over.h"
#include "diagnose/search.h"
#include "effects/catalogue.h"

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

// Of `effect` with all of its terms. `foretells`: what it takes away is taken by nothing else.
void doubt_form(const std::string& effect, const std::string& curve, const std::string& why,
                bool foretells, std::vector<Finding>& findings) {
  for (Finding& each : findings) {
    if (each.effect != effect || each.verdict != Verdict::kMissing) continue;
    each.verdict = Verdict::kPossible;
    each.doubted = foretells;
    each.curve = curve;
    each.evidence += "; " + why + ": its form is not the cause's";
  }
}

// Of the squares beyond noise [N].
double share_taken(const Finding& f, double noise) {
  const double now = f.rmse_now.pooled * f.rmse_now.pooled;
  const double after = f.rmse_after.pooled * f.rmse_after.pooled;
  return std::clamp((now - after) / std::max(now - noise * noise, 1e-300), 0.0, 1.0);
}

}  // namespace

void doubt_beside_curves(Baseline& base, const TrialGround& g, const Folds& folds, Diagnosis& d) {
  if (!d.rivals.empty()) return;
  for (std::size_t k = 0; k < d.findings.size(); ++k) {
    const Finding& f = d.findings[k];
    if (f.verdict != Verdict::kMissing || require_effect(f.effect).card().learned) continue;
    const std::string effect = f.effect, curve = curve_beside(effect, d.findings);
    if (curve.empty()) continue;
    Baseline without = without_effect(effect, base, g, folds);
    if (!without.fitted.converged) continue;
    base = std::move(without);
    doubt_form(effect, curve, "beside it " + curve + " is needed", true, d.findings);
  }
  put_in_order(d.findings);
}

void curves_for_laws(Baseline& base, const TrialGround& g, const Folds& folds,
                     const DiagnoseOptions& options, Diagnosis& d) {
  if (!d.rivals.empty()) return;
  LeftOver left = left_over(base.fitted, g);
  if (left.noise_alone()) return;
  tell_kinds(base.fitted, g, left);
  std::vector<std::string> names;
  for (auto f = d.findings.rbegin(); f != d.findings.rend(); ++f)
    if (f->verdict == Verdict::kMissing && std::count(names.begin(), names.end(), f->effect) == 0)
      names.push_back(f->effect);
  for (const std::string& effect : names) {
    if (!base.fitted.model.has(effect)) continue;  // a curve before holds it
    options.tell("a curve in the place of " + effect);
    std::optional<InPlace> found =
        curve_in_place(effect, left.kind, options.unknown, base, g, folds, options.gates);
    if (!found) continue;
    const Baseline without_law = without_effect(effect, base, g, folds);
    const auto first = std::find_if(d.findings.begin(), d.findings.end(), [&](const Finding& f) {
      return f.effect == effect && f.verdict == Verdict::kMissing;
    });
    Finding curve = *first;
    curve.p_value = std::max(curve.p_value, found->measured.p_by_size);
    curve.rmse_now = without_law.fitted.error;
    curve.held_out_now = held_out_for(*found->candidate.effect, without_law).error;
    curve.rmse_after = found->base.fitted.error;
    curve.held_out_after = found->candidate.held_out.error;
    curve.share = share_taken(curve, g.allowance.noise);
    describe_in_place(*found, g.dataset, curve);
    doubt_form(effect, curve.effect, curve.effect + " does no worse on what is unseen", false,
               d.findings);
    std::erase_if(d.findings, [&](const Finding& f) { return f.effect == curve.effect; });
    d.findings.push_back(curve);
    base = std::move(found->base);
    for (const std::string& name : names)
      if (name != effect && !base.fitted.model.has(name))
        doubt_form(name, curve.effect, curve.effect + " holds it", false, d.findings);
    left = left_over(base.fitted, g);
    if (left.noise_alone()) break;
    tell_kinds(base.fitted, g, left);
  }
  put_in_order(d.findings);
}

}  // namespace hapsim
