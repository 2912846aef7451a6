// Fitting a model's free parameters to a recording, and the error on presses it has not seen.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "estimate/expression.h"
#include "estimate/robust.h"
#include "experiment/markers.h"
#include "experiment/torques.h"
#include "experiment/weights.h"

namespace hapsim {

constexpr int kFullRounds = 30;

// Where a fit stands.
struct FitProgress {
  int start = 0, starts = 1;  // of several starts, from 0
  // Least so far [N], after the weights of a robust loss.
  double rmse = std::numeric_limits<double>::quiet_NaN();
};

struct FitOptions {
  double noise = 1;           // standard deviation of the force noise [N]
  double floor = 0;           // relative gain error by position (mesh and geometry)
  bool exact_regions = true;  // solve inhomogeneous bodies anew; false: first-order stiffness
  int starts = 1;             // more: a Latin hypercube besides the given start (spread in fit.cpp)
  int skip = 0;               // so many of them are done: an earlier search gave the start
  std::uint64_t seed = 1;     // of the starts
  RobustLoss robust = RobustLoss::kNone;
  // Bodies with features are solved anew in up to so many rounds, until one changes the sum of
  // squares by less than the share `settled`; 0: not at all (about what is known, the rest
  // estimated).
  int rounds = kFullRounds;
  double settled = 1e-6;
  bool keep_apart = true;  // relaxation times that coincide are moved apart (keep_terms_apart())
  // The lengths and nuggets of a field that the start has learned hold; false: learned anew.
  bool keep_scales = false;
  // Kept by the fit where the model has all their names (fit/constraints.h); the others are not
  // asked. Relaxation times are then sorted where that keeps them, and not moved apart.
  std::vector<Relation> constraints;
  // Measured torques of the tool count beside the forces, each with its own noise, where the model
  // says what they are (fit/torque_rows.h).
  bool torques = false;
  // Displacements of marked points count beside the forces, where the model says what they are
  // (fit/marker_rows.h). Null: none. Matched with the experiment that is fitted.
  const Markers* markers = nullptr;
  // Sizes that finite elements are solved for and that are hardly known have standard errors by the
  // profile of their likelihood, solved anew along it: some fifteen solutions (fit/ridge.h); where
  // nothing is solved anew the others have so, where one is at its bound or may be there
  // (fitting_bounds.cpp). Not under constraints or a robust loss.
  bool ridges = false;
  bool profile = false;  // fill in `intervals`: some twenty fits a parameter; without `robust` only
  // Asked again and again; false ends the fit with what there is. May be empty.
  std::function<bool(const FitProgress&)> watch;
  // Told every model that the fit has come to, and its error [N]: what is there if it has to end at
  // once. May be empty.
  std::function<void(const Model&, double rmse)> keep;
  // Between two of several starts: the best so far, and how many of `starts` are done. May be
  // empty.
  std::function<void(const Model& best, int starts_done)> after_start;
};

// A constraint of a fit, and what it does to it.
struct KeptConstraint {
  std::string text;
  bool active = false;  // it holds with equality, and the fit would leave it
  // Of an active one: by how much the error (ForceError::told(), after the weights of a robust
  // loss) would fall if this one alone were left out, the others and the bounds staying, to second
  // order (UnderConstraints::worth) [N]; and the square root of that fall of the sum of squares
  // over its variance: by so many standard errors the data contradict it (Wald, 1943). Exact where
  // forces and constraint are linear. NaN where not known.
  double cost = std::numeric_limits<double>::quiet_NaN();
  double doubt = std::numeric_limits<double>::quiet_NaN();
};

struct Fit {
  Model model;          // values, standard errors
  Linearisation about;  // of the bodies, for the model's material
  ForceError error;     // on what was fitted
  bool converged = false;
  bool stopped = false;  // by the watch; never converged then
  int starts_done = 0;   // of FitOptions::starts, the skipped ones among them
  std::string message;
  Eigen::Index residuals = 0;
  std::vector<std::string> at_bound;      // "elastic nu"
  std::vector<std::string> undetermined;  // parameters that the data cannot tell
  std::vector<std::string> blind;         // "E and E1 enter only as their sum"
  std::vector<std::string> intervals;     // profile likelihood, 95 %, in words
  std::vector<KeptConstraint> constraints;
  std::vector<std::string> held;  // parameters to which active constraints leave no freedom
  double unconstrained = std::numeric_limits<double>::quiet_NaN();  // told error without them [N]
  int discounted = 0;  // force components that the robust loss halves or drops
  TorqueError torque;  // on what was fitted; no rows where torques did not count
  MarkerError marker;  // the same of marked points
};

// A model as it is, its bodies solved.
Fit as_it_is(const Model& model, const Experiment& experiment);

// Stacked forces of a fitted model, and their derivatives when asked.
Signal model_forces(const Fit& fitted, const Experiment& experiment, const Selection& selection,
                    bool derivatives);

// Fits on the chosen episodes by least squares of the forces. Standard errors come from the noise
// (or the misfit, where that is larger), from the gain error `floor` of each position and from one
// of that size of all. The bodies are solved again as FitOptions says; `known`: what a fit that
// solves nothing stands on. Constraints are asked for where the fit without them breaks one
// (minimise_under()), from its end; standard errors are then along what the active ones leave free.
// Contradictory ones: not converged.
Fit fit(const Model& start, const Experiment& experiment, const Selection& selection,
        const FitOptions& options, const Linearisation& known = {});

// From an estimate made from the `starts`, finite elements solved. Estimates are of first order and
// may have led away from where they began: where much is left, from the nearest start as well.
Fit fit_solved(const Model& estimate, const std::vector<Model>& starts,
               const Experiment& experiment, const Selection& selection, const FitOptions& options);

// The best of several starts, from which the search of FitOptions::starts begins.
Fit fit_best(const std::vector<Model>& starts, const Experiment& experiment,
             const Selection& selection, const FitOptions& options,
             const Linearisation& known = {});

// Whole positions (or, with a single position, whole presses) left out in turn.
struct Folds {
  std::vector<Selection> held_out;
  std::string
      by;  // "positions", "presses" or "" when nothing can be held out (one press, one part)
};
Folds make_folds(const Dataset& dataset, int count);
// Presses at positions that were pressed otherwise too: of each position's at most one is left out
// at a time. Says nothing of other positions.
Folds make_press_folds(const Dataset& dataset, int count);

// The starts of a model, and what fits that solve nothing stand on.
struct Starts {
  std::vector<Model> models;
  Linearisation known;
};
// Builds them from the episodes it may see; asked by several threads at once.
using ModelBuilder = std::function<Starts(const Selection& training)>;

struct HeldOut {
  ForceError error;                // over all held-out rows; NaN when nothing could be held out
  std::vector<double> squares;     // sum of squares by fold [N^2]
  std::vector<double> components;  // 3 x rows by fold
  std::vector<double> by_place;    // sum of squares by position [N^2]
  // What was foretold, stacked as measured_forces() of all episodes [N]; NaN of those that no fold
  // holds.
  Eigen::VectorXd forces;
};
// Truly refitted for every fold, several at once; bodies with features stay linear about what is
// known. The watch is asked on the calling thread alone.
HeldOut held_out_error(const ModelBuilder& builder, const Experiment& experiment,
                       const Folds& folds, const FitOptions& options);

}  // namespace hapsim
