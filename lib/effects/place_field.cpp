#include "effects/place_field.h"

#include <cassert>
#include <cmath>

#include "estimate/kriging.h"

namespace hapsim {
namespace {

constexpr double kShallow = 0.1;     // of the depth: the power ends there
constexpr std::size_t kCommon = 12;  // rows before those of the places
constexpr std::size_t kOfPlace = 5;  // x, y, z, g, h

}  // namespace

double PlaceField::Kernel::at(double square) const {
  double k = (1 - share) * matern(square / (range * range));
  if (share > 0) k += share * matern(square / (fine * fine));
  return square <= kSamePlace * kSamePlace ? k + nugget : k;
}

PlaceField::PlaceField(const Values& v) {
  assert(v.size() >= kCommon && (v.size() - kCommon) % kOfPlace == 0);
  const auto kernel = [&v](std::size_t first) {
    return Kernel{v[first].value, v[first + 1].value, v[first + 2].value, v[first + 3].value,
                  v[first + 4].value};
  };
  depth = v[0].value;
  factor = kernel(1);
  power = kernel(6);
  mean_power = v[11].value;
  for (std::size_t i = kCommon; i < v.size(); i += kOfPlace) {
    place.emplace_back(v[i].value, v[i + 1].value, v[i + 2].value);
    g.push_back(v[i + 3].value);
    h.push_back(v[i + 4].value);
  }
}

std::vector<double> PlaceField::values() const {
  std::vector<double> values{depth};
  for (const Kernel& k : {factor, power})
    values.insert(values.end(), {k.range, k.fine, k.share, k.nugget, k.sd});
  values.push_back(mean_power);
  for (std::size_t i = 0; i < place.size(); ++i)
    values.insert(values.end(), {place[i].x(), place[i].y(), place[i].z(), g[i], h[i]});
  return values;
}

std::pair<int, int> PlaceField::columns(const Values& values, std::size_t place) {
  const std::size_t first = kCommon + kOfPlace * place;
  return {values[first + 3].column, values[first + 4].column};
}

std::array<double, 2> PlaceField::at(const Vec3& p) const noexcept {
  std::array<double, 2> sum{0, mean_power};
  for (std::size_t i = 0; i < place.size(); ++i) {
    const double square = (place[i] - p).squaredNorm();
    sum[0] += g[i] * factor.at(square);
    sum[1] += h[i] * power.at(square);
  }
  return sum;
}

std::array<double, 2> PlaceField::log_depth(double d) const noexcept {
  const double least = kShallow * depth, square = d * d + least * least;
  return {0.5 * std::log(square / (depth * depth + least * least)), d / square};
}

}  // namespace hapsim
