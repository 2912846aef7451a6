// A comparison in short sentences: what hs-compare says, and the top of its report.
#pragma once

#include <string>
#include <vector>

#include "cli/summary.h"
#include "compare/comparison.h"
#include "compare/report_curves.h"

namespace hapsim {

std::string newtons(double force);                      // "0.0468 N"
std::string percent_of(double part, double whole);      // "3.5 %"; "-" of nothing
std::string times_noise(const Comparison& comparison);  // "1.2"; "?" where the noise is unknown

// The typical error is within 15 % of what noise and meshes make; of noise alone, and no structure
// was found besides.
bool within_doubt(const Comparison& comparison);
bool only_noise_left(const Comparison& comparison);

// The typical error beside the force and the noise, in one sentence.
std::string verdict_line(const Comparison& comparison);

// The comparison on a screen: sizes, noise, the error of each of several versions, what the error
// depends on, and the three worst positions.
Summary comparison_summary(const Comparison& comparison, const Recording& measured,
                           const std::vector<SimulatedVersion>& versions);

}  // namespace hapsim
