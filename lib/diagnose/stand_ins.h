// Names that stand in for a cause which has none.
#pragma once

#include <string>
#include <vector>

#include "diagnose/left_kinds.h"

namespace hapsim {

// A law of some kind foretells more of a model's misfit on presses that were left out than all
// named effects take of it where they were fitted: what has that law is the cause, the names are
// near it. `kind` is "" where it is not so.
struct StandIns {
  std::string kind;
  double law = 0, named = 0;  // shares of the squares beyond noise
};

// misfit: the kinds of what the given model leaves, the first one foretelling most; effects: named,
// which take `named` and leave more than noise. Not of what each press has of its own (any law that
// does not change within a press is among it), nor where an effect is of the law's kind first of
// all. The effects leave twice as much as the law does at least, and a tenth more of all.
StandIns find_stand_ins(const std::vector<LeftKind>& misfit,
                        const std::vector<std::string>& effects, double named);

// That they do, or else what all of the misfit goes with. Begins with a space; "" of no misfit.
std::string misfit_words(const std::vector<LeftKind>& misfit, const StandIns& stand_ins);

}  // namespace hapsim
