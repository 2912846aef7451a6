#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "base/median.h"
#include "reconstruct/clean_points.h"
#include "reconstruct/reconstruct_parts.h"

namespace hapsim {
namespace {

constexpr double kLeastOfBox = 0.1;  // a body's area over that of its bounding box: a ball has 0.5

}  // namespace

ScanView view_scan(const PointCloud& cloud) {
  ScanView view;
  view.spacing = point_spacing(cloud.points);
  Vec3 centre = Vec3::Zero(), low, high;
  for (const Vec3& p : cloud.points) centre += p;
  centre /= static_cast<double>(cloud.points.size());
  for (int k = 0; k < 3; ++k) {
    std::vector<double> along;
    for (const Vec3& p : cloud.points) along.push_back(p[k]);
    low[k] = quantile(along, 0.005);
    high[k] = quantile(along, 0.995);
  }
  view.low = low.z();
  view.high = high.z();

  // Cells of the plan view seen from above, and which of them from below.
  const double cell = 2 * view.spacing;
  std::set<std::array<long, 2>> above, below;
  constexpr int kDirections = 36;
  std::array<bool, kDirections> reached{};
  const double band = view.low + std::max(3 * view.spacing, 0.12 * (view.high - view.low));
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const Vec3& p = cloud.points[i];
    const std::array<long, 2> at{std::lround(p.x() / cell), std::lround(p.y() / cell)};
    if (cloud.normals[i].z() > 0.2) above.insert(at);
    if (cloud.normals[i].z() < -0.6) below.insert(at);
    if (cloud.normals[i].z() < 0.2) view.steep_share += 1;
    if (p.z() < band && cloud.normals[i].z() < 0.6) {
      const double turn = std::atan2(p.y() - centre.y(), p.x() - centre.x()) / (2 * M_PI) + 0.5;
      reached[std::min(kDirections - 1, static_cast<int>(turn * kDirections))] = true;
    }
  }
  view.steep_share /= static_cast<double>(cloud.points.size());
  // Dense lines far apart, or part of the points at another scale, have less than lies around them.
  const Vec3 size = high - low;
  view.area = std::max(view.spacing * view.spacing * static_cast<double>(cloud.points.size()),
                       kLeastOfBox * 2 * size.dot(Vec3(size.y(), size.z(), size.x())));
  double both = 0;
  for (const auto& at : above) both += below.count(at) > 0 ? 1 : 0;
  if (!above.empty()) view.under_cover = both / static_cast<double>(above.size());
  view.ring_cover =
      static_cast<double>(std::count(reached.begin(), reached.end(), true)) / kDirections;
  return view;
}

PointCloud even_points(const PointCloud& cloud, double spacing, double edge) {
  return spacing < edge / 3 ? thin_points(cloud, edge / 3) : cloud;
}

}  // namespace hapsim
