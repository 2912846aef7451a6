// Several names where one cause may be that has none.
#pragma once

#include <string>
#include <vector>

namespace hapsim {

// The kind that two or more of these different effects share among what they mostly are, the first
// two of EffectCard::kinds; of several kinds the one that most share; empty: none. Curves of no
// law are not counted. Each of several effects is as unlikely beforehand as any, their product more
// than that of one cause which the catalogue lacks. In trials with one effect of the set-up taken
// out of the catalogue (bench/diagnosis, --leave-out) three or four others stood in for it in three
// of five; where three effects were hidden no three of those named were of one kind. Of two of one
// kind each acted in two of ten by causes that no effect covers (bench/open-world).
struct OneKind {
  std::string kind;
  std::vector<std::string> effects;
};
OneKind kind_of_several(const std::vector<std::string>& effects);

}  // namespace hapsim
