// Presses as a recording: numbers of the presses, samples in the air, noise, metadata, carried
// columns.
#pragma once

#include <vector>

#include "import/import.h"
#include "import/press_track.h"

namespace hapsim {

// Fills result.recording and result.touched from tracks whose contact is placed; adds notes on what
// was left out (saturated forces, samples in the air when options.drop_air) and on sizes that look
// wrong.
void assemble(const RawTable& table, const ColumnMap& map, const Samples& samples,
              const ImportOptions& options, const std::vector<PressTrack>& tracks,
              ImportResult& result);

}  // namespace hapsim
