#include "scan/plan_scan.h"

#include <algorithm>
#include <cmath>

#include "reconstruct/clean_points.h"

namespace hapsim {
namespace {

// Rotation that carries the frame about `from` (unit) to the one about `to`, turned by `roll`.
Eigen::Matrix3d carry(const Vec3& from, const Vec3& to, const Vec3& to_side, double roll) {
  Eigen::Matrix3d a, b;
  const Vec3 side = any_square_to(from);
  a << from, side, from.cross(side);
  const Vec3 turned = Eigen::AngleAxisd(roll, to) * to_side;
  b << to, turned, to.cross(turned);
  return b * a.transpose();
}

// What the pose before turned the sensor's side to, made square to `direction`.
Vec3 side_as_before(const Vec3& side, const Vec3& direction) {
  const Vec3 flat = side - side.dot(direction) * direction;
  return flat.norm() > 1e-3 ? Vec3(flat.normalized()) : any_square_to(direction);
}

bool in_region(const Vec3& p, const std::optional<Region>& region) {
  if (!region) return true;
  const auto& [x0, y0, x1, y1] = *region;
  return p.x() >= x0 && p.x() <= x1 && p.y() >= y0 && p.y() <= y1;
}

}  // namespace

std::vector<Target> raster_on_surface(const PointCloud& cloud, double pitch,
                                      const std::optional<Region>& region, double steepest) {
  const PointCloud thin = thin_points(cloud, pitch);
  std::vector<Target> targets;
  for (std::size_t i = 0; i < thin.points.size(); ++i) {
    const double up = std::clamp(thin.normals[i].z(), -1.0, 1.0);
    if (!in_region(thin.points[i], region) || std::acos(up) > steepest) continue;
    targets.push_back({thin.points[i], thin.normals[i]});
  }
  const auto row = [pitch](const Target& t) { return std::lround(t.point.y() / pitch); };
  std::sort(targets.begin(), targets.end(), [&](const Target& a, const Target& b) {
    if (row(a) != row(b)) return row(a) < row(b);
    return row(a) % 2 == 0 ? a.point.x() < b.point.x() : a.point.x() > b.point.x();
  });
  return targets;
}

std::vector<Target> raster_on_grid(const Region& region, double pitch, double height) {
  const auto& [x0, y0, x1, y1] = region;
  const auto steps = [pitch](double from, double to) {
    return static_cast<long>(std::floor((to - from) / pitch + 1e-9));
  };
  std::vector<Target> targets;
  const long nx = steps(x0, x1), ny = steps(y0, y1);
  for (long j = 0; j <= ny; ++j) {
    for (long i = 0; i <= nx; ++i) {
      const long k = j % 2 == 0 ? i : nx - i;
      targets.push_back(
          {Vec3(x0 + static_cast<double>(k) * pitch, y0 + static_cast<double>(j) * pitch, height),
           Vec3::UnitZ()});
    }
  }
  return targets;
}

ScanPlan plan_scan(const Robot& robot, const Beam& beam, double standoff,
                   const std::vector<Target>& targets) {
  constexpr int kRolls = 8;
  const Pose from_sensor = beam.mount.inverse();
  ScanPlan plan;
  Eigen::VectorXd now = robot.middle();
  for (std::size_t t = 0; t < targets.size(); ++t) {
    const Vec3 direction = -targets[t].normal;
    const Pose sensor_now = beam.object.inverse() * robot.forward(now) * beam.mount;
    const Vec3 side =
        side_as_before(sensor_now.linear() * any_square_to(beam.direction), direction);
    Pose sensor = Pose::Identity();
    sensor.translation() = targets[t].point + standoff * targets[t].normal;
    std::optional<Eigen::VectorXd> best;
    double least = 0;
    for (int k = 0; k < kRolls; ++k) {
      // 0, 45, -45, 90, ...
      const double roll = M_PI / 4 * ((k + 1) / 2) * (k % 2 == 0 ? -1 : 1);
      sensor.linear() = carry(beam.direction, direction, side, roll);
      const auto q = robot.inverse(beam.object * sensor * from_sensor, now);
      if (!q) continue;
      const double move = (*q - now).cwiseAbs().maxCoeff();
      if (best && move >= least) continue;
      best = q;
      least = move;
      if (least < 0.3) break;  // a small step: no need to look further
    }
    if (!best) {
      plan.unreachable.push_back(static_cast<int>(t));
      continue;
    }
    now = *best;
    plan.poses.push_back({static_cast<int>(t), *best});
  }
  return plan;
}

PointCloud sample_surface(const Surface& surface, double spacing) {
  PointCloud cloud;
  for (std::size_t f = 0; f < surface.faces.size(); ++f) {
    Vec3 normal = face_normal(surface, static_cast<int>(f));
    if (normal.norm() == 0) continue;
    normal.normalize();
    const Vec3 &a = surface.vertices[static_cast<std::size_t>(surface.faces[f][0])],
               &b = surface.vertices[static_cast<std::size_t>(surface.faces[f][1])],
               &c = surface.vertices[static_cast<std::size_t>(surface.faces[f][2])];
    const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
    const int n = static_cast<int>(std::clamp(std::ceil(longest / spacing), 1.0, 1000.0));
    // Centres of the n^2 equal parts of the triangle.
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n - i; ++j) {
        const auto add = [&](double u, double v) {
          cloud.points.push_back(a + (b - a) * u / n + (c - a) * v / n);
          cloud.normals.push_back(normal);
        };
        add(i + 1. / 3, j + 1. / 3);
        if (i + j < n - 1) add(i + 2. / 3, j + 2. / 3);
      }
    }
  }
  return cloud;
}

}  // namespace hapsim
