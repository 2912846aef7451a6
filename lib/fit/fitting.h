// One fit under way.
#pragma once

#include <optional>
#include <vector>

#include "estimate/least_squares.h"
#include "estimate/under_constraints.h"
#include "fit/fit.h"
#include "fit/marker_rows.h"
#include "fit/ridge.h"
#include "fit/torque_rows.h"

namespace hapsim {

// The model as far as it has come, and the bodies about its material.
class Fitting {
 public:
  Fitting(const Model& start, const Experiment& experiment, const Selection& selection,
          const FitOptions& options, const Linearisation& known,
          const std::vector<SmoothConstraint>& constraints = {});

  void search();
  // What is told of where the search has ended.
  Fit end();

  // Where it has ended, before that.
  const Model& model() const { return result_.model; }
  const Linearisation& about() const { return result_.about; }
  bool stopped() const { return result_.stopped; }
  bool converged() const { return solution_.converged && !result_.stopped; }
  double told_error() const;

 private:
  void minimise_all();
  // The field that the places ask for beside all else, and all else beside that field, in turn.
  void minimise_with_field();
  // Residuals over the noise, and their derivatives, of the model with these values.
  ResidualFunction residuals_of(Model model) const;
  // Of the residuals, forces, torques and points.
  Eigen::Index rows() const { return measured_.size() + torques_.size() + marked_.size(); }
  // Tells the watch; false when the fit is to end.
  bool go_on(double sum);
  void keep_search(const LeastSquaresResult& best, int starts_done) const;
  std::vector<Unknown> open_within(double reach) const;
  void take(LeastSquaresResult solution);
  // From many starts, once: later rounds improve on the valley found.
  void search_valleys();
  // Within the bounds, and the constraints where there are any.
  LeastSquaresResult solve(const std::vector<Unknown>& open, const ResidualFunction& residuals,
                           const LeastSquaresOptions& search = {});
  // All unknowns; those that the body is linear in by no more than `reach` (within_reach()).
  void minimise_within(double reach);
  // The sum of squares with the bodies solved for the model's material. What needs no solution is
  // fitted anew: a modulus too large or too small for a new body must not hide that the body has
  // become better.
  double solved_sum();
  // The finite elements are solved again about each fit; a fit that their solution does not confirm
  // is taken back and tried again closer by (a trust region).
  void minimise_in_rounds();
  // What the parameters follow of a gain of `floor` that all positions share: mesh, surface and
  // tool err alike everywhere too, and that no number of positions averages away (on bodies of
  // another solver all of E was 0.2 to 1.8 % off). One position has it in its own.
  // `bread`: the covariance by noise alone, of the forces as they are weighed.
  Eigen::VectorXd by_gain_of_all(const Signal& signal, const Eigen::MatrixXd& bread) const;
  // FitOptions::ridges, once all else is told (fitting_ridge.cpp). False: a better fit was met on
  // the way, and result_ is there.
  bool tell_ridges(const Signal& signal, const FitOptions& errors, double variance);
  bool tells_profiles() const;
  std::vector<Eigen::Index> ridges(const Eigen::MatrixXd& covariance) const;
  // Of all free parameters, as if none had bounds.
  struct Covariance {
    Eigen::MatrixXd bread, whole;  // by noise alone, and with all that `errors` says
  };
  Covariance beyond_bounds(const Signal& signal, const FitOptions& errors, double variance) const;
  // What the standard errors of the others are more where a parameter is at its bound, or its
  // interval reaches there (fitting_bounds.cpp).
  struct Moved {
    Eigen::VectorXd by;  // all free parameters, the farthest each
    double until = 0;    // the parameter itself
  };
  Moved move_to(Eigen::Index which, double value, double most);
  void tell_bounds(const Signal& signal, const FitOptions& errors, double variance);
  // The ridge of a parameter of that error in its logarithm, from where result_ is, to a rise of
  // the sum of squares by `threshold`.
  Ridge walk(Eigen::Index which, double error, double threshold);
  // The least sum of squares with a parameter held at a value, from where result_ is, to `settled`;
  // goes there.
  double fit_beside(Eigen::Index which, double value, double settled);
  // Of samples that err alike all along a place or a press, n tell less than n. Standard errors are
  // at least those by the scores of whole groups (the sandwich of Liang and Zeger, Biometrika 73,
  // 1986), which ask nothing of how samples of one group err together.
  void widen_by_groups(const Signal& signal, const Eigen::VectorXd& residual);
  // Forces [N] over the noise, as they are weighed.
  template <class Rows>
  void whiten(Rows& rows) const {
    if (force_weights_)
      force_weights_->whiten(rows);
    else
      rows /= options_.noise;
  }
  // What the active ones cost, and what they leave to be known.
  void tell_constraints(const Eigen::MatrixXd& J, double variance);

  const Experiment& experiment_;
  const Dataset& dataset_;
  const Selection& selection_;
  const FitOptions& options_;
  const std::vector<SmoothConstraint> constraints_;
  const Eigen::VectorXd measured_;
  const bool has_offsets_, learns_field_;
  TorqueRows torques_;
  MarkerRows marked_;
  std::optional<Weights> force_weights_;
  bool is_linearised_ = false;
  FitProgress progress_;
  LeastSquaresOptions search_;
  bool from_many_;
  LeastSquaresResult solution_;
  UnderConstraints under_;  // of the last search, where there are constraints
  Fit result_;
  bool walked_on_ = false;  // a walk has led to a better fit
  double lowest_ = 0;       // the least rise of the last walk over its threshold's root, and where
  Fit lowest_at_;
};

}  // namespace hapsim
