#include "reconstruct/merge_points.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/median.h"

namespace hapsim {
namespace {

constexpr std::size_t kEnough = 100000;  // points that show any body's surface
constexpr double kWorthwhile = 1.5;      // points merged into one, at least
// Patches from which noise is known, and the points of each. Of fewer patches each is a good part
// of the body, whose shape would count as noise.
constexpr std::size_t kPatches = 200;
constexpr std::size_t kPatchPoints = 10;
// The rms of a part along its longest axis, over the distance of merged points. A part ends
// anywhere between this and half of it; on average, measured, the points lie as far apart as asked.
constexpr double kLongest = 0.4;
constexpr double kSameSide = 0.7;  // cosine between normals of one part

struct Item {
  Vec3 point;
  int index;
};

using Range = std::pair<Item*, Item*>;

struct Extent {
  Vec3 axis = Vec3::UnitX();  // the longest
  double longest = 0;         // rms [m]
  double thickness = 0;       // rms along the shortest [m]
};

Extent extent_of(Range range) {
  Extent e;
  const Vec3 origin = range.first->point;  // keeps the digits of squares
  Vec3 sum = Vec3::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  for (const Item* i = range.first; i != range.second; ++i) {
    const Vec3 d = i->point - origin;
    sum += d;
    squares += d * d.transpose();
  }
  const auto n = static_cast<double>(range.second - range.first);
  const Eigen::Matrix3d covariance = squares / n - sum * sum.transpose() / (n * n);
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(covariance);
  e.axis = solver.eigenvectors().col(2);
  e.longest = std::sqrt(std::max(0.0, solver.eigenvalues()[2]));
  e.thickness = std::sqrt(std::max(0.0, solver.eigenvalues()[0]));
  return e;
}

// Parts no longer than `longest`, in order; the thickness of the parts that tell noise.
std::vector<Range> split(const std::vector<Range>& parts, double longest,
                         std::vector<double>& thickness) {
  std::vector<Range> result, open;
  thickness.clear();
  for (const Range& part : parts) {
    open.push_back(part);
    while (!open.empty()) {
      const Range range = open.back();
      open.pop_back();
      const auto count = static_cast<std::size_t>(range.second - range.first);
      if (count > 1) {
        const Extent e = extent_of(range);
        Item* middle = range.first;
        if (e.longest > longest) {
          double low = 1e300, high = -1e300;
          for (const Item* i = range.first; i != range.second; ++i) {
            const double at = e.axis.dot(i->point);
            low = std::min(low, at);
            high = std::max(high, at);
          }
          const double at = (low + high) / 2;
          middle = std::partition(range.first, range.second,
                                  [&](const Item& i) { return e.axis.dot(i.point) < at; });
        }
        if (middle != range.first && middle != range.second) {
          open.emplace_back(middle, range.second);
          open.emplace_back(range.first, middle);
          continue;
        }
        // Three of the points' freedoms are the plane's.
        if (count >= kPatchPoints)
          thickness.push_back(e.thickness * std::sqrt(count / (static_cast<double>(count) - 3)));
      }
      result.push_back(range);
    }
  }
  return result;
}

// By the normals: those of one side first.
void split_sides(const std::vector<Vec3>& normals, std::vector<Range>& parts) {
  std::vector<Range> result;
  for (Range range : parts) {
    while (range.first != range.second) {
      const Vec3 first = normals[static_cast<std::size_t>(range.first->index)];
      Item* end = std::partition(range.first, range.second, [&](const Item& i) {
        return normals[static_cast<std::size_t>(i.index)].dot(first) > kSameSide;
      });
      if (end == range.first) ++end;  // a normal that is none
      result.emplace_back(range.first, end);
      range.first = end;
    }
  }
  parts = std::move(result);
}

// As small as asked, or as a surface asks for.
std::vector<Range> parts_of(Range all, double asked, MergeReport& report) {
  std::vector<double> thickness;
  if (asked > 0) {
    report.asked = true;
    report.spacing = asked;
    return split({all}, kLongest * asked, thickness);
  }
  std::vector<Range> parts{all};
  const double whole = extent_of(all).longest / kLongest;
  // Each step makes twice as many; the last that made no more than enough counts.
  for (double spacing = whole; spacing > 1e-9 * whole; spacing /= std::sqrt(2.0)) {
    if (report.noise > 0 && spacing < kMergeNoises * report.noise) break;
    std::vector<Range> finer = split(parts, kLongest * spacing, thickness);
    if (finer.size() > kEnough) break;
    parts = std::move(finer);
    report.spacing = spacing;
    if (kWorthwhile * static_cast<double>(parts.size()) > static_cast<double>(report.before)) break;
    if (parts.size() >= kPatches && thickness.size() >= kPatches / 2)
      report.noise = upper_median(thickness);
  }
  return parts;
}

}  // namespace

MergedPoints merge_points(const PointCloud& cloud, double spacing, MergeReport& report) {
  const std::size_t n = cloud.points.size();
  report = {};
  report.before = report.after = n;
  const auto as_given = [&] {
    MergedPoints all{cloud, std::vector<int>(n), std::vector<int>(n, 1)};
    std::iota(all.index.begin(), all.index.end(), 0);
    return all;
  };
  if (n < 2) return as_given();
  std::vector<Item> items(n);
  for (std::size_t i = 0; i < n; ++i) items[i] = {cloud.points[i], static_cast<int>(i)};
  std::vector<Range> parts = parts_of({items.data(), items.data() + n}, spacing, report);
  if (spacing <= 0 && kWorthwhile * static_cast<double>(parts.size()) > static_cast<double>(n))
    return as_given();
  if (!cloud.normals.empty()) split_sides(cloud.normals, parts);

  struct Merged {
    int index, count;
    Vec3 point, normal;
  };
  std::vector<Merged> merged;
  merged.reserve(parts.size());
  for (const Range& range : parts) {
    Merged m{0, static_cast<int>(range.second - range.first), Vec3::Zero(), Vec3::Zero()};
    for (const Item* i = range.first; i != range.second; ++i) {
      m.point += i->point;
      if (!cloud.normals.empty()) m.normal += cloud.normals[static_cast<std::size_t>(i->index)];
    }
    m.point /= m.count;
    if (m.normal.squaredNorm() > 0) m.normal.normalize();
    const auto farther = [&](const Item& a, const Item& b) {
      return std::pair((a.point - m.point).squaredNorm(), a.index) <
             std::pair((b.point - m.point).squaredNorm(), b.index);
    };
    m.index = std::min_element(range.first, range.second, farther)->index;
    merged.push_back(m);
  }
  std::sort(merged.begin(), merged.end(),
            [](const Merged& a, const Merged& b) { return a.index < b.index; });
  MergedPoints result;
  for (const Merged& m : merged) {
    result.index.push_back(m.index);
    result.count.push_back(m.count);
    result.cloud.points.push_back(m.point);
    if (!cloud.normals.empty()) result.cloud.normals.push_back(m.normal);
  }
  report.after = merged.size();
  return result;
}

}  // namespace hapsim
