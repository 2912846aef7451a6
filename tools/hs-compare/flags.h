// The flags of hs-compare.
#pragma once

#include "cli/shared_flags.h"

namespace hapsim {

namespace flag {
inline constexpr FileFlag simulated{"--simulated"}, html{"--html"}, figures{"--figures"},
    ply{"--ply"}, inside{"--inside"}, history{"--history"}, diagnosis{"--diagnosis"},
    junit{"--junit"}, events{"--events"}, simulated_markers{"--simulated-markers"};
inline constexpr LengthFlag reach{"--reach"};
inline constexpr TextFlag title{"--title"}, fail_above{"--fail-above"};
inline constexpr SwitchFlag follow{"--follow"}, hold{"--keep-model"};
inline constexpr NumberFlag rate{"--rate"}, false_alarms{"--false-alarms"};
inline constexpr TimeFlag learning{"--learning"};
}  // namespace flag

}  // namespace hapsim
