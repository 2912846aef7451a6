#include "reconstruct/reconstruct.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <exception>

#include "base/error.h"
#include "base/median.h"
#include "mesh/local_plane.h"
#include "mesh/point_index.h"
#include "mesh/surface_check.h"
#include "mesh/surface_tree.h"
#include "reconstruct/choices.h"
#include "reconstruct/clean_points.h"
#include "reconstruct/normals.h"
#include "reconstruct/reconstruct_parts.h"
#include "reconstruct/usable_points.h"
#include "repair/self_intersection.h"

namespace hapsim {
namespace {

constexpr double kFarOff = 0.25;  // of the spacing: others are tried when points lie farther off
constexpr double kNoises = 3;     // ... unless that is the scan's own thickness
constexpr double kMost = 0.9, kNearlyAll = 0.97;  // shares of the points
constexpr double kFaces = 2000;                   // wished when --edge is not given

PointCloud rotated(const PointCloud& cloud, const Eigen::Matrix3d& r) {
  PointCloud turned = cloud;
  for (Vec3& p : turned.points) p = r * p;
  for (Vec3& n : turned.normals) n = r * n;
  return turned;
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

// Thickness of the scan: the median over neighbourhoods [m].
double noise_of(const std::vector<Vec3>& points) {
  const PointIndex index(points);
  std::vector<double> thickness;
  const std::size_t step = std::max<std::size_t>(1, points.size() / 1000);
  for (std::size_t i = 0; i < points.size(); i += step) {
    std::vector<Vec3> near;
    for (const Neighbour& m : index.nearest(points[i], 12)) near.push_back(points[m.index]);
    thickness.push_back(fit_plane(near).thickness);
  }
  return upper_median(std::move(thickness));
}

// The `share` of the points lies nearer than this [m].
double distance_of(double share, const Surface& surface, const std::vector<Vec3>& points) {
  const SurfaceTree tree(surface);
  std::vector<double> distance;
  for (const Vec3& p : points) distance.push_back(tree.nearest(p).distance);
  const auto rank = static_cast<std::size_t>(share * static_cast<double>(distance.size()));
  return nth_smallest(std::move(distance), rank);
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

// Up to here points lie no farther off than the method and the scan account for [m].
double near_of(const PointCloud& cloud, const BodyFrame& frame) {
  return std::max(kFarOff * std::max(frame.spacing, frame.edge / 3),
                  kNoises * noise_of(cloud.points));
}

Surface attempt(const PointCloud& cloud, const BodyFrame& frame, ReconstructMethod method,
                const std::string& name, bool& sharp) {
  sharp = false;
  Surface surface;
  try {
    surface = method == ReconstructMethod::kHeight
                  ? reconstruct_height(cloud, frame)
                  : reconstruct_closed(cloud, frame, method, sharp);
  } catch (const Error&) {
    throw;
  } catch (const std::exception&) {  // out of the geometry library
    fail_numerics("", "method " + method_name(method) + " failed on these points",
                  "use another --method, or clean them with hs-scan2ply");
  }
  require_body(surface, name);
  return surface;
}

// The same, where the method allows it roughly first: less than half the time, and enough but for
// what is thin.
Surface attempt_cheaply(const PointCloud& cloud, const BodyFrame& frame, ReconstructMethod method,
                        double near, const std::string& name, bool& sharp) {
  if (method == ReconstructMethod::kPoisson) {
    try {
      BodyFrame rough = frame;
      rough.roughly = true;
      Surface surface = attempt(cloud, rough, method, name, sharp);
      if (distance_of(kNearlyAll, surface, cloud.points) < near) return surface;
    } catch (const Error&) {  // what is thin is lost
    }
  }
  return attempt(cloud, frame, method, name, sharp);
}

// When the method is ours to choose, the points are at fault where none will do.
[[noreturn]] void fail_all_methods(const std::string& name, const std::string& failure) {
  fail_input(
      name,
      "no method makes a closed body of these points: " + failure.substr(0, failure.find("; ")),
      "clean them with hs-scan2ply, scan more densely, or try --edge and --method");
}

// By the chosen method; when that was chosen by us and fails, or leaves the points far off, by the
// best of the others.
Surface by_method(const PointCloud& cloud, const BodyFrame& frame,
                  const ReconstructOptions& options, const std::string& name,
                  ReconstructReport& report) {
  const double near = near_of(cloud, frame);
  if (options.method != ReconstructMethod::kAuto)
    return attempt_cheaply(cloud, frame, report.method, near, name, report.sharp);
  // The others need points of the sides, which a patch has not.
  std::vector<ReconstructMethod> methods{report.method};
  if (report.method != ReconstructMethod::kHeight) {
    methods.insert(methods.end(), {ReconstructMethod::kDelaunay, ReconstructMethod::kPowerCrust,
                                   ReconstructMethod::kAdvancingFront, ReconstructMethod::kWrap});
  }
  Surface best;
  double least = 1e300;
  std::string failure;
  for (const ReconstructMethod method : methods) {
    try {
      bool sharp = false;
      Surface surface = attempt_cheaply(cloud, frame, method, near, name, sharp);
      const double off = distance_of(kMost, surface, cloud.points);
      // Another must be clearly better than what the points' kind asks for.
      if (off < (best.faces.empty() ? 1 : 0.8) * least) {
        if (!best.faces.empty()) {
          report.why +=
              fmt::format("; {} left the points {:.2g} mm off, {} {:.2g} mm",
                          method_name(report.method), 1e3 * least, method_name(method), 1e3 * off);
          report.method = method;
        } else if (method != report.method) {
          report.why += fmt::format("; but {} failed there", method_name(report.method));
          report.method = method;
        }
        least = off;
        best = std::move(surface);
        report.sharp = sharp;
      }
    } catch (const Error& error) {
      if (failure.empty()) failure = error.what();
    }
    if (least < near) return best;
  }
  if (best.faces.empty()) fail_all_methods(name, failure);
  return best;
}

}  // namespace

const std::vector<std::string>& reconstruct_methods() {
  static const std::vector<std::string> names{
      "auto", "height", "delaunay", "power-crust", "poisson", "advancing-front", "wrap"};
  return names;
}

const std::string& method_name(ReconstructMethod method) {
  return reconstruct_methods()[static_cast<std::size_t>(method)];
}

ReconstructMethod method_named(const std::string& name) {
  const auto& names = reconstruct_methods();
  const auto at = std::find(names.begin(), names.end(), name);
  return at == names.end() ? ReconstructMethod::kAuto
                           : static_cast<ReconstructMethod>(at - names.begin());
}

Surface reconstruct(const PointCloud& cloud, const ReconstructOptions& options,
                    const std::string& name, ReconstructReport& report) {
  report = {};
  PointCloud scan = tame_points(cloud);
  require_body_points(scan.points, options.method, name);
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
  if (options.beyond != 0 && report.method != ReconstructMethod::kHeight)
    fail_input(name, "only a patch goes on beyond its points, and these show the body's sides",
               "leave --beyond out, or add --method height");
  if (options.beyond != 0) report.beyond = beyond_points(view, options, report.base);

  // The bottom and, for a patch, the walls and what lies beyond come on top of what was scanned.
  const double seen = view.area;
  const double area = 1.4 * (seen + 4 * report.beyond * (std::sqrt(seen) + report.beyond));
  report.edge = options.edge > 0
                    ? options.edge
                    : std::max(std::sqrt(area / kFaces * 4 / std::sqrt(3.0)), 0.8 * view.spacing);
  BodyFrame frame;
  frame.has_base = report.has_base;
  frame.all_round = view.under_cover > kSeenBelow;
  frame.base = report.base;
  frame.edge = report.edge;
  frame.spacing = view.spacing;
  frame.beyond = report.beyond;
  frame.seed = options.seed;
  frame.step = options.step;
  const PointCloud even = even_points(scan, view.spacing, report.edge);
  require_surface_points(even.points, name);
  report.points = even.points.size();
  Surface surface = by_method(even, frame, options, name, report);
  if (frame.beyond > 0) report.window = outline_of(even, frame);
  if (report.tilted) {
    for (Vec3& p : surface.vertices) p = turn.transpose() * p;
    for (Vec3& p : report.window) p = turn.transpose() * p;
  }
  measure(surface, cloud.points, report);
  return surface;
}

}  // namespace hapsim
