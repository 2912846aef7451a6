#include "diagnose/round_judge.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "diagnose/held_out.h"
#include "diagnose/wording.h"
#include "effects/catalogue.h"
#include "fit/testable.h"
#include "model/model_edit.h"

namespace hapsim {
namespace {

double force_change(const Fit& a, const Fit& b, const TrialGround& g) {
  const Selection all = all_episodes(g.dataset);
  const Eigen::VectorXd d =
      model_forces(a, g.experiment, all, false).f - model_forces(b, g.experiment, all, false).f;
  return std::sqrt(d.squaredNorm() / static_cast<double>(d.size()));
}

// What the model's approximate laws may leave [N]: from less, no other effect can be inferred.
double left_by_laws(const Fit& fitted, const TrialGround& g) {
  double most = 0;
  for (const std::string& name : fitted.model.effects()) {
    const double share = require_effect(name).card().form_error;
    if (share <= 0) continue;
    Model without = fitted.model;
    remove_effect(without, name);
    most = std::max(most, share * force_change(fitted, as_it_is(without, g.experiment), g));
  }
  return most;
}

// What acts at one position is not known from the others. Where it takes away all that is beyond
// noise, presses that are left out of positions pressed otherwise too are what it has to help.
void judge_by_presses(const Candidate& c, const Baseline& base, const TrialGround& g,
                      int folds_at_most, Finding& f) {
  constexpr double kAllOfIt = 0.9;
  if (!c.effect->card().local || f.share < kAllOfIt ||
      f.rmse_after.pooled > kLikeNoise * g.allowance.noise || std::isnan(f.held_out_after.pooled) ||
      held_out_fall(f) >= kPlainFall)
    return;
  const Folds folds = make_press_folds(g.dataset, folds_at_most);
  if (folds.held_out.empty()) return;
  f.by_presses = true;
  f.held_out_now = held_out_of(base.fitted, g, folds, Map::kAnew).error;
  f.held_out_after = held_out_of(c.fitted, g, folds, Map::kAnew).error;
}

}  // namespace

double held_out_fall(const Finding& f) {
  return f.held_out_now.pooled > 0 ? 1 - f.held_out_after.pooled / f.held_out_now.pooled : 0;
}

RoundJudge::RoundJudge(const Baseline& base, const TrialGround& ground, const Folds& folds,
                       const DiagnoseOptions& options, std::size_t tried, Tell tell)
    : base_(base),
      g_(ground),
      folds_(folds),
      options_(options),
      tried_(static_cast<double>(tried)),
      tell_(std::move(tell)),
      noise_(ground.allowance.noise * ground.allowance.noise),
      beyond_noise_(base.fitted.error.pooled * base.fitted.error.pooled - noise_),
      by_laws_(left_by_laws(base.fitted, ground)) {}

Finding RoundJudge::find(Candidate& c, const Measured& m, double p_value) const {
  Finding f;
  f.effect = c.effect->card().name;
  f.one_more_term = c.one_more_term;
  f.rmse_now = base_.fitted.error;
  f.rmse_after = c.fitted.error;
  f.held_out_now = held_out_for(*c.effect, base_).error;
  f.held_out_after = {};
  f.evidence = implausible(c.fitted.model, *c.effect, g_.dataset);
  if (!f.evidence.empty()) return f;
  f.p_value = p_value;
  f.criterion_gain = m.criterion_gain;
  f.memory = m.memory;
  const double fall = base_.fitted.error.pooled * base_.fitted.error.pooled -
                      c.fitted.error.pooled * c.fitted.error.pooled;
  // Offsets of presses take away what other misfits leave as well, so only what nothing else
  // can be counts, unless noise alone is left.
  const bool all_of_it =
      std::isnan(m.explained) || c.fitted.error.pooled < kLikeNoise * g_.allowance.noise;
  if (beyond_noise_ > 0.01 * noise_)
    f.share = std::clamp((all_of_it ? fall : m.explained) / beyond_noise_, 0.0, 1.0);
  f.hidden = m.hidden && f.share >= options_.gates.share;
  // Those refits only matter to what passes otherwise.
  if (!c.effect->card().is_field && f.criterion_gain > options_.gates.criterion_gain &&
      f.share >= options_.gates.share) {
    tell_(f.effect + " on unseen data", 0, 0);
    hold_out(c, g_, folds_);
    prefer_sites(c, base_, g_, folds_);
    f.every_site = c.every_site;
    f.rmse_after = c.fitted.error;
  }
  f.held_out_after = c.held_out.error;
  judge_by_presses(c, base_, g_, options_.folds, f);
  // Where few presses carry an effect their signs cannot prove it, however large it is.
  const double by_size = std::min(1.0, 2 * m.p_by_size * tried_);
  if (f.share >= kMostOfIt && held_out_fall(f) >= kPlainFall)
    f.p_value = std::min(f.p_value, by_size);
  f.plain = f.share >= kMostOfIt && by_size < options_.gates.p_value;
  f.within_form = by_laws_ > 0 && force_change(c.fitted, base_.fitted, g_) < by_laws_;
  f.where = describe_where(c);
  describe_fit(c, m, g_.dataset, f);
  if (f.within_form)
    f.evidence += fmt::format(
        "; changes the forces by less than the {:.2g} N that an approximate law in the model may "
        "leave",
        by_laws_);
  if (f.by_presses)
    f.evidence +=
        "; seen by too few positions for a position to be foretold from the others, so the unseen "
        "error is that of presses: press around it";
  f.next_measurement = c.effect->card().separated_by;
  return f;
}

}  // namespace hapsim
