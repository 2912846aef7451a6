#include "import/column_synonyms.h"

#include "tables/header_words.h"

namespace hapsim {

VectorRole vector_role(const std::string& b) {
  if (b.size() > 2 && b[1] == ':') {
    const VectorRole role = vector_role(b.substr(0, 1));
    const std::string rest = b.substr(2);
    if (role == VectorRole::kForce) return is_word(rest, Word::kTouch) ? VectorRole::kCount : role;
    return role == VectorRole::kNormal || role == VectorRole::kDisplacement ? role
                                                                            : vector_role(rest);
  }
  if (is_word(b, Word::kTorque) || is_word(b, Word::kNoVector)) return VectorRole::kCount;
  // The small force at which contact was declared is no recording.
  if (is_word(b, Word::kForceVector))
    return is_word(b, Word::kNoForceVector) ? VectorRole::kCount : VectorRole::kForce;
  if (is_word(b, Word::kNormalVector)) return VectorRole::kNormal;
  if (is_word(b, Word::kDisplacementVector)) return VectorRole::kDisplacement;
  if (is_word(b, Word::kDesiredVector)) return VectorRole::kDesired;
  if (is_word(b, Word::kDeformedVector)) return VectorRole::kDeformed;
  if (is_word(b, Word::kTouch) && is_word(b, Word::kBall)) return VectorRole::kContactBall;
  if (is_word(b, Word::kContactVector)) return VectorRole::kContact;
  if (is_word(b, Word::kReference)) return VectorRole::kCount;
  if (b.empty() || is_word(b, Word::kPlace)) return VectorRole::kPlain;
  if (is_word(b, Word::kTipVector) || is_word(b, Word::kStage)) return VectorRole::kTip;
  return VectorRole::kCount;
}

ScalarMatch scalar_role(const std::string& name, UnitKind unit) {
  const auto fits = [unit](UnitKind kind) { return unit == UnitKind::kNone || unit == kind; };
  if (is_word(name, Word::kNoScalar) || is_word(name, Word::kTorque)) return {};
  if (fits(UnitKind::kTemperature) &&
      (unit == UnitKind::kTemperature || is_word(name, Word::kTemperature)))
    return {ScalarRole::kTemperature, 0};
  if (fits(UnitKind::kTime) && !is_word(name, Word::kNoTime) && is_word(name, Word::kTime))
    return {ScalarRole::kTime, rank_of(name, Word::kTime)};
  if (is_word(name, Word::kContactFlag)) return {ScalarRole::kContactFlag, 0};
  if (is_word(name, Word::kFail)) return {ScalarRole::kFail, 0};
  if (is_word(name, Word::kSample)) return {ScalarRole::kSample, 0};
  const int commanded = is_word(name, Word::kCommanded) ? 15 : 0;
  if (fits(UnitKind::kForce) && !is_word(name, Word::kNoForce) && is_word(name, Word::kForce))
    return {ScalarRole::kForce, rank_of(name, Word::kForce) + commanded};
  if (!fits(UnitKind::kLength)) return {};
  if (is_word(name, Word::kGap)) return {ScalarRole::kGap, rank_of(name, Word::kGap)};
  const int depth = rank_of(name, Word::kDepth), travel = rank_of(name, Word::kTravel);
  if (depth < 0 && travel < 0) return {};
  return {ScalarRole::kDepth,
          (depth >= 0 && (travel < 0 || depth < travel) ? depth : travel) + commanded};
}

PressWord press_word(const std::string& name) {
  if (is_word(name, Word::kPress)) return PressWord::kYes;
  if (is_word(name, Word::kGroup)) return PressWord::kGroup;
  return is_word(name, Word::kPerhapsPress) ? PressWord::kPerhaps : PressWord::kNo;
}

bool is_travel(const std::string& name) {
  return !is_word(name, Word::kDepth);
}

}  // namespace hapsim
