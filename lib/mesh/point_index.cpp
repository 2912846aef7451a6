#include "mesh/point_index.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <nanoflann.hpp>
#include <utility>

namespace hapsim {
namespace {

// What nanoflann asks of a set of points.
struct Adaptor {
  const std::vector<Vec3>& points;
  std::size_t kdtree_get_point_count() const { return points.size(); }
  double kdtree_get_pt(std::size_t i, std::size_t axis) const { return points[i][axis]; }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Adaptor>,
                                                 Adaptor, 3, std::uint32_t>;

std::vector<Neighbour> sorted(std::vector<Neighbour> found) {
  std::sort(found.begin(), found.end(), [](const Neighbour& a, const Neighbour& b) {
    return std::pair(a.distance, a.index) < std::pair(b.distance, b.index);
  });
  return found;
}

}  // namespace

struct PointIndex::Impl {
  explicit Impl(const std::vector<Vec3>& points) : adaptor{points}, tree(3, adaptor, {12}) {
    tree.buildIndex();
  }
  Adaptor adaptor;
  Tree tree;
};

PointIndex::PointIndex(const std::vector<Vec3>& points) : impl_(std::make_unique<Impl>(points)) {}
PointIndex::~PointIndex() = default;

std::vector<Neighbour> PointIndex::nearest(const Vec3& p, int k) const {
  const std::size_t count = std::min<std::size_t>(k, impl_->adaptor.points.size());
  if (count == 0) return {};
  std::vector<std::uint32_t> index(count);
  std::vector<double> squared(count);
  const std::size_t found = impl_->tree.knnSearch(p.data(), count, index.data(), squared.data());
  std::vector<Neighbour> result(found);
  for (std::size_t i = 0; i < found; ++i) {
    result[i] = {static_cast<int>(index[i]), std::sqrt(squared[i])};
  }
  return sorted(std::move(result));
}

std::vector<Neighbour> PointIndex::within(const Vec3& p, double radius) const {
  if (impl_->adaptor.points.empty()) return {};
  std::vector<std::pair<std::uint32_t, double>> matches;
  impl_->tree.radiusSearch(p.data(), radius * radius, matches, {32, 0, false});
  std::vector<Neighbour> result;
  result.reserve(matches.size());
  for (const auto& [index, squared] : matches) {
    result.push_back({static_cast<int>(index), std::sqrt(squared)});
  }
  return sorted(std::move(result));
}

}  // namespace hapsim
