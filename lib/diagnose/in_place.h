// What may stand in the place of an effect that was found.
#pragma once

#include <optional>
#include <string>

#include "diagnose/candidate.h"
#include "diagnose/measure.h"

namespace hapsim {

struct InPlace {
  Candidate candidate;
  Measured measured;  // beside the model without either
  Baseline base;
};

// What `effect` contains as a special case, the simplest beside which `effect` fails the gates by
// which it was found (diagnose/superfluous.h); not `unknown`. Nothing when it is needed as it is;
// not of maps and fields.
std::optional<InPlace> simpler_in_place(const std::string& effect, const std::string& unknown,
                                        const Baseline& base, const TrialGround& ground,
                                        const Folds& folds, const Gates& gates);

// The curve without a law, over the same thing as `effect` (its card's confounders and what it
// contains), that errs least on what is unseen, where that is less than `base` with `effect` does
// by what the gates ask; where what that leaves, of kind `left`, is of the curve's own kind
// (EffectCard::kinds), and so tells that the law has another form, where it is no more. Nothing
// where no curve does; not of curves, maps and fields.
std::optional<InPlace> curve_in_place(const std::string& effect, const std::string& left,
                                      const std::string& unknown, const Baseline& base,
                                      const TrialGround& ground, const Folds& folds,
                                      const Gates& gates);

// What the finding of an effect says of what stands in its place.
void describe_in_place(const InPlace& found, const Dataset& dataset, Finding& finding);

}  // namespace hapsim
