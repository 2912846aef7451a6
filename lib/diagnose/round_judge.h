// From how a candidate was measured to what is said of its effect, without the verdict.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "diagnose/candidate.h"
#include "diagnose/measure.h"

namespace hapsim {

// Of one round: what all of its candidates are judged by. Keeps references.
class RoundJudge {
 public:
  using Tell = std::function<void(const std::string& what, std::size_t k, std::size_t n)>;
  // `tried`: how many candidates the round has, for the family-wise chance.
  RoundJudge(const Baseline& base, const TrialGround& ground, const Folds& folds,
             const DiagnoseOptions& options, std::size_t tried, Tell tell);

  // What passes otherwise is fitted without its held-out positions, which costs most; a finding
  // depends on its own candidate alone. `p_value`: by signs, of the family.
  Finding find(Candidate& candidate, const Measured& measured, double p_value) const;

 private:
  const Baseline& base_;
  const TrialGround& g_;
  const Folds& folds_;
  const DiagnoseOptions& options_;
  double tried_;
  Tell tell_;
  double noise_;         // mean square [N^2]
  double beyond_noise_;  // of the baseline's error [N^2]
  double by_laws_;       // what approximate laws of the baseline may leave [N]
};

// Relative fall of the error on unseen positions.
double held_out_fall(const Finding& finding);

}  // namespace hapsim
