// What is unseen as the judge of effects: the rests of few presses, and whole presses left out.
#pragma once

#include <string>

#include "diagnose/diagnose.h"
#include "fit/forecasts.h"

namespace hapsim {

// One effect more, or several, on what was unseen before and after.
struct Foretold {
  ForceError before, after;  // over all that was unseen
  double rest_fall = 0;      // of the error on the rests of the presses, relative
  double press_fall = 0;     // on whole presses; NaN: there is one
  // Logarithm of the ratio of the likelihoods of the rests. A stretch of n independent samples is
  // likelier by n log(s_before / s_after), where s is the error left, no less than the noise
  // (profile likelihood of its size). Samples are as many fewer as what the better model leaves is
  // alike from one to the next (integrated autocorrelation time), but a stretch foretold from all
  // before it is a sample of its own.
  double likelier = 0;
  // Of such a likelihood ratio without the effect, at most (Markov's inequality).
  double chance() const;
};

class Judge {
 public:
  // `fitted`: without the effects. The ground must outlive it.
  Judge(const Fit& fitted, const TrialGround& ground, const DiagnoseOptions& options);

  // Names are sorted; a name twice is a term more.
  Foretold of(const Forecasts::Names& before, const Forecasts::Names& after);
  ForceError error(const Forecasts::Names& added);
  // Mean logarithm of the errors on the rests, each no less than the noise: a size that no single
  // rest decides.
  double log_error(const Forecasts::Names& added);
  // Whether what is unseen speaks for what `after` has more.
  bool admits(const Foretold& foretold) const;

 private:
  double size(const Eigen::VectorXd& left) const;  // no less than the noise [N]

  const TrialGround& ground_;
  Gates gates_;
  Forecasts rests_, presses_;
};

// "rest of each press", "rest of each press and positions": what was unseen.
std::string unseen_by(const Dataset& dataset, int folds);

}  // namespace hapsim
