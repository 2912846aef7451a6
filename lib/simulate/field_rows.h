// Which samples of a recording fields are written of.
#pragma once

#include <string>
#include <vector>

#include "experiment/dataset.h"

namespace hapsim {

struct FieldRow {
  std::size_t row = 0;      // of the recording
  std::size_t episode = 0;  // and where that is in the dataset
  std::size_t sample = 0;   // within the episode
};

// The rows of `list` ("20,40", counted from 1); where it is empty, the deepest of each episode.
// Error(kUsage): what is no row of the recording.
std::vector<FieldRow> field_rows(const Dataset& dataset, const std::string& list);

}  // namespace hapsim
