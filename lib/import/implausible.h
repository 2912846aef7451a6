// Sizes that say that a unit is wrong by a factor of a thousand.
#pragma once

#include "import/import.h"
#include "import/samples.h"

namespace hapsim {

// Error(kBadInput) that names the factor which would mend it, where a length or force whose unit
// nothing names makes the deepest press, the largest force, the body (options.block) or the modulus
// of a flat tool of options.tool_radius implausible (below 100 Pa, above 10 GPa). With
// options.units.trusted, and where the units are named, a warning.
void check_plausible(const Recording& recording, const Samples& samples,
                     const ImportOptions& options, Notes& notes);

// Error(kUsage) where a block has a side beyond 1 m, or a tool a radius beyond 0.1 m: lengths in mm
// without their unit.
void check_sizes_given(const ImportOptions& options);

}  // namespace hapsim
