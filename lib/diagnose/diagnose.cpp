#include "diagnose/diagnose.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "diagnose/beside_curves.h"
#include "diagnose/few_presses.h"
#include "diagnose/foretold.h"
#include "diagnose/held_out.h"
#include "diagnose/odd_presses.h"
#include "diagnose/one_size.h"
#include "diagnose/probability.h"
#include "diagnose/search.h"
#include "diagnose/shared_by_places.h"
#include "diagnose/wording.h"
#include "effects/catalogue.h"

namespace hapsim {
namespace {

void search_few(Baseline& base, const TrialGround& g, const DiagnoseOptions& options,
                Diagnosis& d) {
  const FewPresses few = diagnose_few_presses(base, g, options);
  d.findings = few.findings;
  put_in_order(d.findings);
  d.findings.insert(d.findings.end(), few.untestable.begin(), few.untestable.end());
  d.rivals = few.rivals;
  base = make_baseline(few.end.model, g, {});
  d.held_out = few.held_out;
  d.held_out_end = few.held_out_end;
  d.held_out_by = unseen_by(g.dataset, options.folds);
}

}  // namespace

std::string verdict_name(Verdict verdict) {
  switch (verdict) {
    case Verdict::kMissing:
      return "missing";
    case Verdict::kPossible:
      return "possible";
    case Verdict::kIndistinguishable:
      return "indistinguishable";
    case Verdict::kAbsent:
      return "absent";
    default:
      return "not testable";
  }
}

std::string verdict_name(ModelVerdict verdict) {
  switch (verdict) {
    case ModelVerdict::kComplete:
      return "complete";
    case ModelVerdict::kIncomplete:
      return "incomplete";
    case ModelVerdict::kAmbiguous:
      return "ambiguous";
    default:
      return "unexplained";
  }
}

namespace {

bool is_named(const Finding& f) {
  return f.verdict == Verdict::kMissing || f.verdict == Verdict::kIndistinguishable;
}

// What the given model leaves (`now`), by laws, beside what the names take of it. Where these stand
// in for another cause, what is said is of the given model; whether they do.
bool doubt_beside_laws(const Baseline& given, LeftOver now, const TrialGround& g, Diagnosis& d) {
  if (d.left.noise_alone() || !(now.error > 1)) return false;
  std::vector<std::string> named;
  for (const Finding& f : d.findings)
    if (is_named(f)) named.push_back(f.effect);
  if (named.empty()) return false;
  tell_kinds(given.fitted, g, now);
  const double before = now.error * now.error, after = d.left.error * d.left.error;
  d.stand_ins = find_stand_ins(now.kinds, named, (before - after) / (before - 1), d.left.kinds);
  if (d.stand_ins.kind.empty()) {
    d.misfit = now.kinds;
    return false;
  }
  for (Finding& f : d.findings)
    if (is_named(f)) doubt("what the model misses is of another kind", f);
  put_in_order(d.findings);
  d.rivals.clear();
  d.left = now;
  return true;
}

// Presses unlike all others are what is left, where the model is right without them.
void blame_odd_presses(const Fit& fitted, const TrialGround& g, Diagnosis& d) {
  const OddPresses odd = find_odd_presses(fitted, g);
  if (odd.ids.empty()) return;
  d.odd_presses = odd.ids;
  d.left.kind = kEvent;
  d.left.words = fmt::format("{:.2g} x the noise is left. {}", d.left.error, odd.words());
}

Diagnosis with_allowance(const Model& model, const TrialGround& g, const DiagnoseOptions& options) {
  const bool few_presses = g.dataset.episodes.size() < kLeastPresses;
  const Folds folds = few_presses ? Folds{} : make_folds(g.dataset, options.folds);
  Baseline base = make_baseline(model, g, folds);
  if (!base.fitted.converged)
    fail_numerics(g.dataset.recording.name, "the model does not fit: " + base.fitted.message,
                  "identify it again with hs-identify");
  Diagnosis d;
  d.noise = g.allowance.noise;
  d.noise_measured = g.experiment.noise.measured;
  d.floor = g.allowance.floor;
  d.shape = g.experiment.shape;
  d.mesh_uncertainty = g.experiment.places.mesh_uncertainty();
  d.rmse = base.fitted.error;
  const Baseline given = base;
  const LeftOver now = left_over(given.fitted, g);
  d.kind_now = now.kind;
  d.held_out = base.held_out.error;
  d.held_out_by = folds.by;
  const Eigen::VectorXd measured = measured_forces(g.dataset, all_episodes(g.dataset));
  d.force_rms = force_error(g.dataset, measured);

  if (few_presses)
    search_few(base, g, options, d);
  else
    search(base, g, folds, options, d);
  if (!few_presses && d.rivals.empty() &&
      doubt_what_places_share(base, g, folds, options.gates, d.findings))
    put_in_order(d.findings);
  if (!few_presses) {
    // What is found beside a curve may be doubted in turn, and so on, but not for ever.
    for (int k = 0; doubt_one(base, g, folds, d); ++k)
      if (k < options.gates.most_effects) curves_for_doubted(base, g, folds, options, d);
    curves_for_laws(base, g, folds, options, d);
    doubt_beside_curves(base, g, folds, d);
  }
  if (few_presses || d.rivals.empty()) d.left = left_over(base.fitted, g);
  if (!few_presses && !d.left.noise_alone()) {
    tell_kinds(d.rivals.empty() ? base.fitted : as_it_is(d.rivals.front(), g.experiment), g,
               d.left);
    if (d.rivals.empty()) blame_odd_presses(base.fitted, g, d);
    if (d.odd_presses.empty() && doubt_beside_laws(given, now, g, d)) base = given;
  }
  const bool ambiguous = !d.rivals.empty();
  if (!ambiguous) d.rivals.push_back(base.fitted.model);
  d.rmse_end = base.fitted.error;
  if (!few_presses) d.held_out_end = base.held_out.error;
  d.torque = torque_left(base.fitted, g);
  d.marker = marker_left(base.fitted, g, options.markers);
  const bool missing =
      std::any_of(d.findings.begin(), d.findings.end(),
                  [](const Finding& finding) { return finding.verdict == Verdict::kMissing; });
  d.verdict = ambiguous ? ModelVerdict::kAmbiguous
              : missing ? ModelVerdict::kIncomplete
              : !d.left.noise_alone() || !d.torque.explained() || !d.marker.explained()
                  ? ModelVerdict::kUnexplained
                  : ModelVerdict::kComplete;
  d.explanation = explain_verdict(d, g.experiment.noise);
  if (!few_presses) return d;
  const std::size_t presses = g.dataset.episodes.size();
  const std::string count = presses == 1 ? "one press" : fmt::format("{} presses", presses);
  if (d.verdict == ModelVerdict::kUnexplained && !d.left.noise_alone())
    d.explanation = fmt::format(
        "the model fails by {:.2g} x noise, but {} cannot name the cause with a false-alarm rate; "
        "the possible effects stand below, the best first. Record {} presses or more.",
        d.rmse_end.told() / d.noise, count, kLeastPresses);
  else
    d.explanation += fmt::format(
        " Judged by the time within {} alone, which says nothing of other places; record {} "
        "presses "
        "or more.",
        count, kLeastPresses);
  return d;
}

bool moves_body(const Model& model) {
  const std::vector<std::string> effects = model.effects();
  return std::any_of(effects.begin(), effects.end(), [](const std::string& name) {
    return require_effect(name).card().moves_body;
  });
}

bool names(const Diagnosis& d, bool (*kind)(const EffectCard&)) {
  return std::any_of(d.findings.begin(), d.findings.end(), [&](const Finding& f) {
    return (f.verdict == Verdict::kMissing || f.verdict == Verdict::kIndistinguishable) &&
           kind(require_effect(f.effect).card());
  });
}

// Stiffnesses that differ by place beyond what is allowed are no work of the shape.
bool differs_by_place(const Model& model, const TrialGround& g) {
  const Fit fitted = fit(model, g.experiment, all_episodes(g.dataset), trial_fit_options(g));
  return left_over(fitted, g).kind == kBody;
}

Diagnosis in_doubt_of_shape(const Model& model, const Experiment& e, const Allowance& allowance,
                            const DiagnoseOptions& options) {
  Diagnosis d = with_allowance(model, {e, allowance}, options);
  // Points off the surface that no move explains, of the kind that forces follow, are a wrong
  // shape: what differs by place may be its work.
  if (d.verdict == ModelVerdict::kComplete || !e.shape.plain() ||
      e.doubted_floor <= allowance.floor || moves_body(model) ||
      names(d, [](const EffectCard& card) { return card.moves_body; }))
    return d;
  options.tell("the shape in doubt");
  const TrialGround doubted_ground(e, {allowance.noise, e.doubted_floor});
  if (!names(d, [](const EffectCard& card) { return card.like_shape && !card.is_field; }) &&
      differs_by_place(model, doubted_ground))
    return d;
  d = with_allowance(model, doubted_ground, options);
  d.shape_in_doubt = true;
  std::string doubted;
  for (Finding& f : d.findings) {
    if (f.verdict != Verdict::kMissing || !require_effect(f.effect).card().like_shape) continue;
    f.verdict = Verdict::kIndistinguishable;
    f.confused_with.push_back("shape");
    doubted += (doubted.empty() ? "" : ", ") + f.effect;
  }
  if (doubted.empty()) return d;
  d.verdict = ModelVerdict::kAmbiguous;
  d.explanation = fmt::format(
      "the data cannot tell {} from a wrong shape of the body: scan it again, or touch it where it "
      "is pressed.",
      doubted);
  for (const std::string& other : {d.torque.words, d.marker.words})
    if (!other.empty()) d.explanation += " " + other;
  return d;
}

void doubt_several_of_one_kind(Diagnosis& d) {
  std::vector<std::string> missing;
  for (const Finding& f : d.findings)
    if (f.verdict == Verdict::kMissing) missing.push_back(f.effect);
  d.one_kind = kind_of_several(missing);
  d.explanation += one_kind_words(d);
}

}  // namespace

Diagnosis diagnose(const Model& model, const Experiment& e, const Allowance& allowance,
                   const DiagnoseOptions& options) {
  Diagnosis d = in_doubt_of_shape(model, e, allowance, options);
  doubt_several_of_one_kind(d);
  // The trials by which they are told have many presses.
  if (e.dataset.episodes.size() >= kLeastPresses) set_probabilities(d);
  return d;
}

}  // namespace hapsim
