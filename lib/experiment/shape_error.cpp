#include "experiment/shape_error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace hapsim {

bool ShapeError::plain() const {
  constexpr double kOfScans = 0.01;  // of the least extent
  return before > kOfScans * least_extent;
}

std::string ShapeError::words() const {
  if (!plain()) return "";
  return fmt::format(
      "contact points lie {:.2g} mm rms off the body's surface, {:.2g} mm at ({:.0f}, {:.0f}, "
      "{:.0f}) "
      "mm; moved as a whole it would lie {:.2g} mm off them",
      1e3 * before, 1e3 * farthest, 1e3 * at.x(), 1e3 * at.y(), 1e3 * at.z(), 1e3 * after);
}

ShapeError shape_error(const Places& places) {
  ShapeError error;
  double before = 0, after = 0, count = 0;
  for (std::size_t s = 0; s < places.setups(); ++s) {
    const SetupPlaces& setup = *places.setup(s);
    const RigidMove move = setup.move();
    const auto points = static_cast<double>(setup.positions().size());
    before += points * move.before * move.before;
    after += points * move.after * move.after;
    count += points;
    const auto& vertices = setup.surface().vertices;
    Vec3 low = vertices.front(), high = low;
    for (const Vec3& v : vertices) {
      low = low.cwiseMin(v);
      high = high.cwiseMax(v);
    }
    const double extent = (high - low).minCoeff();
    error.least_extent = s == 0 ? extent : std::min(error.least_extent, extent);
    for (std::size_t p = 0; p < setup.positions().size(); ++p) {
      const double off = (setup.positions()[p] - setup.contacts()[p].point).norm();
      if (off <= error.farthest) continue;
      error.farthest = off;
      error.at = setup.positions()[p];
    }
  }
  if (count == 0) return error;
  error.before = std::sqrt(before / count);
  error.after = std::sqrt(after / count);
  return error;
}

}  // namespace hapsim
