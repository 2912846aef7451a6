#include "realtime/usual_stiffness.h"

#include <algorithm>
#include <cmath>

namespace hapsim {
namespace {

constexpr std::size_t kMost = 200;  // then every new press takes the place of the oldest
constexpr double kFew = 8;

}  // namespace

void PressFactors::add(std::int32_t press, std::size_t begun, const Vec3& model,
                       const Vec3& measured) {
  if (presses_.empty() || presses_.back().press != press) {
    if (presses_.size() == kMost) presses_.erase(presses_.begin());
    presses_.push_back({press, begun});
  }
  presses_.back().mm += model.squaredNorm();
  presses_.back().fm += model.dot(measured);
}

UsualStiffness PressFactors::usual(std::size_t before, double share) const {
  double n = 0, mm = 0, fm = 0, squares = 0;
  for (std::size_t i = 0; i + 1 < presses_.size(); ++i)
    if (presses_[i + 1].begun <= before && presses_[i].mm > 0)
      n += 1, mm += presses_[i].mm, fm += presses_[i].fm;
  if (n < kFew || fm <= 0) return {1, share, share};
  UsualStiffness usual;
  usual.factor = fm / mm;
  for (std::size_t i = 0; i + 1 < presses_.size(); ++i)
    if (presses_[i + 1].begun <= before)
      squares += std::pow(presses_[i].fm - usual.factor * presses_[i].mm, 2);
  // Presses by the square of their force, which may be unlike.
  usual.error = std::sqrt(squares * n / (n - 1)) / mm;
  const double common = usual.factor - 1;
  usual.share = std::sqrt(std::max(share * share - common * common, 0.1 * share * share));
  return usual;
}

}  // namespace hapsim
