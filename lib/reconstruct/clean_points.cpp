#include "reconstruct/clean_points.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <span>
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
// Merged of less than this part of the points of others; thickness over width of neighbours in a
// plane (points that fill space have 0.6); how many thicknesses off it.
constexpr double kStray = 5, kInPlane = 0.25, kStrayOff = 4;
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

double spacing_of(const std::vector<Vec3>& points, const PointIndex& index) {
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

// Drops every point that lies within `spacings` of an earlier kept one.
std::size_t drop_near(PointCloud& cloud, double spacings, std::vector<int>& kept) {
  if (cloud.points.size() < 2) return 0;
  const PointIndex index(cloud.points);
  const double distance = spacings * spacing_of(cloud.points, index);
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

// Exact doubles, of which the first stays; before any search tree is built, as it degrades when
// thousands of points coincide.
std::size_t drop_equal(PointCloud& cloud, std::vector<int>& kept) {
  const auto same = [&](int a, int b) {
    return cloud.points[static_cast<std::size_t>(a)] == cloud.points[static_cast<std::size_t>(b)];
  };
  // By a hash, which sorts faster than coordinates; points of one hash are few.
  std::vector<std::pair<std::uint64_t, int>> order(cloud.points.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    std::uint64_t hash = 0;
    for (const double c : cloud.points[i]) {
      hash = (hash ^ std::bit_cast<std::uint64_t>(c + 0.0)) * 0x9e3779b97f4a7c15u;  // -0 is 0
      hash ^= hash >> 32;
    }
    order[i] = {hash, static_cast<int>(i)};
  }
  std::sort(order.begin(), order.end());
  std::vector<char> dropped(order.size(), 0);
  std::size_t count = 0;
  for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
    for (end = begin + 1; end < order.size() && order[end].first == order[begin].first; ++end) {
      bool known = false;
      for (std::size_t i = begin; i < end && !known; ++i)
        known = dropped[static_cast<std::size_t>(order[i].second)] == 0 &&
                same(order[i].second, order[end].second);
      dropped[static_cast<std::size_t>(order[end].second)] = known ? 1 : 0;
      count += known ? 1 : 0;
    }
  }
  if (count > 0) cloud = keep(cloud, dropped, kept);
  return count;
}

// The points about each, itself among them, the nearest first.
using Nearby = std::vector<std::vector<Neighbour>>;
Nearby nearby(const std::vector<Vec3>& points) {
  const PointIndex index(points);
  Nearby near;
  near.reserve(points.size());
  for (const Vec3& p : points) near.push_back(index.nearest(p, kNeighbours + 3));
  return near;
}

// Mean distance to the k nearest, compared with the median of the same over those neighbours, so
// that an uneven density is no reason to drop points.
std::size_t drop_isolated(PointCloud& cloud, const Nearby& nearby, std::vector<int>& kept) {
  const std::size_t n = cloud.points.size();
  const auto nearest = [&](std::size_t i) {
    return std::span(nearby[i]).first(std::min<std::size_t>(nearby[i].size(), kNeighbours + 1));
  };
  std::vector<double> reach(n, 0);
  for (std::size_t i = 0; i < n; ++i) {
    for (const Neighbour& m : nearest(i)) reach[i] += m.distance;
    reach[i] /= static_cast<double>(std::max<std::size_t>(nearest(i).size(), 2) - 1);
  }
  const double usual = upper_median(reach);
  std::vector<char> dropped(n, 0);
  std::size_t count = 0;
  for (std::size_t i = 0; i < n; ++i) {
    std::vector<double> others;
    for (const Neighbour& m : nearest(i)) {
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

// What few points were merged into, where others are of many, and lies in no surface: outliers of a
// dense scan, which are each other's neighbours. An uneven density is no reason here either: the
// points of a sparse part lie in a plane.
std::size_t drop_stray(PointCloud& cloud, std::vector<int>& count, std::vector<int>& kept) {
  std::vector<double> of_each;  // as many times as there are points of that count
  for (const int c : count) of_each.insert(of_each.end(), static_cast<std::size_t>(c), c);
  const double few = upper_median(std::move(of_each)) / kStray;
  if (few < 1) return 0;
  const PointIndex index(cloud.points);
  std::vector<char> dropped(cloud.points.size(), 0);
  std::size_t dropped_count = 0;
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    if (count[i] > few) continue;
    std::vector<Vec3> others;
    for (const Neighbour& m : index.nearest(cloud.points[i], kNeighbours + 1))
      if (m.index != static_cast<int>(i)) others.push_back(cloud.points[m.index]);
    const LocalPlane plane = fit_plane(others);
    const double off = std::abs(plane.normal.dot(cloud.points[i] - plane.centre));
    if (plane.thickness < kInPlane * plane.spread[1] && off < kStrayOff * plane.thickness) continue;
    dropped[i] = 1;
    ++dropped_count;
  }
  if (dropped_count == 0) return 0;
  cloud = keep(cloud, dropped, kept);
  std::size_t left = 0;
  for (std::size_t i = 0; i < dropped.size(); ++i)
    if (!dropped[i]) count[left++] = count[i];
  count.resize(left);
  return dropped_count;
}

// Distance from the plane of the neighbours, in units of their own median distance from it: large
// at a sharp edge too, so an edge keeps its points.
std::size_t drop_off_surface(PointCloud& cloud, const Nearby& nearby, std::vector<int>& kept) {
  const std::size_t n = cloud.points.size();
  std::vector<double> off(n, 0), scale(n, 0);
  for (std::size_t i = 0; i < n; ++i) {
    std::vector<Vec3> others;
    for (const Neighbour& m : nearby[i]) {
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
  return spacing_of(points, PointIndex(points));
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

PointCloud thin_points(const PointCloud& cloud, double size) {
  struct Cell {
    Vec3 point = Vec3::Zero();
    Vec3 normal = Vec3::Zero();
    double count = 0;
  };
  std::map<std::array<long, 3>, std::size_t> number;
  std::vector<Cell> cells;
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const Vec3 at = cloud.points[i] / size;
    const auto [where, added] = number.try_emplace(
        {std::lround(at.x()), std::lround(at.y()), std::lround(at.z())}, cells.size());
    if (added) cells.emplace_back();
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
  // Before neighbours are sought: how many a question takes grows with their density.
  MergedPoints merged = merge_points(clean, options.spacing, report.merged);
  clean = std::move(merged.cloud);
  for (int& i : merged.index) i = index[static_cast<std::size_t>(i)];
  index = std::move(merged.index);
  for (int pass = 0; options.remove_outliers && pass < kPasses; ++pass) {
    const std::size_t stray = drop_stray(clean, merged.count, index);
    report.isolated += stray;
    if (stray == 0) break;
  }
  report.near_duplicates = drop_near(clean, 1e-3, index);
  if (options.remove_outliers && clean.points.size() > 3 * kNeighbours) {
    for (int pass = 0; pass < kPasses; ++pass) {
      Nearby near = nearby(clean.points);
      const std::size_t isolated = drop_isolated(clean, near, index);
      if (isolated > 0) near = nearby(clean.points);
      const std::size_t off = drop_off_surface(clean, near, index);
      report.isolated += isolated;
      report.off_surface += off;
      if (isolated + off == 0) break;
    }
  }
  require_surface_points(clean.points, name);
  report.kept = clean.points.size();
  return clean;
}

}  // namespace hapsim
