#include "safety/flag_meanings.h"

#include "realtime/several_tools.h"
#include "safety/safe_force.h"

namespace hapsim {

std::map<std::string, std::vector<std::pair<int, std::string>>> live_flag_meanings() {
  return {{"beyond",
           {{kBeyondDepth, "deeper than fitted, or than half of the way through the body"},
            {kBeyondHeld, "held, as the tool would go through the body"},
            {kBeyondPlaces, "extrapolated, beside the support"},
            {kBeyondFitted, "away from the places that were fitted"},
            {kBeyondSpeed, "of a tool faster than was fitted"},
            {kBeyondLaw, "beyond the range that the law was verified to"},
            {kBeyondClose, "of two tools closer than they have room"}}},
          {"safety",
           {{kSafeForce, "cut in size"},
            {kSafeRate, "cut in its change"},
            {kSafePower, "cut in its power on the hand"},
            {kSafeOutside, "of a tool outside the workspace"},
            {kSafeInvalid, "of a sample that is no number, or beyond all bounds"},
            {kSafeHeld, "the last one, for want of a new sample"},
            {kSafeRamped, "on the way to zero, or zero, for want of new samples"},
            {kSafeEnded, "zero for good"},
            {kSafeEnergy, "damped, as the hand got more energy than it had put in"},
            {kSafeUnasked, "sent for want of a motion"}}}};
}

}  // namespace hapsim
