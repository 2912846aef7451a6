#include "experiment/unseen_band.h"

#include <fmt/format.h>

#include "base/error.h"
#include "io/number.h"

namespace hapsim {
namespace {

constexpr const char* kShareKey = "unseen_band";
constexpr const char* kChanceKey = "unseen_chance";

}  // namespace

void record_band(const UnseenBand& band, Metadata& metadata) {
  metadata.remove(kShareKey);
  metadata.remove(kChanceKey);
  if (!band.known()) return;
  metadata.set(kShareKey, format_number(band.share));
  metadata.set(kChanceKey, format_number(band.chance));
}

UnseenBand recorded_band(const Metadata& metadata, const std::string& name) {
  UnseenBand band;
  const auto share = metadata.find(kShareKey), chance = metadata.find(kChanceKey);
  if (!share || !chance) return band;
  if (!parse_number(*share, band.share) || !parse_number(*chance, band.chance) ||
      !(band.share >= 0) || !(band.chance > 0 && band.chance < 1))
    fail_input(name, fmt::format("metadata {} and {} are no shares", kShareKey, kChanceKey),
               "take both lines out, or identify the model again");
  return band;
}

std::string band_words(const UnseenBand& band) {
  return fmt::format(
      "at places not pressed, among these, within {:.3g} % (rms of a place) with a chance of "
      "{:.3g} "
      "%",
      100 * band.share, 100 * band.chance);
}

}  // namespace hapsim
