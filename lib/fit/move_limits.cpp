#include "fit/move_limits.h"

#include <algorithm>
#include <cmath>

#include "effects/catalogue.h"
#include "model/body_parameters.h"

namespace hapsim {
namespace {

constexpr double kLogarithm = 0.7;  // a factor of two each way

bool is_linear_in(const Parameter& p) {
  const EffectCard& card = require_effect(p.effect).card();
  if (card.stage != Stage::kBody && card.stage != Stage::kSupport) return false;
  if (is_modulus(p)) return p.region > 0;
  const bool of_region = std::any_of(card.of_region.begin(), card.of_region.end(),
                                     [&](const ParameterCard& c) { return c.name == p.name; });
  return is_poissons_ratio(p) || card.solved || of_region;
}

}  // namespace

bool is_linearised(const MaterialSpec& material, bool exact_regions) {
  if (!material.features.empty()) return true;
  return exact_regions && material.modulus.size() > 1 && !material.local &&
         !material.key_point.empty();
}

std::vector<Unknown> within_reach(std::vector<Unknown> unknowns, const Model& model, double reach) {
  const std::vector<int> free = model.free_parameters();
  for (std::size_t i = 0; i < free.size(); ++i) {
    if (!is_linear_in(model.parameters[free[i]])) continue;
    Unknown& u = unknowns[i];
    double low = u.value - reach * u.scale, high = u.value + reach * u.scale;
    if (u.logarithmic) {
      low = u.value * std::exp(-kLogarithm * reach);
      high = u.value * std::exp(kLogarithm * reach);
    } else if (!std::isnan(u.log_limit)) {
      // Poisson's ratio: the body follows it well over a wide range.
      const double room = u.log_limit - u.value;
      low = u.log_limit - room * std::exp(2 * kLogarithm * reach);
      high = u.log_limit - room * std::exp(-2 * kLogarithm * reach);
    }
    u.lower = std::max(u.lower, low);
    u.upper = std::min(u.upper, high);
  }
  return unknowns;
}

}  // namespace hapsim
