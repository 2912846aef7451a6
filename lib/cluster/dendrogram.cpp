#include "cluster/dendrogram.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

namespace hapsim {
namespace {

// Distance of the union of a and b to c, from sizes and distances before.
double lance_williams(Linkage linkage, double a, double b, double c, double ac, double bc,
                      double ab) {
  switch (linkage) {
    case Linkage::kSingle:
      return std::min(ac, bc);
    case Linkage::kComplete:
      return std::max(ac, bc);
    case Linkage::kAverage:
      return (a * ac + b * bc) / (a + b);
    case Linkage::kWard:
      return std::sqrt(
          std::max(0.0, ((a + c) * ac * ac + (b + c) * bc * bc - c * ab * ab) / (a + b + c)));
  }
  return 0;
}

int root_of(std::vector<int>& parent, int i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

std::vector<std::vector<int>> members(const Dendrogram& tree) {
  std::vector<std::vector<int>> below(tree.leaves + tree.merges.size());
  for (int i = 0; i < tree.leaves; ++i) below[i] = {i};
  for (std::size_t m = 0; m < tree.merges.size(); ++m) {
    std::vector<int>& all = below[tree.leaves + m];
    all = below[tree.merges[m].left];
    const std::vector<int>& right = below[tree.merges[m].right];
    all.insert(all.end(), right.begin(), right.end());
  }
  return below;
}

}  // namespace

Eigen::MatrixXd scaled_distances(const Eigen::MatrixXd& samples, const Eigen::MatrixXd& errors) {
  const Eigen::Index n = samples.rows();
  const Eigen::MatrixXd variance = errors.array().square();
  Eigen::MatrixXd d = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < i; ++j) {
      double sum = 0;
      for (Eigen::Index c = 0; c < samples.cols(); ++c) {
        const double gap = samples(i, c) - samples(j, c);
        sum += 2 * gap * gap / (variance(i, c) + variance(j, c));
      }
      d(i, j) = d(j, i) = std::sqrt(sum);
    }
  return d;
}

Dendrogram agglomerate(const Eigen::MatrixXd& distances, Linkage linkage) {
  const int n = static_cast<int>(distances.rows());
  struct Joined {
    int a, b;
    double height;
  };
  std::vector<Joined> joined;  // by representatives, in order of the chains
  Eigen::MatrixXd d = distances;
  std::vector<double> size(n, 1);
  std::vector<int> active(n), chain;
  std::iota(active.begin(), active.end(), 0);
  while (active.size() > 1) {
    if (chain.empty()) chain.push_back(active.front());
    for (;;) {
      const int x = chain.back();
      const int before = chain.size() > 1 ? chain[chain.size() - 2] : -1;
      int nearest = before;  // which wins ties, so that chains end
      double least = before >= 0 ? d(before, x) : std::numeric_limits<double>::infinity();
      for (const int y : active)
        if (y != x && (d(y, x) < least || nearest < 0)) least = d(y, x), nearest = y;
      if (nearest != before) {
        chain.push_back(nearest);
        continue;
      }
      chain.resize(chain.size() - 2);
      joined.push_back({x, before, least});
      active.erase(std::find(active.begin(), active.end(), x));
      for (const int c : active)
        if (c != before)
          d(c, before) = d(before, c) =
              lance_williams(linkage, size[x], size[before], size[c], d(c, x), d(c, before), least);
      size[before] += size[x];
      break;
    }
  }
  std::stable_sort(joined.begin(), joined.end(),
                   [](const Joined& a, const Joined& b) { return a.height < b.height; });
  Dendrogram tree;
  tree.leaves = n;
  std::vector<int> parent(n), node(n), count(n, 1);
  std::iota(parent.begin(), parent.end(), 0);
  std::iota(node.begin(), node.end(), 0);
  for (const Joined& j : joined) {
    const int a = root_of(parent, j.a), b = root_of(parent, j.b);
    count[a] += count[b];
    tree.merges.push_back(
        {std::min(node[a], node[b]), std::max(node[a], node[b]), j.height, count[a]});
    parent[b] = a;
    node[a] = n + static_cast<int>(tree.merges.size()) - 1;
  }
  return tree;
}

std::vector<int> cut(const Dendrogram& tree, int clusters) {
  std::vector<int> parent(tree.leaves + tree.merges.size());
  std::iota(parent.begin(), parent.end(), 0);
  const int merges = tree.leaves - std::clamp(clusters, 1, std::max(1, tree.leaves));
  for (int m = 0; m < merges; ++m)
    parent[tree.merges[m].left] = parent[tree.merges[m].right] = tree.leaves + m;
  std::vector<int> label, number(parent.size(), -1);
  int next = 0;
  for (int i = 0; i < tree.leaves; ++i) {
    int& k = number[root_of(parent, i)];
    if (k < 0) k = next++;
    label.push_back(k);
  }
  return label;
}

Eigen::MatrixXd cophenetic_distances(const Dendrogram& tree) {
  Eigen::MatrixXd d = Eigen::MatrixXd::Zero(tree.leaves, tree.leaves);
  const auto below = members(tree);
  for (const Merge& merge : tree.merges)
    for (const int i : below[merge.left])
      for (const int j : below[merge.right]) d(i, j) = d(j, i) = merge.height;
  return d;
}

double cophenetic_correlation(const Eigen::MatrixXd& distances, const Dendrogram& tree) {
  const Eigen::MatrixXd l = cophenetic_distances(tree);
  const double pairs = 0.5 * tree.leaves * (tree.leaves - 1);
  const double mean_d = distances.sum() / 2 / pairs, mean_l = l.sum() / 2 / pairs;
  double dl = 0, dd = 0, ll = 0;
  for (int i = 0; i < tree.leaves; ++i)
    for (int j = 0; j < i; ++j) {
      const double a = distances(i, j) - mean_d, b = l(i, j) - mean_l;
      dl += a * b;
      dd += a * a;
      ll += b * b;
    }
  return dl / std::sqrt(dd * ll);
}

std::vector<double> inconsistency(const Dendrogram& tree, int depth) {
  std::vector<double> result;
  for (const Merge& merge : tree.merges) {
    std::vector<double> heights;
    const std::function<void(const Merge&, int)> gather = [&](const Merge& at, int levels) {
      heights.push_back(at.height);
      if (levels <= 1) return;
      for (const int child : {at.left, at.right})
        if (child >= tree.leaves) gather(tree.merges[child - tree.leaves], levels - 1);
    };
    gather(merge, depth);
    const Eigen::Map<const Eigen::VectorXd> h(heights.data(),
                                              static_cast<Eigen::Index>(heights.size()));
    const double deviation =
        h.size() < 2
            ? 0
            : std::sqrt((h.array() - h.mean()).square().sum() / static_cast<double>(h.size() - 1));
    result.push_back(deviation > 0 ? (merge.height - h.mean()) / deviation : 0);
  }
  return result;
}

std::vector<int> leaf_order(const Dendrogram& tree) {
  if (tree.merges.empty()) return std::vector<int>(tree.leaves, 0);
  return members(tree).back();
}

}  // namespace hapsim
