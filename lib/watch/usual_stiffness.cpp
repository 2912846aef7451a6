#include "watch/usual_stiffness.h"

#include <cmath>

#include "realtime/inverse_cubes.h"

namespace hapsim {
namespace {

constexpr std::size_t kMost = 200;  // then every new press takes the place of the oldest
constexpr double kFew = 8;  // presses: of fewer a standard deviation errs by more than a quarter

}  // namespace

Vec3 UsualStiffness::off_at(const Vec3& place) const {
  return inverse_cubes(off, Vec3(Vec3::Zero()), place);
}

void PressFactors::add(std::int32_t press, std::size_t begun, const Vec3& place, const Vec3& model,
                       const Vec3& measured) {
  if (presses_.empty() || presses_.back().press != press) {
    if (presses_.size() == kMost) presses_.erase(presses_.begin());
    presses_.push_back({press, begun, place});
  }
  Sums& sums = presses_.back();
  const double size = model.norm();
  sums.mm += size * size;
  sums.fm += model.dot(measured);
  sums.m += size * model;
  sums.f += size * measured;
}

UsualStiffness PressFactors::usual(std::size_t before, double share) const {
  std::vector<Sums> ended;
  for (std::size_t i = 0; i + 1 < presses_.size(); ++i)
    if (presses_[i + 1].begun <= before && presses_[i].mm > 0) ended.push_back(presses_[i]);
  const auto n = static_cast<double>(ended.size());
  double mm = 0, fm = 0, squares = 0;
  for (const Sums& press : ended) mm += press.mm, fm += press.fm;
  UsualStiffness usual{1, share, share, {}};
  if (n < kFew || fm <= 0) return usual;
  usual.factor = fm / mm;
  for (const Sums& press : ended) {
    squares += std::pow(press.fm - usual.factor * press.mm, 2);
    usual.off.emplace_back(press.place,
                           (press.f - usual.factor * press.m) / (usual.factor * press.mm));
  }
  // Presses by the square of their force, which may be unlike.
  usual.error = std::sqrt(squares * n / (n - 1)) / mm;
  // What the others say of each.
  double left = 0;
  for (std::size_t i = 0; i < ended.size(); ++i)
    left +=
        ended[i].mm / mm *
        (usual.off[i].second - inverse_cubes(usual.off, Vec3(Vec3::Zero()), usual.off[i].first, i))
            .squaredNorm();
  usual.share = std::sqrt(left);
  return usual;
}

}  // namespace hapsim
