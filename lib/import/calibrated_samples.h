// The forces of a foreign table, put right by the rig's calibration.
#pragma once

#include "import/samples.h"
#include "rig/correct.h"
#include "tables/raw_table.h"

namespace hapsim {

// In place, before contact is looked for; what was done goes to the facts, what could not be to the
// warnings. The tool's orientation is read from the table's columns (rig/orientation.h), or its
// metadata. Error(kBadInput): a table that was corrected before, or has no vector of force.
void calibrate_samples(const RawTable& table, const Calibration& calibration, Samples& samples,
                       Notes& notes);

}  // namespace hapsim
