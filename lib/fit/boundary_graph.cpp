#include "fit/boundary_graph.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hapsim {
namespace {

using PlanPoint = Eigen::Vector2d;

PlanPoint left_of(const PlanPoint& along) {
  return {-along.y(), along.x()};
}

}  // namespace

struct BoundaryGraph::Foot {
  std::size_t key[2] = {0, 0};
  double way = 0;       // from one to the other
  double distance = 0;  // positive on the left
  double size = std::numeric_limits<double>::infinity();
};

BoundaryGraph::BoundaryGraph(const std::vector<BoundaryLine>& lines,
                             const PlaneClassifier& classify, int keys, double join) {
  for (const BoundaryLine& boundary : lines) {
    std::vector<PlanPoint> points = key_points(boundary, keys);
    Line line;
    line.closed = (points.front() - points.back()).norm() < 1e-9;
    if (line.closed) points.pop_back();
    line.first = point_.size();
    line.count = points.size();
    if (line.count < (line.closed ? 3u : 2u)) continue;
    const std::size_t n = line.count;
    int votes = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const PlanPoint& before = line.closed ? points[(i + n - 1) % n] : points[i == 0 ? 0 : i - 1];
      const PlanPoint& after = line.closed ? points[(i + 1) % n] : points[std::min(i + 1, n - 1)];
      const PlanPoint normal = left_of(after - before).normalized();
      const double off = 0.25 * length(boundary) / (keys - 1);
      const int left = classify(points[i] + off * normal);
      const int right = classify(points[i] - off * normal);
      votes += left == boundary.a && right == boundary.b;
      votes -= left == boundary.b && right == boundary.a;
      point_.push_back(points[i]);
      normal_.push_back(normal);
    }
    line.left = votes >= 0 ? boundary.a : boundary.b;
    line.right = votes >= 0 ? boundary.b : boundary.a;
    line_.push_back(line);
  }
  for (Line& one : line_)
    for (int end = 0; end < 2; ++end)
      for (const Line& other : line_) {
        if (&one == &other || other.closed) continue;
        const PlanPoint& here = point_[one.first + (end == 0 ? 0 : one.count - 1)];
        for (const std::size_t there : {other.first, other.first + other.count - 1})
          if ((point_[there] - here).norm() < join) one.goes_on[end] = false;
      }
}

BoundaryGraph::Foot BoundaryGraph::foot_on(const Line& line, const PlanPoint& p) const {
  Foot best;
  const std::size_t segments = line.closed ? line.count : line.count - 1;
  for (std::size_t j = 0; j < segments; ++j) {
    const std::size_t from = line.first + j, to = line.first + (j + 1) % line.count;
    const PlanPoint along = point_[to] - point_[from];
    const double way = (p - point_[from]).dot(along) / std::max(along.squaredNorm(), 1e-300);
    const bool open_start = !line.closed && j == 0 && line.goes_on[0];
    const bool open_end = !line.closed && j + 1 == segments && line.goes_on[1];
    const double low = open_start ? -std::numeric_limits<double>::infinity() : 0;
    const double high = open_end ? std::numeric_limits<double>::infinity() : 1;
    const double foot = std::clamp(way, low, high);
    const PlanPoint off = p - (point_[from] + foot * along);
    if (off.norm() >= best.size) continue;
    best.size = off.norm();
    best.key[0] = from;
    best.key[1] = to;
    best.way = std::clamp(way, 0.0, 1.0);
    // At a corner the normal of the key point says which side it is.
    const PlanPoint side = foot == way ? left_of(along) : normal_[way < foot ? from : to];
    best.distance = off.dot(side) < 0 ? -best.size : best.size;
  }
  return best;
}

BoundaryGraph::Blend BoundaryGraph::at(const PlanPoint& p, const Eigen::VectorXd& shift,
                                       double width) const {
  const Line* nearest = nullptr;
  Foot foot;
  for (const Line& line : line_) {
    const Foot here = foot_on(line, p);
    if (nearest != nullptr && here.size >= foot.size) continue;
    foot = here;
    nearest = &line;
  }
  Blend blend;
  if (nearest == nullptr) return blend;
  blend.left = nearest->left;
  blend.right = nearest->right;
  const double weight[2] = {1 - foot.way, foot.way};
  double moved = foot.distance;
  for (int k = 0; k < 2; ++k) {
    blend.key[k] = foot.key[k];
    moved -= weight[k] * shift[static_cast<Eigen::Index>(foot.key[k])];
  }
  blend.share = std::clamp(0.5 + moved / width, 0.0, 1.0);
  if (blend.share > 0 && blend.share < 1)
    for (int k = 0; k < 2; ++k) blend.by_shift[k] = -weight[k] / width;
  return blend;
}

int BoundaryGraph::region(const PlanPoint& p, const Eigen::VectorXd& shift) const {
  const Blend blend = at(p, shift, 1e-9);
  return blend.share > 0.5 ? blend.left : blend.right;
}

std::vector<BoundaryLine> BoundaryGraph::lines(const Eigen::VectorXd& shift) const {
  std::vector<BoundaryLine> result;
  for (const Line& line : line_) {
    BoundaryLine moved{std::min(line.left, line.right), std::max(line.left, line.right), {}};
    for (std::size_t k = line.first; k < line.first + line.count; ++k)
      moved.points.emplace_back(point_[k] + shift[static_cast<Eigen::Index>(k)] * normal_[k]);
    if (line.closed) moved.points.push_back(moved.points.front());
    result.push_back(std::move(moved));
  }
  return result;
}

}  // namespace hapsim
