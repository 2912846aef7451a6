// What the presses of a recording have asked of a body, and what they have not.
#pragma once

#include <string>
#include <vector>

#include "diagnose/diagnose.h"

namespace hapsim {

// A motion that no press so far made and without which some effect cannot show, though nothing says
// so of it: an effect of time is tried wherever there are times.
struct LackingMotion {
  std::string what;      // "no press is held"
  std::size_t turn = 0;  // the path that makes up for it (path_in_turn())
};

// A push sideways, a way out; with times a hold of a second and a second pace, three times another.
std::vector<LackingMotion> lacking_motions(const Dataset& dataset);

struct Coverage {
  std::size_t presses = 0;
  std::size_t places = 0;  // a tool's radius apart
  std::vector<LackingMotion> lacking;
};
// So many places must be pressed before a verdict holds: the diagnosis holds out six parts of them,
// and what differs from place to place shows on places that were held out.
constexpr std::size_t kSettledPlaces = 6;

Coverage coverage_of(const Dataset& dataset);
// How many of them lie `apart` [m] from each other, taken in their order.
std::size_t places_apart(const std::vector<Vec3>& positions, double apart);

// An effect of which a verdict says nothing, and what the recording lacks to test it.
struct UntestedEffect {
  std::string effect, lack;
};
std::vector<UntestedEffect> untested_effects(const Diagnosis& diagnosis);

}  // namespace hapsim
