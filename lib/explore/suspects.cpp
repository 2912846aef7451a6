#include "explore/suspects.h"

#include "base/error.h"
#include "diagnose/held_out.h"

namespace hapsim {

Suspects suspects_of(const Diagnosis& d, const Experiment& experiment,
                     const DiagnoseOptions& options) {
  constexpr std::size_t kMost = 3;
  Suspects suspects;
  if (d.rivals.size() > 1) {
    suspects.models = d.rivals;
    for (const Finding& f : d.findings)
      if (f.verdict == Verdict::kIndistinguishable) suspects.names.push_back(f.effect);
    return suspects;
  }
  const TrialGround ground(experiment, experiment.allowance());
  const Selection all = all_episodes(experiment.dataset);
  const Fit base = fit(d.rivals.front(), experiment, all, trial_fit_options(ground));
  for (const Finding& f : d.findings) {
    if (f.verdict != Verdict::kPossible || suspects.models.size() == kMost) continue;
    options.tell("fitting " + f.effect);
    try {
      const Fit with =
          fit_best(with_effect(base, f.effect, experiment, all, trial_extend_options(ground)),
                   experiment, all, trial_fit_options(ground));
      if (!with.converged) continue;
      suspects.models.push_back(with.model);
      suspects.names.push_back(f.effect);
    } catch (const Error&) {  // these presses cannot bear it after all
    }
  }
  return suspects;
}

}  // namespace hapsim
