#include "import/table_facts.h"

#include <algorithm>
#include <cmath>

#include "base/median.h"

namespace hapsim {
namespace {

constexpr double kScatter = 0.1;

// The median where most of the values are within a tenth of it.
std::optional<double> common(const std::vector<double>& values) {
  if (values.empty()) return {};
  const double middle = median(values);
  const auto near = std::count_if(values.begin(), values.end(), [middle](double v) {
    return std::abs(v - middle) <= kScatter * middle;
  });
  if (!(middle > 0) || 10 * static_cast<std::size_t>(near) < 9 * values.size()) return {};
  return middle;
}

}  // namespace

std::optional<double> ball_radius(const Samples& samples, const std::vector<PressTrack>& tracks) {
  const auto &ball = samples[VectorRole::kContactBall], &point = samples[VectorRole::kContact];
  if (ball.empty() || point.empty()) return {};
  std::vector<double> radii;
  for (const PressTrack& track : tracks) {
    const std::size_t row = at(track.segment.rows.front());
    radii.push_back((ball[row] - point[row]).norm());
  }
  const auto radius = common(radii);
  if (!radius) return {};
  return std::round(*radius * 1e5) / 1e5;
}

std::optional<double> specimen_height(const Samples& samples,
                                      const std::vector<PressTrack>& tracks) {
  const auto& gap = samples[ScalarRole::kGap];
  if (gap.empty()) return {};
  std::vector<double> heights;
  for (const PressTrack& track : tracks) {
    // The row that is nearest to contact from outside; the first of a press that begins in contact.
    std::size_t best = 0;
    for (std::size_t i = 0; i < track.travel.size() && track.travel[i] < 0; ++i) best = i;
    heights.push_back(gap[at(track.segment.rows[best])]);
  }
  return common(heights);
}

}  // namespace hapsim
