// How far the forces of a model may be off at places that were never pressed.
#pragma once

#include <limits>
#include <string>

#include "io/metadata.h"

namespace hapsim {

// At a place like those that were pressed, among them, the root mean square error of the model's
// forces is at most `share` of the force's, the noise aside, with this chance.
struct UnseenBand {
  double share = std::numeric_limits<double>::quiet_NaN();  // NaN: nothing is known
  double chance = 0;
  bool known() const { return share == share; }
};

// As a model's metadata unseen_band and unseen_chance, and from there. Error(kBadInput) with the
// model's name: they are no shares.
void record_band(const UnseenBand& band, Metadata& metadata);
UnseenBand recorded_band(const Metadata& metadata, const std::string& name);

// "at places not pressed, among these, within 8.3 % (rms of a place) with a chance of 95 %".
std::string band_words(const UnseenBand& band);

}  // namespace hapsim
