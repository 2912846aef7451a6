#include "geometry/reconstruct.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "geometry/clean_points.h"
#include "geometry/normals.h"
#include "geometry/reconstruct_parts.h"
#include "geometry/surface_tree.h"
#include "geometry/tetgen.h"

namespace hapsim {
namespace {

constexpr double kSeenBelow = 0.5;  // share of the plan view: a scan from all round
constexpr double kRest = 0.05;      // share of the height cut off such a body so that it can stand
constexpr double kFaces = 2000;     // wished when --edge is not given

// The direction that is up, from the normals when it is to be found.
Vec3 find_up(const PointCloud& cloud, const ReconstructOptions& options) {
  if (options.up) return options.up->normalized();
  Vec3 mean = Vec3::Zero();
  for (const Vec3& n : cloud.normals) mean += n;
  mean /= static_cast<double>(cloud.normals.size());
  // A scan from all round has no mean normal, one from above a long one.
  if (mean.norm() < 0.3 || mean.z() > 0.5 * mean.norm()) return Vec3::UnitZ();
  return mean.normalized();
}

PointCloud rotated(const PointCloud& cloud, const Eigen::Matrix3d& r) {
  PointCloud turned = cloud;
  for (Vec3& p : turned.points) p = r * p;
  for (Vec3& n : turned.normals) n = r * n;
  return turned;
}

std::string percent(double share) {
  return fmt::format("{:.0f} %", 100 * share);
}

// Chooses height or poisson and says why; sets has_base.
void choose_method(const ScanView& view, const ReconstructOptions& options,
                   ReconstructReport& report) {
  const bool all_round = view.under_cover > kSeenBelow;
  const bool has_sides = view.ring_cover >= 0.7;
  report.has_base = !(all_round && options.no_base);
  if (options.method == ReconstructMethod::kHeight) {
    report.method = "height";
    report.why = "asked for";
    report.has_base = true;
  } else if (options.method == ReconstructMethod::kPoisson) {
    report.method = "poisson";
    report.why = "asked for";
  } else if (all_round) {
    report.method = "poisson";
    report.why = percent(view.under_cover) + " of the plan view was seen from below too";
  } else if (has_sides) {
    report.method = "poisson";
    report.why = "side walls reach down in " + percent(view.ring_cover) + " of the directions";
  } else {
    report.method = "height";
    report.why = "side walls reach down in only " + percent(view.ring_cover) + " of the directions";
  }
}

void choose_base(const ScanView& view, const ReconstructOptions& options, const std::string& name,
                 ReconstructReport& report) {
  if (options.base) {
    report.base = *options.base;
    report.base_why = "as given";
    if (report.base > view.low + 0.5 * (view.high - view.low)) {
      fail_input(name,
                 fmt::format("the base at {:.6g} m lies above half of the body, which spans {:.6g} "
                             "to {:.6g} m",
                             report.base, view.low, view.high),
                 "give --base below the points, in metres");
    }
    return;
  }
  if (options.base_depth) {
    report.base = view.low - *options.base_depth;
    report.base_why = fmt::format("{:.6g} m below the lowest points", *options.base_depth);
    return;
  }
  if (view.under_cover > kSeenBelow && report.method == "poisson") {
    report.base = view.low + kRest * (view.high - view.low);
    report.base_why =
        "cut flat as a support 5 % above the lowest points; --no-base leaves it round";
    return;
  }
  // Scanners stop short of the table; a lowest level within the reach of sampling above the frame's
  // own plane means that plane.
  const double reach = std::max(2 * view.spacing, 0.05 * (view.high - view.low));
  if (std::abs(view.low) < reach && !report.tilted) {
    report.base = 0;
    report.base_why = fmt::format("the frame's z = 0, {:.2g} m from the lowest points", view.low);
  } else if (report.method == "poisson") {
    report.base = view.low;
    report.base_why = "the lowest level of the points; --base sets another";
  } else {
    const double depth = 0.25 * std::sqrt(view.area);
    report.base = view.low - depth;
    report.base_why =
        fmt::format("a guess, {:.2g} m below the lowest points; --base-depth sets it", depth);
  }
}

// Fails with kNoConvergence where the result is no body: our fault, not the input's.
void require_body(const Surface& surface, const std::string& name) {
  try {
    check_surface(surface, name);
    check_self_intersection(surface, name);
  } catch (const Error& error) {
    fail_numerics("", std::string("the reconstructed surface fails its check: ") + error.what(),
                  "try another --edge or --method");
  }
}

void measure(const Surface& surface, const std::vector<Vec3>& points, ReconstructReport& report) {
  const SurfaceTree tree(surface);
  double sum = 0;
  std::vector<double> distance;
  for (const Vec3& p : points) {
    distance.push_back(tree.nearest(p).distance);
    sum += distance.back() * distance.back();
  }
  const auto n = static_cast<double>(points.size());
  report.rms = std::sqrt(sum / n);
  report.far_share =
      static_cast<double>(std::count_if(distance.begin(), distance.end(),
                                        [&](double d) { return d > 3 * report.rms; })) /
      n;
}

}  // namespace

Surface reconstruct(const PointCloud& cloud, const ReconstructOptions& options,
                    const std::string& name, ReconstructReport& report) {
  report = {};
  require_surface_points(cloud.points, name);
  PointCloud scan = cloud;
  if (scan.normals.empty()) {
    NormalsReport normals;
    estimate_normals(scan, options.up.value_or(Vec3::UnitZ()), normals);
  }
  report.up = find_up(scan, options);
  report.tilted = report.up.z() < 1 - 1e-12;
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  if (report.tilted) {
    turn = Eigen::Quaterniond::FromTwoVectors(report.up, Vec3::UnitZ()).toRotationMatrix();
    scan = rotated(scan, turn);
  }
  const ScanView view = view_scan(scan);
  choose_method(view, options, report);
  if (report.has_base) choose_base(view, options, name, report);

  // The bottom and, for a patch, the walls come on top of what was scanned.
  const double area = 1.4 * view.area;
  report.edge = options.edge > 0
                    ? options.edge
                    : std::max(std::sqrt(area / kFaces * 4 / std::sqrt(3.0)), 0.8 * view.spacing);
  BodyFrame frame;
  frame.has_base = report.has_base;
  frame.all_round = view.under_cover > kSeenBelow;
  frame.base = report.base;
  frame.edge = report.edge;
  frame.spacing = view.spacing;
  frame.seed = options.seed;
  const PointCloud even = even_points(scan, view.spacing, report.edge);
  require_surface_points(even.points, name);
  report.points = even.points.size();
  Surface surface = report.method == "height" ? reconstruct_height(even, frame)
                                              : reconstruct_poisson(even, frame);
  if (report.tilted) {
    for (Vec3& p : surface.vertices) p = turn.transpose() * p;
  }
  require_body(surface, name);
  measure(surface, cloud.points, report);
  return surface;
}

}  // namespace hapsim
