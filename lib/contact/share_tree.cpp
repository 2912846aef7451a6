#include "contact/share_tree.h"

#include <algorithm>
#include <numeric>

#include "solid/inhomogeneity.h"

namespace hapsim {
namespace {

constexpr std::size_t kLeaf = 8;  // tetrahedra

}  // namespace

ShareTree::ShareTree(const TetMesh& mesh, const std::vector<Eigen::Matrix3d>& share)
    : mesh_(&mesh), share_(share), order_(mesh.tets.size()) {
  std::iota(order_.begin(), order_.end(), std::size_t{0});
  std::vector<Vec3> centre;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) centre.push_back(tet_centroid(mesh, t));
  if (!order_.empty()) build(0, order_.size(), centre);
}

// Halved at the median along the longest side.
std::size_t ShareTree::build(std::size_t first, std::size_t last, const std::vector<Vec3>& centre) {
  const std::size_t at = nodes_.size();
  nodes_.emplace_back();
  Node node;
  node.first = first;
  node.last = last;
  Vec3 low = centre[order_[first]], high = low;
  for (std::size_t i = first; i < last; ++i) {
    low = low.cwiseMin(centre[order_[i]]);
    high = high.cwiseMax(centre[order_[i]]);
    node.sum += share_[order_[i]];
  }
  node.centre = 0.5 * (low + high);
  for (std::size_t i = first; i < last; ++i)
    for (int a = 0; a < 4; ++a)
      node.reach =
          std::max(node.reach, (mesh_->nodes[mesh_->tets[order_[i]][a]] - node.centre).norm());
  if (last - first > kLeaf) {
    Eigen::Index axis = 0;
    (high - low).maxCoeff(&axis);
    const std::size_t middle = first + (last - first) / 2;
    std::nth_element(
        order_.begin() + static_cast<std::ptrdiff_t>(first),
        order_.begin() + static_cast<std::ptrdiff_t>(middle),
        order_.begin() + static_cast<std::ptrdiff_t>(last),
        [&](std::size_t a, std::size_t b) { return centre[a][axis] < centre[b][axis]; });
    build(first, middle, centre);
    node.right = build(middle, last, centre);
  }
  nodes_[at] = node;
  return at;
}

ShareTree::Inside ShareTree::inside(const LevelSet& level, std::size_t parameters) const {
  Inside result{Eigen::Matrix3d::Zero(),
                std::vector<Eigen::Matrix3d>(parameters, Eigen::Matrix3d::Zero())};
  Eigen::RowVectorXd by(static_cast<Eigen::Index>(parameters));
  std::vector<std::size_t> open;
  if (!nodes_.empty()) open.push_back(0);
  while (!open.empty()) {
    const std::size_t at = open.back();
    open.pop_back();
    const Node& node = nodes_[at];
    const LevelValue value = level(node.centre);
    if (value.clear > node.reach) {
      if (value.value < 0) result.share += node.sum;
      continue;
    }
    if (node.right > 0) {
      open.push_back(node.right);
      open.push_back(at + 1);
      continue;
    }
    for (std::size_t i = node.first; i < node.last; ++i) {
      const std::size_t t = order_[i];
      const double share = inside_share(*mesh_, t, level, 1, by);
      if (share <= 0) continue;
      result.share += share * share_[t];
      for (std::size_t v = 0; v < parameters; ++v)
        result.by_parameters[v] += by[static_cast<Eigen::Index>(v)] * share_[t];
    }
  }
  return result;
}

}  // namespace hapsim
