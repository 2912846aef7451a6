// The flags of hs-simulate.
#pragma once

#include "cli/shared_flags.h"

namespace hapsim {

namespace flag {
inline constexpr ForceFlag add_noise{"--add-noise"};
inline constexpr IntegerFlag seed{"--seed"}, tools{"--tools"};
inline constexpr SwitchFlag own_mesh{"--own-mesh"}, full{"--full"},
    force_control{"--force-control"}, torques{"--torques"}, live{"--live"},
    uncertainty{"--uncertainty"}, large_strain{"--large-strain"};
inline constexpr ChoiceFlag solver{"--solver"}, binary{"--binary"};
inline constexpr TextFlag vtu{"--vtu"}, rows{"--rows"};
inline constexpr FileFlag contacts{"--contacts"}, markers_out{"--markers-out"};
inline constexpr NumberFlag rate{"--rate"}, torque_noise{"--add-torque-noise"};
inline constexpr LengthFlag marker_noise{"--add-marker-noise"};
}  // namespace flag

}  // namespace hapsim
