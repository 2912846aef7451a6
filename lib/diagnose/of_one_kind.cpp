#include "diagnose/of_one_kind.h"

#include <algorithm>
#include <map>
#include <set>

#include "effects/catalogue.h"

namespace hapsim {

OneKind kind_of_several(const std::vector<std::string>& effects) {
  constexpr std::size_t kMainKinds = 2;
  std::map<std::string, std::vector<std::string>> of_kind;
  OneKind most;
  for (const std::string& effect : std::set<std::string>(effects.begin(), effects.end())) {
    const EffectCard& card = require_effect(effect).card();
    if (card.learned || card.is_field) continue;
    for (std::size_t k = 0; k < std::min(kMainKinds, card.kinds.size()); ++k) {
      std::vector<std::string>& now = of_kind[card.kinds[k]];
      now.push_back(effect);
      if (now.size() > 1 && now.size() > most.effects.size()) most = {card.kinds[k], now};
    }
  }
  return most;
}

}  // namespace hapsim
