// What a trial's diagnosis said, row by row, beside what is true.
#pragma once

#include <string>

#include "diagnose/diagnose.h"
#include "summary.h"
#include "truths.h"

namespace hapsim::bench {

// What is said of each effect, and whether it is hidden, or what is hidden includes it: by which
// the probabilities are calibrated (probabilities.py).
void append_statements(const std::string& path, const Truth& truth, const Trial& trial,
                       const Diagnosis& diagnosis);

// How many of the sizes that were found hold the truth in their 95 % intervals, and to `path` each
// of them with its truth, the elastic ones besides (coverage.py). Not counted: orientations, which
// have twins (an axis and its reverse), another number of terms than the truth has, whose values
// are other ones, and what no interval is stated for (at a bound).
void count_sizes(const Model& found, const Model& truth, const Experiment& experiment,
                 const std::string& path, Trial& trial);

}  // namespace hapsim::bench
