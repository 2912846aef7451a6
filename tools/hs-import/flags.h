// The flags of hs-import.
#pragma once

#include "cli/shared_flags.h"

namespace hapsim {
namespace flag {
inline constexpr TextFlag unit{"--unit"}, force_unit{"--force-unit"}, time_unit{"--time-unit"},
    split_by{"--split-by"}, direction{"--direction"}, column{"--column"}, names{"--names"},
    encoding{"--encoding"}, specimen{"--specimen"}, part{"--part"};
inline constexpr ChoiceFlag contact{"--contact"}, tip{"--tip"}, force{"--force"},
    estimate_noise{"--estimate-noise"}, tool{"--tool"}, decimal{"--decimal"};
inline constexpr TextFlag topic{"--topic"};
inline constexpr SwitchFlag list{"--list"}, tip_motion{"--tip-motion"}, drop_air{"--drop-air"},
    yes{"--yes"};
inline constexpr LengthsFlag at{"--at"}, block{"--block"};
inline constexpr FileFlag surface{"--surface"}, scan{"--scan"};
inline constexpr NumberFlag rate{"--rate"};
}  // namespace flag
}  // namespace hapsim
