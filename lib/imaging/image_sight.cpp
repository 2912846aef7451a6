#include "imaging/image_sight.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/median.h"
#include "model/interval.h"

namespace hapsim {

double unresolved_log_std() {
  return std::log(2.0) / kHalf95;
}

ImageSight image_sight(const TetMesh& body, const ImageValues& values,
                       const std::vector<Vec3>& pressed) {
  constexpr std::size_t kGroups = 48;
  const std::size_t count = body.tets.size();
  std::vector<double> distance;
  for (std::size_t t = 0; t < count; ++t) {
    const Vec3 p = tet_centroid(body, t);
    double least = std::numeric_limits<double>::infinity();
    for (const Vec3& place : pressed) least = std::min(least, (p - place).norm());
    distance.push_back(least);
  }
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return distance[a] < distance[b]; });
  ImageSight sight;
  const std::size_t size = std::max<std::size_t>(1, count / kGroups);
  for (std::size_t begin = 0; begin < count; begin += size) {
    std::vector<double> error, resolution, at;
    for (std::size_t k = begin; k < std::min(count, begin + size); ++k) {
      error.push_back(values.log_std[order[k]]);
      resolution.push_back(values.resolution[order[k]]);
      at.push_back(distance[order[k]]);
    }
    if (!(quantile(error, 0.5) < unresolved_log_std())) break;
    sight.reach = quantile(at, 0.5);
    sight.at_reach = quantile(resolution, 0.5);
    if (begin == 0) sight.finest = sight.at_reach;
  }
  return sight;
}

std::string sight_words(const ImageSight& s) {
  if (s.reach == 0)
    return "nowhere do these presses tell the modulus within a factor of 2, with 95 %";
  return fmt::format(
      "the modulus of the image is known within a factor of 2, with 95 %, as far as {:.0f} mm from "
      "pressed places; near them it is an average over some {:.0f} mm to all sides and that far "
      "away over {:.0f} mm, so that smaller things are blurred",
      1e3 * s.reach, 1e3 * s.finest, 1e3 * s.at_reach);
}

}  // namespace hapsim
