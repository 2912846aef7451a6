#include "diagnose/foretold.h"

#include <algorithm>
#include <cmath>

#include "diagnose/held_out.h"
#include "diagnose/measure.h"

namespace hapsim {
namespace {

struct Sum {
  double square = 0, components = 0;
  void add(const Eigen::VectorXd& r) {
    square += r.squaredNorm();
    components += static_cast<double>(r.size());
  }
  void add(const std::vector<Eigen::VectorXd>& all) {
    for (const Eigen::VectorXd& r : all) add(r);
  }
  double error() const { return std::sqrt(square / components); }  // NaN: nothing was unseen
};

double fall(const std::vector<Eigen::VectorXd>& before, const std::vector<Eigen::VectorXd>& after) {
  Sum b, a;
  b.add(before), a.add(after);
  return 1 - a.error() / b.error();
}

}  // namespace

double Foretold::chance() const {
  return std::min(1.0, std::exp(-likelier));
}

Judge::Judge(const Fit& fitted, const TrialGround& g, const DiagnoseOptions& options)
    : ground_(g),
      gates_(options.gates),
      rests_(fitted, g.experiment, rests_of_presses(g.experiment), trial_fit_options(g)),
      presses_(fitted, g.experiment, presses_left_out(g.experiment, options.folds),
               trial_fit_options(g)) {}

ForceError Judge::error(const Forecasts::Names& added) {
  Sum sum;
  sum.add(rests_.left(added));
  sum.add(presses_.left(added));
  ForceError error;
  error.axes = ground_.dataset.axes();
  error.pooled = sum.error();
  return error;
}

Foretold Judge::of(const Forecasts::Names& before, const Forecasts::Names& after) {
  Foretold result;
  result.before = error(before);
  result.after = error(after);
  // Presses of few rows have no rests, and whole presses speak alone.
  Forecasts& unseen = rests_.parts().empty() ? presses_ : rests_;
  const auto& r0 = unseen.left(before);
  const auto& r1 = unseen.left(after);
  result.rest_fall = fall(r0, r1);
  result.press_fall = fall(presses_.left(before), presses_.left(after));
  for (std::size_t d = 0; d < r0.size(); ++d) {
    const Eigen::VectorXd& better = r1[d].squaredNorm() < r0[d].squaredNorm() ? r1[d] : r0[d];
    const double memory = autocorrelation_time(better, unseen.parts()[d].lengths);
    const double samples = std::max(static_cast<double>(unseen.parts()[d].lengths.size()),
                                    independent_samples(better, memory));
    result.likelier += samples * std::log(size(r0[d]) / size(r1[d]));
  }
  return result;
}

double Judge::size(const Eigen::VectorXd& left) const {
  const double noise = ground_.allowance.noise * std::sqrt(ground_.dataset.axes() / 3.0);
  return std::max(noise, std::sqrt(left.squaredNorm() / static_cast<double>(left.size())));
}

double Judge::log_error(const Forecasts::Names& added) {
  Forecasts& unseen = rests_.parts().empty() ? presses_ : rests_;
  double sum = 0;
  for (const Eigen::VectorXd& r : unseen.left(added)) sum += std::log(size(r));
  return sum / std::max<double>(1, static_cast<double>(unseen.parts().size()));
}

bool Judge::admits(const Foretold& f) const {
  return f.rest_fall >= kForetoldFall && !(f.press_fall < gates_.held_out_fall) &&
         f.chance() < gates_.p_value;
}

std::string unseen_by(const Dataset& dataset, int folds) {
  const std::string by = make_folds(dataset, folds).by;
  return "rest of each press" + (by.empty() ? "" : " and " + by);
}

}  // namespace hapsim
