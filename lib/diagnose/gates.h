// What must hold before an effect is called missing: every number of the verdict, in one list.
#pragma once

#include <fmt/format.h>

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

// From here on an effect's size may speak for it: most of the squared misfit, and on unseen
// positions five times the fall that is asked where the presses' signs speak as well.
inline constexpr double kMostOfIt = 0.5, kPlainFall = 0.1;

// Rivals' errors that differ by less are alike: variances that differ by 1.25^2 are told apart from
// some 55 independent samples each on (the 95 % point of Fisher's F).
inline constexpr double kAlike = 1.25;

// Errors of less than this times the noise are noise alone: fifty samples give a deviation to a
// tenth.
inline constexpr double kLikeNoise = 1.1;

// What mesh and shape are allowed is strained where chance alone would do that to one recording in
// ten thousand: no search stands behind it.
inline constexpr double kStrained = 1e-4;

// Where the winner leaves no more than noise, mesh and shape may, and that white (fewer than
// kLikeWhite samples to an independent one), the likelihood can be believed: a rival that is so
// much less likely (of the criterion, by independent sample) is none, however alike the errors:
// five times what is asked of an effect, since nothing but the likelihood decides.
inline constexpr double kNoRival = 50, kLikeWhite = 1.5;

// An effect whose size differs by more between parts of one recording (root mean square, beyond
// chance), where more than noise is left, stands for something else.
inline constexpr double kOneSize = 0.25;

// Fewer presses have too few signs to flip (five, and all with one sign, are 1/16 by chance); sets
// of effects are then judged by what the first parts of the presses foretell of the rest, whose
// error has to fall by that share.
inline constexpr std::size_t kLeastPresses = 6;
inline constexpr double kForetoldFall = 0.05;

// A curve of no law stands in the place of names where it errs by less than that share of their
// error on what is unseen.
inline constexpr double kPlainlyLess = 0.9;

// So many names may stand for one thing that has none.
inline constexpr std::size_t kCrowd = 3;

// Where there are more places than that, so many of them tell first which effects are worth finite
// elements at all of them.
inline constexpr std::size_t kManyPlaces = 60, kScreened = 24;

// The gates in words, with their numbers: paragraphs of --help and the man page.
inline std::vector<std::string> gates_in_words() {
  const Gates gates;
  const std::string least = std::to_string(kLeastPresses);
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
          "winner leaves no more than noise, mesh and shape may, and that white, and the rival is "
          "far less likely (by more than {:g} of the "
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
          "Fewer than {} presses have too few signs to flip, so they are judged by prediction: "
          "sets of effects are grown side by side and ranked as above by independent samples, "
          "and an effect is missing when the set with it, learned from the first part of each "
          "press alone, foretells the rest with an error lower by {:g} % or more, and so much "
          "likelier that chance does as well in less than {:g} % (samples that err alike count "
          "as one); when whole presses that were left out of the fit, if there are several, "
          "err less by {:g} % or more; and when the criterion gains as above. The unseen error "
          "is that of these rests and presses. That says nothing of other places, and regions "
          "and offsets by press need {} presses.",
          least, 100 * kForetoldFall, 100 * gates.p_value, 100 * gates.held_out_fall, least),
      fmt::format(
          "What is left is then tested itself. Mesh and shape may err by the floor, a relative "
          "gain "
          "at each position. Where the gains that the forces ask for strain it (more than chance "
          "does once in {:g} recordings: all together, one that all positions share, or those of "
          "one "
          "position), and where what is left beside them is more than noise and neighbouring "
          "samples "
          "err alike, a model without missing effects is unexplained, and beside missing ones that "
          "is said: the names do not explain all; so are samples far off that come at one part of "
          "the "
          "presses. Where anything is left, a name is kept only if it takes more away than is left "
          "and if what it does has one size in the whole recording: one whose size differs by more "
          "than {:g} % between presses, depths, times since the press began or axes (root mean "
          "square, beyond chance) stands for another cause and is possible at most. What is left "
          "is told by laws of many kinds (a zero, depth, history, speed, phase, session, what the "
          "presses before left behind, mixed "
          "axes, the direction of the force, the reading of each axis, a stiffness of each "
          "place, gains or a zero of each press): they are fitted to it in two thirds of the "
          "presses and judged by the others (those of a press by other samples of it), and the "
          "share of the squares beyond noise that each foretells is told. The one that "
          "foretells most names the kind; of several that presses do not tell apart from it, "
          "which is said, the one with the fewest numbers does, if it foretells four fifths as "
          "much. An event of single samples, a line of frequency in the session or a part of "
          "it, and one position that errs alone come before them; where no kind foretells a "
          "tenth, a swing about one frequency is told, and else that something is left. Each "
          "effect has its kinds too (hs-effects(7)).",
          1 / kStrained, 100 * kOneSize),
      "A few presses (at most every fourth) are told by their numbers where all that is left is "
      "theirs: the model fitted without them leaves noise alone, others at their places are as it "
      "says, and so are others of like depth and slant, some no slower and some no faster, and "
      "they are not those that went furthest or fastest. A value a press (tare) is possible only "
      "where a set without "
      "it leaves noise alone or errs as little on what is unseen, within a tenth. Forces that are "
      "rounded "
      "to coarse steps count as so much noisier.",
      "Where no effect that has a name passes (or none more) and what is left is more than noise, "
      "curves that have no law are tried and judged in the same way: over the depth "
      "(learned-depth), the force along z and across it (learned-axes), the time since the tool "
      "moved (learned-kernel) and the session (learned-drift, learned-gain); learned-place stands "
      "beside the named ones. Of several that pass the best is told. Such a name states no cause: "
      "it says of what kind the cause is, what it does, and by how much the unseen error falls "
      "with it; a name over the same thing that needs such a curve beside it has not the cause's "
      "form and is possible only, and so it is where more than noise is left and such a curve in "
      "its place errs less on what is unseen (or no more, where what is left is of the same kind). "
      "Where all names together leave more than noise, such curves are tried in their place too, "
      "and stand where the unseen error is plainly less; so they are "
      "where a name is not kept, and in the place of " +
          std::to_string(kCrowd) + " names or more, where they stand if fewer of them do as well."};
}

}  // namespace hapsim
