// Laws of what the presses before have left behind.
#pragma once

#include <vector>

#include "diagnose/kind_laws.h"

namespace hapsim {

// Gains, and zeros, that differ from press to press by its number at its place, how long ago
// anything or this place was pressed, how deep the press before was (`cycle`) and the session's
// time
// (`session-time`), each also by depth, time since the press began or how far the force leans;
// gains by the deepest so far at the place, above it and below; zeros that go with where the tool
// came from and how it left there, fading (`cycle`).
void add_order_laws(const LawSamples& samples, std::vector<KindLaw>& laws);

}  // namespace hapsim
