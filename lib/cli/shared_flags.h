// The flags that several commands have.
#pragma once

#include "cli/flag.h"

namespace hapsim {

namespace flag {
inline constexpr FileFlag body{"--body"}, model{"--model"}, json{"--json"};
inline constexpr LengthFlag tool_radius{"--tool-radius"};
inline constexpr ForceFlag noise{"--noise"};
inline constexpr NumberFlag floor{"--floor"}, rim_edge{"--rim-edge"}, nu{"--nu"},
    accuracy{"--accuracy"};
inline constexpr IntegerFlag threads{"--threads"};
inline constexpr TextFlag cache{"--cache"};
inline constexpr TimesFlag times{"--times"};
}  // namespace flag

}  // namespace hapsim
