// The loop: diagnose a model, add what is missing, refit, until nothing more is found.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "diagnose/candidate.h"
#include "experiment/unseen_band.h"

namespace hapsim {

struct ImproveOptions {
  DiagnoseOptions diagnose;
  FitOptions fit;  // of each model that is kept
  int most_diagnoses = 4;
  std::function<void(const std::string&)> progress;  // what is being done
};

// A model version: the one before it and one more effect.
struct ImprovementStep {
  std::string added;  // "" for the first
  Fit fitted;
  ForceError held_out;  // NaN when there is nothing to hold out
  UnseenBand band;
};

struct Improvement {
  std::vector<ImprovementStep> steps;  // the last one is the result
  Diagnosis last;                      // of the result, or of the model that could not be improved
  std::string refused;   // an effect that was called missing but did not help on what is unseen
  bool by_rest = false;  // judged on the rest of each press, there being few
  std::string unseen;    // what judged: "positions", "rest of each press"; "": there was nothing
  bool stopped = false;  // by the watch of the fits; the last step is the last that was finished,
                         // or the first fit as far as it came
};

// Thesis 5.5, with the diagnosis deciding what to add: an effect stays only when the error on
// whole positions (presses, when there is one position) that the fit has not seen falls by the
// gate of the diagnosis; of few presses, what is missing stays together when it foretells their
// rest (diagnose/foretold.h). Of effects that the data cannot tell apart none is added but a
// learned field, which states no cause; nor of those that few presses make possible any but a
// learned curve that foretells. `draft` is `fine` with ExperimentOptions::draft, for the
// diagnosis. A start without parameters is elastic. Error(kNoConvergence) when the first model does
// not fit.
Improvement improve(const Model& start, const Experiment& fine, const Experiment& draft,
                    const ImproveOptions& options);

}  // namespace hapsim
