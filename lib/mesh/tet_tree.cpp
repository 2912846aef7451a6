#include "mesh/tet_tree.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

namespace hapsim {
namespace {

constexpr int kLeafTets = 4;
constexpr int kDeepestTets = 40;  // levels: halving reaches a leaf in fewer
constexpr double kOnFace = 1e-9;  // a share of a corner: rounding on a face between two

// The least of a point's four shares of the corners; negative outside.
double least_share(const std::array<Vec3, 4>& c, const Vec3& p) {
  const Vec3 a = c[1] - c[0], b = c[2] - c[0], d = c[3] - c[0], x = p - c[0];
  const Vec3 ab = a.cross(b);
  const double all = ab.dot(d);
  if (all == 0) return -1;
  const double of_3 = ab.dot(x) / all, of_2 = a.dot(x.cross(d)) / all,
               of_1 = x.dot(b.cross(d)) / all;
  return std::min({of_1, of_2, of_3, 1 - of_1 - of_2 - of_3});
}

}  // namespace

TetTree::TetTree(const TetMesh& mesh) : order_(mesh.tets.size()) {
  std::vector<Vec3> centre;
  for (const auto& t : mesh.tets) {
    corners_.push_back({mesh.nodes[t[0]], mesh.nodes[t[1]], mesh.nodes[t[2]], mesh.nodes[t[3]]});
    const auto& c = corners_.back();
    centre.push_back((c[0] + c[1] + c[2] + c[3]) / 4);
  }
  std::iota(order_.begin(), order_.end(), 0);
  if (!order_.empty()) build(centre, 0, static_cast<int>(order_.size()));
}

// Halved at the median along the longest side.
int TetTree::build(const std::vector<Vec3>& centre, int first, int count) {
  const int index = static_cast<int>(nodes_.size());
  nodes_.emplace_back();
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (int i = first; i < first + count; ++i)
    for (const Vec3& p : corners_[static_cast<std::size_t>(order_[static_cast<std::size_t>(i)])]) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
  const Vec3 slack = Vec3::Constant(kOnFace * (high - low).maxCoeff());
  nodes_[static_cast<std::size_t>(index)].low = low - slack;
  nodes_[static_cast<std::size_t>(index)].high = high + slack;
  if (count <= kLeafTets) {
    nodes_[static_cast<std::size_t>(index)].first = first;
    nodes_[static_cast<std::size_t>(index)].count = count;
    return index;
  }
  int axis = 0;
  (high - low).maxCoeff(&axis);
  const int half = count / 2;
  const auto begin = order_.begin() + first;
  std::nth_element(begin, begin + half, begin + count, [&](int a, int b) {
    return std::pair(centre[static_cast<std::size_t>(a)][axis], a) <
           std::pair(centre[static_cast<std::size_t>(b)][axis], b);
  });
  build(centre, first, half);
  const int right = build(centre, first + half, count - half);
  nodes_[static_cast<std::size_t>(index)].right = right;
  return index;
}

int TetTree::find(const Vec3& p) const {
  std::array<int, kDeepestTets> open{};
  int count = 0, best = -1;
  double most = -kOnFace;
  if (!nodes_.empty()) open[static_cast<std::size_t>(count++)] = 0;
  while (count > 0) {
    const int at = open[static_cast<std::size_t>(--count)];
    const Node& node = nodes_[static_cast<std::size_t>(at)];
    if ((p.array() < node.low.array()).any() || (p.array() > node.high.array()).any()) continue;
    if (node.right >= 0) {
      open[static_cast<std::size_t>(count++)] = node.right;
      open[static_cast<std::size_t>(count++)] = at + 1;
      continue;
    }
    for (int i = node.first; i < node.first + node.count; ++i) {
      const int t = order_[static_cast<std::size_t>(i)];
      const double share = least_share(corners_[static_cast<std::size_t>(t)], p);
      if (share > most) most = share, best = t;
      if (share >= 0) return t;
    }
  }
  return best;
}

}  // namespace hapsim
