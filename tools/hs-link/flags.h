// The flags of hs-link.
#pragma once

#include "cli/shared_flags.h"

namespace hapsim {

namespace flag {
inline constexpr TextFlag listen{"--listen"}, peer{"--peer"};
inline constexpr IntegerFlag samples{"--samples"}, seed{"--seed"};
inline constexpr NumberFlag rate{"--rate"}, loss{"--loss"}, duplicate{"--duplicate"},
    reorder{"--reorder"};
inline constexpr FileFlag identified{"--identified"}, key{"--key"}, make_key{"--make-key"},
    expect_model{"--expect-model"};
inline constexpr SwitchFlag insecure{"--insecure"};
inline constexpr TimeFlag delay{"--delay"}, jitter{"--jitter"}, idle{"--idle"},
    patience{"--patience"};
inline constexpr ForceFlag add_noise{"--add-noise"};
}  // namespace flag

}  // namespace hapsim
