// The flags of hs-identify.
#pragma once

#include "cli/shared_flags.h"

namespace hapsim {

namespace flag {
inline constexpr TimeFlag until{"--until"};
inline constexpr FileFlag image{"--image"}, lumps{"--lumps"}, library{"--library"},
    diagnosis{"--diagnosis"}, history{"--history"}, locations{"--locations"}, field{"--field"},
    curves{"--curves"}, data{"--data"};
inline constexpr TextFlag material{"--material"}, object{"--object"}, effects{"--effects"},
    add{"--add"}, remove{"--remove"}, fix{"--fix"}, free{"--free"}, constrain{"--constrain"},
    region_names{"--region-names"}, terms{"--terms"}, regions{"--regions"};
inline constexpr TimesFlag windows{"--windows"};
inline constexpr IntegerFlag acfm{"--acfm"}, folds{"--folds"}, every{"--every"}, memory{"--memory"},
    boundary{"--refine-boundary"}, starts{"--starts"}, seed{"--seed"};
inline constexpr SwitchFlag stiffening{"--stiffening"}, profile{"--profile"}, follow{"--follow"},
    resume{"--resume"}, ignore_torques{"--ignore-torques"};
inline constexpr ChoiceFlag robust{"--robust"};
}  // namespace flag

}  // namespace hapsim
