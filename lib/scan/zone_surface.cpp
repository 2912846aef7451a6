#include "scan/zone_surface.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "mesh/local_plane.h"
#include "reconstruct/clean_points.h"
#include "robot/pose.h"

namespace hapsim {
namespace {

constexpr int kNeighbours = 16;

}  // namespace

ZoneSurface::ZoneSurface(const std::vector<Vec3>& points)
    : points_(points), index_(points_), spacing_(point_spacing(points)) {}

bool ZoneSurface::foot(const Vec3& p, double reach, Foot& foot) const {
  const std::vector<Neighbour> near = index_.nearest(p, kNeighbours);
  // Nearer than the reach, apart from the gap between points.
  if (near.empty() || near.front().distance > std::hypot(reach, spacing_)) return false;
  std::vector<Vec3> neighbours;
  for (const Neighbour& n : near) {
    neighbours.push_back(points_[static_cast<std::size_t>(n.index)]);
  }
  const LocalPlane plane = fit_plane(neighbours);
  const Vec3 u = any_square_to(plane.normal), v = plane.normal.cross(u);
  const Vec3 off = p - plane.centre;
  const Eigen::Vector2d at(off.dot(u), off.dot(v));

  // Beyond the rim all neighbours lie to one side: their mean is far from p.
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  double width = 0;
  const int count = static_cast<int>(neighbours.size());
  Eigen::MatrixXd a(count, count >= 9 ? 6 : 3);
  Eigen::VectorXd h(count);
  for (int i = 0; i < count; ++i) {
    const Vec3 d = neighbours[static_cast<std::size_t>(i)] - plane.centre;
    const Eigen::Vector2d q = Eigen::Vector2d(d.dot(u), d.dot(v)) - at;
    mean += q / count;
    width += q.squaredNorm() / count;
    a.row(i).head<3>() << 1, q.x(), q.y();
    if (a.cols() == 6) a.row(i).tail<3>() << q.x() * q.x(), q.x() * q.y(), q.y() * q.y();
    h[i] = d.dot(plane.normal);
  }
  if (mean.norm() > 0.3 * std::sqrt(width)) return false;
  const Eigen::VectorXd c = a.colPivHouseholderQr().solve(h);
  // The quadric's height and slope below p.
  const Vec3 normal = plane.normal - c[1] * u - c[2] * v;
  const double steep = normal.norm();
  foot.normal = normal / steep;
  foot.distance = (off.dot(plane.normal) - c[0]) / steep;
  const double freedom = std::max<double>(1, static_cast<double>(count - a.cols()));
  foot.blur = std::sqrt((a * c - h).squaredNorm() / freedom);
  return std::abs(foot.distance) <= reach;
}

}  // namespace hapsim
