// The words of headers, as data: which language writes which quantity how.
#pragma once

#include <string>
#include <vector>

namespace hapsim {

enum class Word {
  kTime,
  kDepth,   // indentation below the surface, whose zero is first contact
  kTravel,  // of a machine, whose zero is arbitrary
  kGap,     // between the tools: the travel counted the other way, from the height of the specimen
  kForce,
  kTemperature,
  kContactFlag,
  kFail,
  kSample,        // number of the sample within its press
  kPress,         // names a press
  kGroup,         // names a group of presses: "specimen"
  kPerhapsPress,  // a press, or a row's number
  kStage,         // a positioning stage
  kTorque,
  kApproach,  // half of a curve that is written beside its other half: on the way in ...
  kRetract,   // ... and on the way out
  kNoScalar,  // derived from what is measured: a stress, a rate, a largest value
  kNoTime,    // holds a word for time and is none
  kNoForce,
  kCommanded,    // what was asked for, not what was measured
  kForceVector,  // bases of vectors' names ("tip" of "tip_x"), in the order in which they are asked
  kNoForceVector,
  kNormalVector,
  kDisplacementVector,
  kDesiredVector,
  kDeformedVector,
  kTouch,  // with kBall: the centre of the tool's ball at first contact
  kBall,
  kContactVector,
  kReference,
  kPlace,
  kTipVector,
  kNoVector,
  kQualifier,   // in brackets and no unit: "raw"
  kStatistics,  // rows below a table: "Mean", "Std. dev."
};

struct HeaderWord {
  const char* language;  // "en", "de", "fr", "es", "it", "pt", "zh", "ja"; "-": a symbol of all
  Word word;
  bool whole;           // the name is this and nothing else; else it holds this
  const char* pattern;  // folded (tables/fold.h), its words joined
  int rank;             // of several columns the one with the lowest rank is meant
};

const std::vector<HeaderWord>& header_words();

// Lowest rank of the words of that kind which a name (folded and joined) is or holds; -1: none.
int rank_of(const std::string& name, Word word);

inline bool is_word(const std::string& name, Word word) {
  return rank_of(name, word) >= 0;
}

// Whether a name is of a quantity or a press: tells a header from other rows.
bool is_known_word(const std::string& name);

// Whether a pattern of that kind is the very name.
bool is_pattern(const std::string& name, Word word);

}  // namespace hapsim
