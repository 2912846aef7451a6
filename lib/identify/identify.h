// A model from recordings of presses: the fit, or the search for what it lacks, and the errors that
// are told of it.
#pragma once

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "cli/summary.h"
#include "diagnose/improve.h"
#include "experiment/unseen_band.h"
#include "fit/fit_request.h"
#include "identify/given_recordings.h"

namespace hapsim {

struct IdentifyRequest {
  FitRequest fit;
  int regions = kAutomaticRegions;  // ExtendOptions::regions
  // Noise and floor are the experiment's; skip, after_start and profile are of the last fit alone.
  // So are marked points: options.markers is of the last fit alone.
  FitOptions options;
  int folds = 6;  // parts that are held out in turn; below 2: no error on unseen data

  // Each may be empty.
  std::function<void(const std::string&)> say;   // FitRequest::say, and the steps of an improvement
  std::function<void(const std::string&)> tell;  // what an improvement is doing
  std::function<void(const std::string&, std::size_t, std::size_t)> progress;  // of a diagnosis
  std::function<void(std::vector<Model>&)> starts;  // may refuse them, or add one
  std::function<Fit(const Fit&)> refine;            // a better one of what was fitted
  // Of an improvement, all but the last; with Identification::force_rms.
  std::function<void(const ImprovementStep&, const std::string& unseen_by, double force_rms)> step;
  std::function<bool()> interrupted;
  std::function<bool()> end;  // nothing is waited for any more; whether it was interrupted
};

struct Identification {
  Fit fitted;  // Fit::stopped: the best so far, and nothing else is known
  double unseen = std::numeric_limits<double>::quiet_NaN();  // error on data left out [N]
  std::string unseen_by;  // what was left out: "positions"; "" where nothing could be
  UnseenBand band;        // at other places
  double force_rms = 0;   // of the measured forces [N]
  std::string ended;      // why it was not improved further
  std::string cut_short;  // what an interruption ended: "the model was improved"
};

// How every fit but the last is made.
FitOptions each_fit(const IdentifyRequest& request, const Experiment& w);

// `w` was prepared by `options`; `body` is its first. The fitted model has its metadata
// (record_fit(), heldout, record_band(), interrupted). Error(kUsage): a profile
// of a robust loss or under constraints, constraints that the model cannot keep or that name what
// it has not (require_constraints()); Error(kBadInput): less was measured than is to be fitted;
// Error(kNoConvergence): the fit does not converge.
Identification identify(const IdentifyRequest& request, const TetMesh& body, const Experiment& w,
                        ExperimentOptions options);

// The same on a screen.
Summary identification_summary(const Identification& identification, const Experiment& w);

}  // namespace hapsim
