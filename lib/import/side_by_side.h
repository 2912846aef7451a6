// Several curves in one table, side by side: specimens, or the way in and the way out of one press.
#pragma once

#include <string>

#include "tables/raw_table.h"

namespace hapsim {

// The same curves below each other, `block` telling the specimens apart and a column "source" which
// columns they come from: "Load", "Load'"; "Load 1", "Load 2"; "Extend Force", "Retract Force" (the
// two halves of one press). Columns that all share are repeated. `specimen` takes one of them,
// counted from 1. The table as it is where there is one curve. Error(kBadInput) where several
// columns may be the force and one travel does not tell which (the mend is --column), and where the
// specimen is not there.
RawTable unfold(const RawTable& table, const std::string& specimen);

}  // namespace hapsim
