// One candidate effect: fitted, scored, and judged on unseen positions.
#pragma once

#include <limits>
#include <optional>

#include "diagnose/diagnose.h"
#include "diagnose/place_freedom.h"
#include "estimate/information.h"
#include "estimate/sign_flip.h"

namespace hapsim {

// A fitted model that candidates are compared against.
struct Baseline {
  Fit fitted;
  HeldOut held_out;      // any map made anew
  HeldOut on_known_map;  // what effects that make no map are compared with
};

// On which the effect is judged by unseen positions.
inline const HeldOut& held_out_for(const Effect& effect, const Baseline& base) {
  return effect.card().is_map ? base.held_out : base.on_known_map;
}

struct Candidate {
  const Effect* effect = nullptr;
  Fit fitted;
  std::vector<Model> starts;  // of the estimate, where finite elements are solved for it
  HeldOut held_out;
  bool one_more_term = false;
  bool every_site = false;  // of regions: each position its own, interpolated between them
};

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

Baseline make_baseline(const Model& model, const TrialGround& ground, const Folds& folds);
// Whether an effect is worth a fit: of one that is `screened`, whether what its starts change and
// their derivatives, in any proportion, take away half of what its parameters cost (the information
// criterion's log n each) from the residual. Costs one evaluation a start; chance takes some 1 a
// parameter.
bool worth_a_fit(const Effect& effect, const Baseline& baseline, const TrialGround& ground);
inline constexpr const char* kTakesNothing =
    "nothing like what it would change is in what the model leaves";
// Fitted from all its starts; nothing when the data cannot test it (`lack` says why).
std::optional<Candidate> try_effect(const Effect& effect, const Baseline& baseline,
                                    const TrialGround& ground, std::string& lack);
// Fits with finite elements solved what was fitted by estimates.
void refine(Candidate& candidate, const TrialGround& ground);
// Its error on held-out positions: with any map made anew if the effect is one, else with the map
// kept (see held_out_for()).
void hold_out(Candidate& candidate, const TrialGround& ground, const Folds& folds);
// For a map only. Regions with boundaries suit a stiffness that jumps; where it changes gradually,
// a modulus at each position with interpolation between them predicts unseen positions better.
// Takes the latter where its unseen error is much smaller, unless boundaries already leave the
// pressed positions noise alone.
void prefer_sites(Candidate& candidate, const Baseline& baseline, const TrialGround& ground,
                  const Folds& folds);
// `each_place_free`: as if the baseline learned a field.
Yardstick make_yardstick(const Baseline& baseline, const std::vector<Candidate>& candidates,
                         const TrialGround& ground, bool each_place_free = false);
// Over all presses.
double autocorrelation_time(const Eigen::VectorXd& residual, const TrialGround& ground);
// A field must have been held out.
Measured measure(const Candidate& candidate, const Baseline& baseline, const Yardstick& yardstick,
                 const TrialGround& ground);

}  // namespace hapsim
