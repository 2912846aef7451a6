#include "cluster/class_boundary.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

namespace hapsim {
namespace {

using Vec2d = Eigen::Vector2d;

// Crossings get a number each, so that segments of neighbouring triangles join exactly.
class Tracer {
 public:
  Tracer(const PlaneClassifier& classify, const Vec2d& low, const Vec2d& high, int scan_points)
      : classify_(classify), low_(low) {
    const Vec2d size = high - low;
    cell_ = std::sqrt(size.x() * size.y() / std::max(4, scan_points));
    nx_ = std::max(1, static_cast<int>(std::lround(size.x() / cell_)));
    ny_ = std::max(1, static_cast<int>(std::lround(size.y() / cell_)));
    step_ = {size.x() / nx_, size.y() / ny_};
    for (int j = 0; j <= ny_; ++j)
      for (int i = 0; i <= nx_; ++i) label_.push_back(classify_(at(j * (nx_ + 1) + i)));
  }

  std::vector<BoundaryLine> lines() {
    for (int j = 0; j < ny_; ++j)
      for (int i = 0; i < nx_; ++i) {
        const int a = j * (nx_ + 1) + i, b = a + 1, c = a + nx_ + 1, d = c + 1;
        cut_triangle({a, b, d});
        cut_triangle({a, d, c});
      }
    std::vector<BoundaryLine> result;
    for (auto& [pair, links] : links_) chain(pair, links, result);
    std::stable_sort(result.begin(), result.end(), [](const auto& p, const auto& q) {
      return p.a != q.a ? p.a < q.a : p.b != q.b ? p.b < q.b : length(p) > length(q);
    });
    return result;
  }

 private:
  using Links = std::map<int, std::vector<int>>;  // crossing: its neighbours

  Vec2d at(int point) const {
    const int row = point / (nx_ + 1), column = point % (nx_ + 1);
    return low_ + Vec2d(column * step_.x(), row * step_.y());
  }

  int crossing(int p, int q) {
    const auto key = std::minmax(p, q);
    const auto [entry, added] = number_.try_emplace(key, static_cast<int>(points_.size()));
    if (!added) return entry->second;
    Vec2d from = at(key.first), to = at(key.second);
    for (int halving = 0; halving < 10; ++halving) {
      const Vec2d middle = 0.5 * (from + to);
      (classify_(middle) == label_[key.first] ? from : to) = middle;
    }
    points_.emplace_back(0.5 * (from + to));
    return entry->second;
  }

  void link(int p, int q, int a, int b) {
    Links& links = links_[std::minmax(a, b)];
    links[p].push_back(q);
    links[q].push_back(p);
  }

  void cut_triangle(const std::array<int, 3>& t) {
    const std::array<int, 3> k{label_[t[0]], label_[t[1]], label_[t[2]]};
    if (k[0] < 0 || k[1] < 0 || k[2] < 0) return;
    if (k[0] != k[1] && k[1] != k[2] && k[2] != k[0]) {
      const int middle = static_cast<int>(points_.size());
      points_.emplace_back((at(t[0]) + at(t[1]) + at(t[2])) / 3);
      for (int e = 0; e < 3; ++e)
        link(crossing(t[e], t[(e + 1) % 3]), middle, k[e], k[(e + 1) % 3]);
      return;
    }
    for (int e = 0; e < 3; ++e) {  // the corner that differs from the two others
      const int f = (e + 1) % 3, g = (e + 2) % 3;
      if (k[f] == k[g] && k[e] != k[f])
        link(crossing(t[e], t[f]), crossing(t[e], t[g]), k[e], k[f]);
    }
  }

  void chain(const std::pair<int, int>& pair, Links& links, std::vector<BoundaryLine>& result) {
    const auto follow = [&](int start) {
      BoundaryLine line{pair.first, pair.second, {points_[start]}};
      int here = start;
      while (!links[here].empty()) {
        const int next = links[here].back();
        links[here].pop_back();
        std::vector<int>& back = links[next];
        back.erase(std::find(back.begin(), back.end(), here));
        line.points.push_back(points_[next]);
        here = next;
      }
      result.push_back(std::move(line));
    };
    for (auto& [point, neighbours] : links)
      while (neighbours.size() == 1) follow(point);  // open ends first
    for (auto& [point, neighbours] : links)
      while (!neighbours.empty()) follow(point);
  }

  const PlaneClassifier& classify_;
  Vec2d low_, step_;
  double cell_ = 0;
  int nx_ = 1, ny_ = 1;
  std::vector<int> label_;
  std::vector<Vec2d> points_;
  std::map<std::pair<int, int>, int> number_;
  std::map<std::pair<int, int>, Links> links_;
};

}  // namespace

std::vector<BoundaryLine> class_boundaries(const PlaneClassifier& classify, const Vec2d& low,
                                           const Vec2d& high, int scan_points) {
  return Tracer(classify, low, high, scan_points).lines();
}

double length(const BoundaryLine& line) {
  double sum = 0;
  for (std::size_t i = 1; i < line.points.size(); ++i)
    sum += (line.points[i] - line.points[i - 1]).norm();
  return sum;
}

std::vector<Vec2d> key_points(const BoundaryLine& line, int count) {
  const double step = length(line) / (count - 1);
  std::vector<Vec2d> result{line.points.front()};
  double passed = 0;
  for (std::size_t i = 1; i < line.points.size(); ++i) {
    const Vec2d from = line.points[i - 1], along = line.points[i] - from;
    const double part = along.norm();
    while (static_cast<int>(result.size()) < count - 1 &&
           passed + part >= step * static_cast<double>(result.size()))
      result.emplace_back(from +
                          (step * static_cast<double>(result.size()) - passed) / part * along);
    passed += part;
  }
  result.push_back(line.points.back());
  return result;
}

double distance_to(const std::vector<BoundaryLine>& lines, const Vec2d& point) {
  double least = std::numeric_limits<double>::infinity();
  for (const BoundaryLine& line : lines)
    for (std::size_t i = 1; i < line.points.size(); ++i) {
      const Vec2d from = line.points[i - 1], along = line.points[i] - from;
      const double share =
          std::clamp((point - from).dot(along) / std::max(along.squaredNorm(), 1e-300), 0.0, 1.0);
      least = std::min(least, (from + share * along - point).norm());
    }
  return least;
}

}  // namespace hapsim
