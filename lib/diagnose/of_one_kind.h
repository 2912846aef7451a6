// Several names where one cause may be that has none.
#pragma once

#include <string>
#include <vector>

namespace hapsim {

// So many effects of one kind are rather one cause of that kind: each of several is as unlikely
// beforehand as any, their product more than that of one cause which the catalogue lacks. In trials
// with one effect of the set-up taken out of the catalogue (bench/diagnosis, --leave-out) three or
// four others stood in for it in three of five; where three effects were hidden no three of those
// named were of one kind.
constexpr std::size_t kManyOfOneKind = 3;

// The kind that kManyOfOneKind or more of these different effects share, of several the one that
// most do; "": none. Curves of no law are not counted.
std::string kind_of_many(const std::vector<std::string>& effects);

}  // namespace hapsim
