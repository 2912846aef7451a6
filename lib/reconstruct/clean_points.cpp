#include "reconstruct/clean_points.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "base/counted.h"
#include "base/error.h"
#include "base/median.h"
#include "mesh/local_plane.h"
#include "mesh/point_index.h"

namespace hapsim {
namespace {

constexpr int kNeighbours = 10;
// A point is isolated when its neighbours are this much farther from it than from each other. The
// sparsest corner of an uneven scan reaches 2.5; a gross outlier lies at 5 and more.
constexpr double kIsolation = 3.0;
// Off the surface: this many robust standard deviations off the plane of its neighbours.
constexpr double kOffPlane = 8.0;
constexpr int kPasses = 3;  // outliers that hid each other show up in the next pass

PointCloud keep(const PointCloud& cloud, const std::vector<char>& dropped,
                std::vector<int>& index) {
  PointCloud kept;
  std::vector<int> still;
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    if (dropped[i]) continue;
    kept.points.push_back(cloud.points[i]);
    if (!cloud.normals.empty()) kept.normals.push_back(cloud.normals[i]);
    still.push_back(index[i]);
  }
  index = std::move(still);
  return kept;
}

// Drops every point that lies within `distance` of an earlier kept one.
std::size_t drop_near(PointCloud& cloud, double distance, std::vector<int>& kept) {
  const PointIndex index(cloud.points);
  std::vector<char> dropped(cloud.points.size(), 0);
  std::size_t count = 0;
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    if (dropped[i]) continue;
    for (const Neighbour& n : index.within(cloud.points[i], distance)) {
      if (n.index > static_cast<int>(i) && !dropped[n.index]) {
        dropped[n.index] = 1;
        ++count;
      }
    }
  }
  if (count > 0) cloud = keep(cloud, dropped, kept);
  return count;
}

// Exact doubles: sorted, as the search tree degrades when thousands of points coincide.
std::size_t drop_equal(PointCloud& cloud, std::vector<int>& kept) {
  std::vector<int> order(cloud.points.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
  const auto key = [&](int i) {
    const Vec3& p = cloud.points[i];
    return std::array<double, 3>{p.x(), p.y(), p.z()};
  };
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    const auto ka = key(a), kb = key(b);
    return ka != kb ? ka < kb : a < b;
  });
  std::vector<char> dropped(order.size(), 0);
  std::size_t count = 0;
  for (std::size_t i = 1; i < order.size(); ++i) {
    if (key(order[i]) == key(order[i - 1])) {
      dropped[order[i]] = 1;
      ++count;
    }
  }
  if (count > 0) cloud = keep(cloud, dropped, kept);
  return count;
}

// Mean distance to the k nearest, compared with the median of the same over those neighbours, so
// that an uneven density is no reason to drop points.
std::size_t drop_isolated(PointCloud& cloud, std::vector<int>& kept) {
  const PointIndex index(cloud.points);
  const std::size_t n = cloud.points.size();
  std::vector<std::vector<Neighbour>> near(n);
  std::vector<double> reach(n, 0);
  for (std::size_t i = 0; i < n; ++i) {
    near[i] = index.nearest(cloud.points[i], kNeighbours + 1);
    for (const Neighbour& m : near[i]) reach[i] += m.distance;
    reach[i] /= static_cast<double>(std::max<std::size_t>(near[i].size(), 2) - 1);
  }
  const double usual = upper_median(reach);
  std::vector<char> dropped(n, 0);
  std::size_t count = 0;
  for (std::size_t i = 0; i < n; ++i) {
    std::vector<double> others;
    for (const Neighbour& m : near[i]) {
      if (m.index != static_cast<int>(i)) others.push_back(reach[m.index]);
    }
    if (reach[i] > kIsolation * std::max(upper_median(others), usual / 2)) {
      dropped[i] = 1;
      ++count;
    }
  }
  if (count > 0) cloud = keep(cloud, dropped, kept);
  return count;
}

// Distance from the plane of the neighbours, in units of their own median distance from it: large
// at a sharp edge too, so an edge keeps its points.
std::size_t drop_off_surface(PointCloud& cloud, std::vector<int>& kept) {
  const PointIndex index(cloud.points);
  const std::size_t n = cloud.points.size();
  std::vector<double> off(n, 0), scale(n, 0);
  for (std::size_t i = 0; i < n; ++i) {
    std::vector<Vec3> others;
    for (const Neighbour& m : index.nearest(cloud.points[i], kNeighbours + 3)) {
      if (m.index != static_cast<int>(i)) others.push_back(cloud.points[m.index]);
    }
    const LocalPlane plane = fit_plane(others);
    off[i] = std::abs(plane.normal.dot(cloud.points[i] - plane.centre));
    scale[i] = plane.thickness;
  }
  const double usual = upper_median(scale);
  std::vector<char> dropped(n, 0);
  std::size_t count = 0;
  for (std::size_t i = 0; i < n; ++i) {
    if (off[i] > kOffPlane * std::max(scale[i], usual)) {
      dropped[i] = 1;
      ++count;
    }
  }
  if (count > 0) cloud = keep(cloud, dropped, kept);
  return count;
}

}  // namespace

double point_spacing(const std::vector<Vec3>& points) {
  if (points.size() < 2) return 0;
  const PointIndex index(points);
  // At most some thousand places: the median does not need more.
  const std::size_t step = std::max<std::size_t>(1, points.size() / 4000);
  std::vector<double> sixth;
  for (std::size_t i = 0; i < points.size(); i += step) {
    sixth.push_back(index.nearest(points[i], 7).back().distance);
  }
  // On a plane with n points a unit area, the sixth neighbour lies at sqrt(6 / (pi n)) = 1.38 /
  // sqrt n.
  return upper_median(sixth) / 1.38;
}

constexpr double kFarthest = 1e6;  // [m]; beyond it distances lose their digits

void require_surface_points(const std::vector<Vec3>& points, const std::string& name) {
  if (points.size() < 4) {
    fail_input(name, "only " + counted(points.size(), "different point", "different points"),
               "a surface needs at least 4, better some hundred");
  }
  const LocalPlane plane = fit_plane(points);
  if (plane.spread[1] < 1e-6 * plane.spread[2]) {
    fail_input(name, "all points lie on one line", "scan a surface");
  }
}

PointCloud thin_points(const PointCloud& cloud, double size, std::vector<int>* index) {
  struct Cell {
    Vec3 point = Vec3::Zero();
    Vec3 normal = Vec3::Zero();
    double count = 0;
    int first = 0;
  };
  std::map<std::array<long, 3>, std::size_t> number;
  std::vector<Cell> cells;
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const Vec3 at = cloud.points[i] / size;
    const auto [where, added] = number.try_emplace(
        {std::lround(at.x()), std::lround(at.y()), std::lround(at.z())}, cells.size());
    if (added) cells.emplace_back().first = static_cast<int>(i);
    Cell& cell = cells[where->second];
    cell.point += cloud.points[i];
    if (!cloud.normals.empty()) cell.normal += cloud.normals[i];
    cell.count += 1;
  }
  PointCloud thin;
  for (const Cell& cell : cells) {
    // Opposite sides of a thin wall in one cell have no common normal.
    if (!cloud.normals.empty()) {
      if (cell.normal.norm() < 1e-3 * cell.count) continue;
      thin.normals.push_back(cell.normal.normalized());
    }
    thin.points.push_back(cell.point / cell.count);
    if (index != nullptr) index->push_back(cell.first);
  }
  return thin;
}

PointCloud clean_points(const PointCloud& cloud, const CleanOptions& options,
                        const std::string& name, CleanReport& report) {
  report = {};
  report.read = cloud.points.size();
  for (const Vec3& p : cloud.points)
    if (!(p.cwiseAbs().maxCoeff() <= kFarthest))
      fail_input(name,
                 fmt::format("a point lies at ({:.3g}, {:.3g}, {:.3g}) m", p.x(), p.y(), p.z()),
                 "check the unit, and the robot's or the volume's frame");
  PointCloud clean = cloud;
  std::vector<int>& index = report.index;
  index.resize(cloud.points.size());
  std::iota(index.begin(), index.end(), 0);
  report.duplicates = drop_equal(clean, index);
  require_surface_points(clean.points, name);
  report.near_duplicates = drop_near(clean, 1e-3 * point_spacing(clean.points), index);
  if (options.remove_outliers && clean.points.size() > 3 * kNeighbours) {
    for (int pass = 0; pass < kPasses; ++pass) {
      const std::size_t isolated = drop_isolated(clean, index);
      const std::size_t off = drop_off_surface(clean, index);
      report.isolated += isolated;
      report.off_surface += off;
      if (isolated + off == 0) break;
    }
  }
  if (options.spacing > 0) {
    const std::size_t before = clean.points.size();
    std::vector<int> first;
    clean = thin_points(clean, options.spacing, &first);
    for (int& i : first) i = index[static_cast<std::size_t>(i)];
    index = std::move(first);
    report.thinned = before - clean.points.size();
  }
  require_surface_points(clean.points, name);
  report.kept = clean.points.size();
  return clean;
}

}  // namespace hapsim
