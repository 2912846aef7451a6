// Learning from what came first, and what that foretells of the rest.
#pragma once

#include <vector>

#include "fit/fit.h"

namespace hapsim {

// What a fit may see of an experiment, and what it has to foretell.
struct UnseenPart {
  Experiment known;                   // presses end where what is unseen begins
  Selection seen;                     // presses of it that may be seen
  std::vector<Eigen::Index> rows;     // unseen, of the whole, stacked by episode; ascending
  std::vector<Eigen::Index> lengths;  // of the stretches that they are, one a press
};

// The presses' course in time, one stretch after the other, each foretold by all that came before
// it (prequential: Dawid, J. R. Statist. Soc. A 147, 1984). On the way in, in the hold and on the
// way out a stretch is half as long as what of it came before, as relaxation asks for; the first
// begins at 4/9 of the ways and a fifth of the hold. Less than ten rows are no stretch.
std::vector<UnseenPart> rests_of_presses(const Experiment& experiment);
// Whole presses left out in turn; none of a single one.
std::vector<UnseenPart> presses_left_out(const Experiment& experiment, int folds);

}  // namespace hapsim
