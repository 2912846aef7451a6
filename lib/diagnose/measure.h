// How much better a candidate is than what it is compared with.
#pragma once

#include <limits>
#include <vector>

#include "diagnose/candidate.h"
#include "diagnose/place_freedom.h"
#include "estimate/information.h"
#include "estimate/sign_flip.h"

namespace hapsim {

// All candidates of a round are measured with the same weights. Their noise is the sensor's, or the
// error of the best candidate where that is larger: what nobody explains must not decide the
// ranking.
struct Yardstick {
  Weights weights;
  double noise = 0;            // [N]
  PlaceFreedom freedom;        // of the field that the baseline learns, or as asked
  Eigen::VectorXd residual;    // of the baseline, whitened, without that freedom
  Eigen::MatrixXd jacobian;    // the same of its parameters
  Eigen::MatrixXd unweighted;  // and as the forces are [N]
  bool offsets = false;        // the baseline solves for an offset of each press
};

// How much better the candidate is. Most effects are judged by the sum of squares and the number of
// parameters; beside a field that the baseline learns by what the field cannot follow; a field by
// the places that it has not seen, for what it spends on those it has is not counted in parameters.
struct Measured {
  double criterion_gain = 0;
  bool hidden = false;  // what it does the field or a law of each place could do as well
  double memory = 1;    // samples per independent one in the candidate's residuals
  // Fall of the mean squared residual [N^2]; NaN: that of the fit.
  double explained = std::numeric_limits<double>::quiet_NaN();
  CandidateScores scores;  // empty when the effect has a test of its own
  double p_value = 1;      // by that test
  // Chance of so large a fall of the sum of squares by an F test whose samples are as many as the
  // candidate's own residuals are independent (integrated autocorrelation time): needs no signs of
  // presses, of which few may carry the effect, but believes the noise.
  double p_by_size = 1;
  double smallest_seen = 0;  // of the first parameter: the size that half of the recordings show
};

// `each_place_free`: as if the baseline learned a field.
Yardstick make_yardstick(const Baseline& baseline, const std::vector<Candidate>& candidates,
                         const TrialGround& ground, bool each_place_free = false);
// Over all presses.
double autocorrelation_time(const Eigen::VectorXd& residual, const TrialGround& ground);
// A field must have been held out.
Measured measure(const Candidate& candidate, const Baseline& baseline, const Yardstick& yardstick,
                 const TrialGround& ground);

}  // namespace hapsim
