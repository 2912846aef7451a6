// The flags of hs-scan2ply.
#pragma once

#include "cli/shared_flags.h"

namespace hapsim {

namespace flag {
inline constexpr LengthFlag spacing{"--spacing"}, most_drift{"--most-drift"},
    most_shift_error{"--most-shift-error"}, tip_radius{"--tip-radius"}, bar{"--bar"},
    pitch{"--pitch"}, standoff{"--standoff"}, height{"--height"},
    section_distance{"--section-distance"};
inline constexpr ForceFlag touch_force{"--touch-force"};
inline constexpr PressureFlag touch_modulus{"--touch-modulus"};
inline constexpr PoseFlag mount{"--mount"}, object{"--object-frame"};
inline constexpr LengthsFlag range{"--range"}, region{"--area"};
inline constexpr NumberFlag touch_stiffness{"--touch-stiffness"}, touch_nu{"--touch-nu"},
    steepest{"--steepest"}, threshold{"--threshold"};
inline constexpr SwitchFlag keep_outliers{"--keep-outliers"}, ascii{"--ascii"},
    register_{"--register"}, flat_tip{"--flat-tip"}, check{"--check"}, below{"--below"},
    all_parts{"--all-parts"}, cavities{"--cavities"}, sections{"--sections"};
inline constexpr TextFlag fix_zone{"--fix-zone"}, root{"--root"}, tip{"--tip-link"}, beam{"--beam"};
inline constexpr ChoiceFlag unit{"--unit"}, angle_unit{"--angle-unit"}, plan{"--scan-plan"};
inline constexpr FileFlag zone{"--zone"}, robot{"--robot"};
}  // namespace flag

}  // namespace hapsim
