#include "diagnose/gates.h"

#include <fmt/format.h>

namespace hapsim {
namespace {

std::string counted_in_words(std::size_t count) {
  constexpr const char* kWords[] = {"none", "one", "two",   "three", "four",
                                    "five", "six", "seven", "eight", "nine"};
  return count < std::size(kWords) ? kWords[count] : std::to_string(count);
}

}  // namespace

std::vector<std::string> gates_in_words() {
  const Gates gates;
  const std::string least = counted_in_words(kLeastPresses);
  return {
      fmt::format(
          "Refits the model, tries every effect of the catalogue on top of it, and ranks them by "
          "the "
          "information criterion of true refits. An effect is called missing when the criterion "
          "gains more than {:g}, the error on contact positions left out of the fit falls by at "
          "least {:g} %, the chance of a false alarm (signs of whole presses flipped, all effects "
          "tried counted) is below {:g} %, and it takes away at least {:g} % of the squared misfit "
          "beyond noise. Where few presses carry an effect that takes away {:g} % of the misfit "
          "and {:g} % of the error on unseen positions, its size may speak for it instead of the "
          "presses' signs. Effects that do equally well (at least {:g} % of the best one's fall on "
          "unseen positions, and errors within {:g} %) are called indistinguishable, unless the "
          "winner leaves white noise and the rival is far less likely (by more than {:g} of the "
          "criterion). What changes the forces by less than an approximate law in the model may "
          "leave (hs-effects(7)) is possible at most. The search goes on, on top of what was "
          "found, "
          "up to {} effects; what was found before and is no longer needed then is dropped. Beside "
          "regions, other effects are judged on unseen positions with the boundary and the "
          "regions' "
          "places known: they are made from the positions and err most there.",
          gates.criterion_gain, 100 * gates.held_out_fall, 100 * gates.p_value, 100 * gates.share,
          100 * kMostOfIt, 100 * kPlainFall, 100 * gates.rival_fall, 100 * (kAlike - 1), kNoRival,
          gates.most_effects),
      fmt::format(
          "Fewer than {} presses have too few signs to flip, so they are judged by their course in "
          "time: sets of effects are grown side by side and ranked as above by independent "
          "samples, "
          "and an effect of the best set is missing when the set without it errs more than chance "
          "allows (F test, all effects tried counted, {:g} %). That says nothing of other places, "
          "and regions and offsets by press need {} presses.",
          least, 100 * kFewPressesLevel, least)};
}

}  // namespace hapsim
