// Which effect of a round is to be added, and which do as well.
#pragma once

#include <cstddef>
#include <vector>

#include "diagnose/try_effects.h"

namespace hapsim {

// Whether the finding passes the gates. Without positions or presses to hold out, the other gates
// decide.
bool passes(const Finding& finding, const Gates& gates, bool can_hold_out);

// The effect to add: of those that pass the gates the one with the largest gain; as many as there
// are findings: none does. Offsets of each press imitate any misfit in part, at the price of many
// parameters, and come after all else.
std::size_t best_of(const Round& round, const Gates& gates, bool can_hold_out);

// Rivals that do as well as the best: another effect that passes the gates too and reaches nearly
// the same fall, unless one of the two includes the other. `allowed`: error that noise, mesh and
// shape leave [N].
std::vector<std::size_t> rivals_of(std::size_t best, const Round& round, const Gates& gates,
                                   bool can_hold_out, double allowed);

}  // namespace hapsim
