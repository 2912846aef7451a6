// Names that stand in for a cause which has none.
#pragma once

#include <string>
#include <vector>

#include "diagnose/left_kinds.h"

namespace hapsim {

// Names come near many a cause that has none here. That they are it is not believed where none of
// them is of the kind that the given model's misfit has, and a law of that kind, which was not
// fitted to what it foretells, does no worse than they do where they were fitted; or where they
// and a law of what they leave, together, leave more than a tenth of the squares beyond noise.
struct StandIns {
  std::string kind;  // of the cause; "": the names do not stand in for one
  std::vector<std::string> effects;
  double law = 0, named = 0;  // shares of the misfit's squares beyond noise
};

// misfit: kinds of what the given model leaves, the first one foretelling most; effects: named,
// which take `named` of it and leave more than noise; left: kinds of that. A name is of the first
// of its card's kinds, a curve without a law of any, unless that law leaves half as much, and a
// tenth of all less. Not where the law foretells less than half, nor of what each press has of its
// own, for any law that does not change within a press is among it.
StandIns find_stand_ins(const std::vector<LeftKind>& misfit,
                        const std::vector<std::string>& effects, double named,
                        const std::vector<LeftKind>& left);

// What came near, and how; begins with a space, "" where nothing stands in.
std::string stand_in_words(const StandIns& stand_ins);
// What all that the given model misses goes with; the same of no misfit.
std::string misfit_words(const std::vector<LeftKind>& misfit);

}  // namespace hapsim
