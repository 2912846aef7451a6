// What must hold before an effect is called missing: every number of the verdict, in one list.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace hapsim {

struct Gates {
  double criterion_gain = 10;   // fall of the information criterion (Kass and Raftery, 1995)
  double held_out_fall = 0.02;  // relative fall of the error on unseen positions
  double p_value = 0.05;        // family-wise, sign flips of whole presses
  double share = 0.15;          // of the squared misfit beyond noise that the effect takes away
  double rival_fall = 0.9;      // a rival with this share of the best held-out fall is as good
  int most_effects = 4;
};

// From here on an effect's size may speak for it: of the squared misfit, and of the error on unseen
// positions.
inline constexpr double kMostOfIt = 0.5, kPlainFall = 0.1;

// Rivals' errors that differ by less are alike.
inline constexpr double kAlike = 1.25;

// Errors of less than this times the noise are noise alone.
inline constexpr double kLikeNoise = 1.1;

// Where the winner leaves white noise and nothing else (fewer than kLikeWhite samples to an
// independent one), the likelihood can be believed: a rival that is so much less likely (of the
// criterion, by independent sample) is none, however alike the errors.
inline constexpr double kNoRival = 50, kLikeWhite = 1.5;

// Fewer presses have too few signs to flip; sets of effects are then judged by an F test of this
// level, all effects tried counted.
inline constexpr std::size_t kLeastPresses = 6;
inline constexpr double kFewPressesLevel = 0.01;

// The gates in words, with their numbers: paragraphs of --help and the man page.
std::vector<std::string> gates_in_words();

}  // namespace hapsim
