// The largest error that a check lets pass.
#pragma once

#include <string>

#include "compare/comparison.h"
#include "report/junit.h"

namespace hapsim {

struct ErrorLimit {
  enum class Unit { kNewton, kPercent, kNoise };
  double factor = 0;  // [N], per cent of the force's rms, or multiples of the noise
  Unit unit = Unit::kNewton;
  std::string option, text;  // "--fail-above", "1.5noise"; for sentences
  double newtons_of(const Comparison& comparison) const;
};

// "0.05N" or "50 mN", "5%", "1.5noise" (or xnoise). Error(kUsage) beginning with `option`.
ErrorLimit parse_error_limit(const std::string& text, const std::string& option);

// Why the typical error is more than the limit allows, and where it is largest; empty where it is
// not. Error(kBadInput) about the recording of that name: the limit is in noise, and that is not
// known.
std::string excess_over(const ErrorLimit& limit, const Comparison& comparison,
                        const std::string& recording);

// The same as a case for CI servers, with what the error depends on.
JunitCase error_case(const ErrorLimit& limit, const Comparison& comparison,
                     const std::string& recording);

}  // namespace hapsim
