// A fit in short sentences.
#pragma once

#include <string>
#include <vector>

#include "cli/summary.h"
#include "fit/boundary_fit.h"
#include "fit/maxwell_terms.h"
#include "fit/rest_of_press.h"

namespace hapsim {

// The fit on a screen: whether more than noise is left, the errors, the first twelve values with
// their standard errors, what was fitted to what, and what the data do not tell or make doubtful.
// `held_out` [N] on data left out by `by` ("positions"; "": none); `force_rms`: of the measured
// forces [N].
Summary fit_summary(const Experiment& experiment, const Fit& fitted, double held_out,
                    const std::string& by, double force_rms);

// What a body between plates is taken for: bonded to both, which is in its stiffness; and whether
// it is as high as those for which the law of finite strain was verified. "" where there are no
// plates.
std::string plates_words(const Model& model, const Experiment& experiment);

// What the recording's header says of effects (Effect::known()), where the model has it unfitted or
// lacks it.
std::vector<std::string> known_words(const Model& model, const Dataset& dataset);

// Moduli whose standard error is more than half their value, and a Poisson's ratio known to no
// better than half its range.
std::vector<std::string> hardly_known(const Model& model);

// How many terms were chosen, and the errors of each number that was tried.
std::string choice_words(const TermChoice& choice, const std::string& effect);

// How far the boundaries have moved, and how well they are known. `before`: the fit that was
// refined.
std::string boundary_words(const BoundaryFit& refined, const Fit& before);

// The error on the rest of each press, after `seconds`.
std::string later_words(const LaterError& error, double seconds);

}  // namespace hapsim
