// What an on-line identification is asked for, and what comes of it: a model, words, and rows of a
// table.
#pragma once

#include <string>
#include <vector>

#include "model/model.h"
#include "watch/online_identification.h"

namespace hapsim {

// Relaxation times [s], each a number, kMostUnknowns - 1 at most. Error(kUsage) beginning with
// `option`.
std::vector<double> parse_relaxation_times(const std::vector<std::string>& texts,
                                           const std::string& option);

// A body of unit modulus, as UnitResponse needs it.
Model unit_model(double nu);

// The model that was found: E with its standard error, nu as it was given, and a term a relaxation
// time.
Model identified_model(const OnlineEstimate& found, const std::vector<double>& times, double nu);

// "E = 1e+04 Pa ± 20, 3e+03 Pa at 0.5 s": `digits` of those that relax.
std::string moduli_words(const OnlineEstimate& found, const std::vector<double>& times, int digits);

// A line of estimates: t,rows,E,E_std[,E1,E1_std...],rmse. What is not known stays empty.
std::vector<std::string> estimate_columns(std::size_t relaxation_times);
std::vector<std::string> estimate_row(double t, long rows, const OnlineEstimate& estimate);

}  // namespace hapsim
