// The filter's parameters as a table.
#pragma once

#include <array>
#include <ostream>

#include "fusion/fusion.h"
#include "io/stream.h"

namespace hapsim {

// What is learned and written of each component.
struct FusionEntry {
  const char* name;
  const char* unit;
  double AxisFusion::*value;
  double lower, upper;
};
inline constexpr std::size_t kLearned = 9;  // the first ones
const std::array<FusionEntry, 10>& fusion_entries();

// The table parameter,axis,value,unit. Error(kBadInput) with line: an unknown one, out of bounds.
FusionParameters read_fusion(Input& input);
void write_fusion(std::ostream& out, const FusionParameters& parameters);

}  // namespace hapsim
