#include "reconstruct/normals.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <tuple>
#include <utility>

#include "base/median.h"
#include "mesh/local_plane.h"
#include "mesh/point_index.h"

namespace hapsim {
namespace {

// Thickness over width of a neighbourhood that looks flat: noise tilts its normal by 7 degrees at
// most (the arc tangent).
constexpr double kThinPlane = 0.125;
constexpr int kLeastNear = 12;  // two rings about a point
constexpr int kMostNear = 192;  // four doublings: coarser than that is no longer the surface
constexpr int kGraph = 10;      // neighbours over which normals are turned alike

LocalPlane plane_through(const PointCloud& cloud, const std::vector<Neighbour>& near) {
  std::vector<Vec3> points;
  for (const Neighbour& n : near) points.push_back(cloud.points[n.index]);
  return fit_plane(points);
}

// Over which normals are turned alike: of each point its neighbours, and those that it is one of.
class Graph {
 public:
  Graph(std::size_t points, int neighbours)
      : of_(points), each_(static_cast<std::size_t>(std::max(kGraph, neighbours / 2))) {}
  // `near`: the nearest first.
  void add(int i, const std::vector<Neighbour>& near) {
    for (std::size_t k = 0; k < std::min(each_, near.size()); ++k) {
      if (near[k].index == i) continue;
      of_[i].push_back(near[k].index);
      of_[near[k].index].push_back(i);
    }
  }
  const std::vector<int>& of(int i) const { return of_[i]; }

 private:
  std::vector<std::vector<int>> of_;
  std::size_t each_;
};

// Smallest number of neighbours that makes the scan look flat, or the flattest tried.
int choose_neighbours(const PointCloud& cloud, const PointIndex& index) {
  const std::size_t step = std::max<std::size_t>(1, cloud.points.size() / 500);
  int best = kLeastNear;
  double best_ratio = 1e300;
  for (int k = kLeastNear; k <= kMostNear && k < static_cast<int>(cloud.points.size()) / 4;
       k *= 2) {
    std::vector<double> ratio;
    for (std::size_t i = 0; i < cloud.points.size(); i += step) {
      const LocalPlane plane = plane_through(cloud, index.nearest(cloud.points[i], k));
      ratio.push_back(plane.thickness / std::max(plane.spread[1], 1e-300));
    }
    const double middle = upper_median(ratio);
    if (middle < kThinPlane) return k;
    if (middle < best_ratio) {
      best_ratio = middle;
      best = k;
    }
  }
  return best;
}

// Points that are turned, and of the others the least step to them so far (weight, point it comes
// from): a larger one never comes to be theirs.
struct Turned {
  std::vector<char> done;
  std::vector<std::pair<double, int>> least;
  explicit Turned(std::size_t n)
      : done(n, 0), least(n, {std::numeric_limits<double>::infinity(), 0}) {}
};

// Turns the piece that holds `seed` alike (Prim); returns its points.
std::vector<int> spread_orientation(PointCloud& cloud, const Graph& graph, int seed,
                                    Turned& turned) {
  std::vector<int> piece;
  // Weight, point, point it comes from: ties fall to the lowest number, so the result is definite.
  using Step = std::tuple<double, int, int>;
  std::priority_queue<Step, std::vector<Step>, std::greater<>> open;
  open.emplace(0, seed, seed);
  while (!open.empty()) {
    const auto [weight, i, from] = open.top();
    open.pop();
    if (turned.done[i]) continue;
    turned.done[i] = 1;
    piece.push_back(i);
    if (cloud.normals[i].dot(cloud.normals[from]) < 0) cloud.normals[i] = -cloud.normals[i];
    for (const int j : graph.of(i)) {
      if (turned.done[j]) continue;
      const std::pair<double, int> step{1 - std::abs(cloud.normals[i].dot(cloud.normals[j])), i};
      if (step >= turned.least[j]) continue;
      turned.least[j] = step;
      open.emplace(step.first, j, i);
    }
  }
  return piece;
}

// Turns every piece outward, keeping the directions.
void orient_by(const Graph& graph, PointCloud& cloud, const Vec3& up, NormalsReport& report) {
  const int n = static_cast<int>(cloud.points.size());
  Vec3 centre = Vec3::Zero();
  for (const Vec3& p : cloud.points) centre += p;
  centre /= n;
  double size = 0;
  for (const Vec3& p : cloud.points) size += (p - centre).norm();
  size /= n;

  Turned turned(cloud.points.size());
  report.pieces = 0;
  for (int seed = 0; seed < n; ++seed) {
    if (turned.done[seed]) continue;
    ++report.pieces;
    const std::vector<int> piece = spread_orientation(cloud, graph, seed, turned);
    // Seen all round, the normals' part along `up` cancels; of a patch, it decides.
    double outward = 0;
    for (const int i : piece) {
      outward += cloud.normals[i].dot(cloud.points[i] - centre + 0.4 * size * up);
    }
    if (outward >= 0) continue;
    for (const int i : piece) cloud.normals[i] = -cloud.normals[i];
  }
}

}  // namespace

void estimate_normals(PointCloud& cloud, const Vec3& up, NormalsReport& report) {
  const PointIndex index(cloud.points);
  report.neighbours = choose_neighbours(cloud, index);
  cloud.normals.resize(cloud.points.size());
  std::vector<double> thickness;
  Graph graph(cloud.points.size(), report.neighbours);
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const std::vector<Neighbour> near = index.nearest(cloud.points[i], report.neighbours);
    graph.add(static_cast<int>(i), near);
    const LocalPlane plane = plane_through(cloud, near);
    cloud.normals[i] = plane.normal;
    thickness.push_back(plane.thickness);
  }
  report.noise = upper_median(thickness);
  orient_by(graph, cloud, up, report);
}

void sharpen_normals(PointCloud& cloud, double radius, double angle_deg, int rounds) {
  const PointIndex index(cloud.points);
  const std::size_t n = cloud.points.size();
  std::vector<std::vector<Neighbour>> near(n);
  for (std::size_t i = 0; i < n; ++i) near[i] = index.within(cloud.points[i], radius);
  const double scale = 1 - std::cos(angle_deg * M_PI / 180);
  for (int round = 0; round < rounds; ++round) {
    std::vector<Vec3> next(n);
    for (std::size_t i = 0; i < n; ++i) {
      Vec3 sum = Vec3::Zero();
      for (const Neighbour& m : near[i]) {
        const double turn = (1 - cloud.normals[i].dot(cloud.normals[m.index])) / scale;
        const double away = m.distance / radius;
        sum += std::exp(-turn * turn - 2 * away * away) * cloud.normals[m.index];
      }
      next[i] = sum.norm() > 1e-12 ? sum.normalized() : cloud.normals[i];
    }
    cloud.normals = std::move(next);
  }
}

}  // namespace hapsim
