// Effects with several terms (Maxwell elements): their relaxation times in order and apart, how
// many of them the data ask for, and what the data cannot tell of them.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "fit/extend.h"

namespace hapsim {

// Terms whose relaxation times differ by less than this factor are one term to any recording.
constexpr double kApart = 2;

// Terms numbered by ascending relaxation time. Values only: an effect whose terms differ in bounds
// or state keeps its order. True when something changed.
bool sort_terms(Model& model);

// A minimum with terms closer than kApart is solved for again under the constraint that they are
// not (thesis 5.4.2: disjoint intervals), by the constrained solver. `open`: the unknowns that gave
// `solution`, whose values the model has.
void keep_terms_apart(const Model& model, const std::vector<Unknown>& open,
                      const ResidualFunction& residuals, LeastSquaresResult& solution);

// Windows [low, high] of the relaxation times in seconds, thesis (5.40), one a term of `effect`:
// they become the bounds of its terms, and a value outside moves to the window's middle.
// Error(kUsage) when they overlap or do not ascend, or are not as many as the terms.
using TimeWindows = std::vector<std::pair<double, double>>;
void set_windows(Model& model, const std::string& effect, const TimeWindows& windows);

struct TermTrial {
  int terms = 0;
  ForceError held_out;   // on what the fit has not seen; NaN when nothing could be held out
  double criterion = 0;  // BIC = n log(sum of squares / n) + parameters log n (Schwarz, 1978)
  Fit fit;
};
struct TermChoice {
  std::vector<TermTrial> trials;  // one term, two, ... : one more than chosen, unless `most` is
  int terms = 0;                  // chosen
};

// One more term as long as it lowers the criterion by more than kWorthATerm and the held-out error.
TermChoice choose_terms(const Fit& base, const std::string& effect, int most,
                        const Experiment& experiment, const Selection& selection,
                        const FitOptions& fit_options, const ExtendOptions& options);
constexpr double kWorthATerm = 10;  // Kass and Raftery, J. Am. Statist. Assoc. 90, 1995

// Free relaxation times that these presses cannot tell, in words: with a standard error above a
// third, or longer than the longest press, which no press has seen the end of. A single term has a
// sentence in any case on what slower relaxation would be taken for.
std::vector<std::string> untold_times(const Model& model, const Dataset& dataset);

}  // namespace hapsim
