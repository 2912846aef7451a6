#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "base/median.h"
#include "reconstruct/patches.h"

namespace hapsim {
namespace {

constexpr int kLocal = 24;      // points in a quadratic fit
constexpr double kPlain = 1.2;  // a plane may fit this much worse than quadratic pieces

// Robust plane: Tukey weights with the scale of the median.
LocalPlane robust_plane(const std::vector<Vec3>& points, double& rms) {
  LocalPlane plane = fit_plane(points);
  std::vector<double> weight(points.size(), 1);
  std::vector<double> size(points.size());
  for (int round = 0; round < 5; ++round) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      size[i] = std::abs(plane.normal.dot(points[i] - plane.centre));
    }
    rms = std::max(1.4826 * upper_median(size), 1e-12);
    const double cut = 4.685 * rms;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double t = std::max(0.0, 1 - size[i] * size[i] / (cut * cut));
      weight[i] = t * t;
    }
    plane = fit_plane(points, weight);
  }
  return plane;
}

double median_size(std::vector<double> v) {
  for (double& x : v) x = std::abs(x);
  return 1.4826 * upper_median(std::move(v));
}

}  // namespace

Patch::Patch(Patch&&) noexcept = default;
Patch::~Patch() = default;

Patch::Patch(PointCloud cloud)
    : cloud_(std::make_unique<PointCloud>(std::move(cloud))),
      index_(std::make_unique<PointIndex>(cloud_->points)) {
  const std::vector<Vec3>& points = cloud_->points;
  double flat = 0;
  plane_ = robust_plane(points, flat);
  Vec3 outward = Vec3::Zero();
  for (const Vec3& n : cloud_->normals) outward += n;
  if (plane_.normal.dot(outward) < 0) plane_.normal = -plane_.normal;
  // A point's own quadratic fit runs nearer to it by the share of its six unknowns.
  std::vector<double> off;
  const std::size_t step = std::max<std::size_t>(1, points.size() / 300);
  for (std::size_t i = 0; i < points.size(); i += step) {
    off.push_back(local_height(points[i]).value);
  }
  const double share =
      std::min(0.75, 6.0 / std::min<double>(kLocal, static_cast<double>(points.size())));
  const double bent = median_size(off) / std::sqrt(1 - share);
  planar_ = points.size() < 12 || flat < kPlain * bent;
  noise_ = planar_ ? flat : bent;
}

double Patch::distance_to_points(const Vec3& p) const {
  return index_->nearest(p, 1).front().distance;
}

Patch::Height Patch::height(const Vec3& p) const {
  if (planar_) return {plane_.normal.dot(p - plane_.centre), plane_.normal};
  return local_height(p);
}

Patch::Height Patch::local_height(const Vec3& p) const {
  const std::vector<Neighbour> near = index_->nearest(p, kLocal);
  const double reach = near.back().distance;
  std::vector<Vec3> points;
  std::vector<double> weight;
  Vec3 outward = Vec3::Zero();
  for (const Neighbour& n : near) {
    points.push_back(cloud_->points[n.index]);
    outward += cloud_->normals[n.index];
    const double away = n.distance / std::max(reach, 1e-300);
    weight.push_back(std::exp(-1.5 * away * away));
  }
  const LocalPlane plane = fit_plane(points, weight);
  Vec3 n = plane.normal;
  if (n.dot(outward) < 0) n = -n;
  const Vec3 u = n.unitOrthogonal(), v = n.cross(u);
  Eigen::Matrix<double, 6, 6> a = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Matrix<double, 6, 1> right = Eigen::Matrix<double, 6, 1>::Zero();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 d = (points[i] - plane.centre) / reach;
    const double s = d.dot(u), t = d.dot(v), h = d.dot(n);
    const Eigen::Matrix<double, 6, 1> row{1, s, t, s * s, s * t, t * t};
    a += weight[i] * row * row.transpose();
    right += weight[i] * h * row;
  }
  // A trace of stiffness keeps the continuation beside the points tame.
  for (int k = 3; k < 6; ++k) a(k, k) += 0.02;
  const Eigen::Matrix<double, 6, 1> c = a.ldlt().solve(right);
  const Vec3 d = (p - plane.centre) / reach;
  const double s = d.dot(u), t = d.dot(v);
  const double ds = c[1] + 2 * c[3] * s + c[4] * t, dt = c[2] + c[4] * s + 2 * c[5] * t;
  const Vec3 normal = (n - ds * u - dt * v).normalized();
  const double height =
      d.dot(n) - (c[0] + c[1] * s + c[2] * t + c[3] * s * s + c[4] * s * t + c[5] * t * t);
  return {reach * height * normal.dot(n), normal};
}

}  // namespace hapsim
