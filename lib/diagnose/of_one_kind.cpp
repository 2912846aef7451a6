#include "diagnose/of_one_kind.h"

#include <map>
#include <set>

#include "effects/catalogue.h"

namespace hapsim {

std::string kind_of_many(const std::vector<std::string>& effects) {
  std::map<std::string, std::size_t> count;
  std::string most;
  for (const std::string& effect : std::set<std::string>(effects.begin(), effects.end())) {
    const EffectCard& card = require_effect(effect).card();
    if (card.learned || card.is_field) continue;
    for (const std::string& kind : card.kinds)
      if (++count[kind] >= kManyOfOneKind && (most.empty() || count[kind] > count[most]))
        most = kind;
  }
  return most;
}

}  // namespace hapsim
