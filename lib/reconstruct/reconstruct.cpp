#include "reconstruct/reconstruct.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <numeric>

#include "base/error.h"
#include "base/median.h"
#include "mesh/local_plane.h"
#include "mesh/point_index.h"
#include "mesh/surface_check.h"
#include "mesh/surface_tree.h"
#include "reconstruct/clean_points.h"
#include "reconstruct/normals.h"
#include "reconstruct/reconstruct_parts.h"
#include "repair/self_intersection.h"

namespace hapsim {
namespace {

constexpr double kSeenBelow = 0.5;  // share of the plan view: a scan from all round
constexpr double kFewSteep = 0.02;  // share of the points: a scan of the upper side alone
constexpr double kRest = 0.05;      // share of the height cut off such a body so that it can stand
constexpr double kFarOff = 0.25;    // of the spacing: others are tried when points lie farther off
constexpr double kNoises = 3;       // ... unless that is the scan's own thickness
constexpr double kFarthest = 1e6;   // [m]
constexpr std::size_t kLeastPoints = 12;  // different points
constexpr double kFlat = 1e-4;            // thickness over width of points in a plane
constexpr double kFaces = 2000;           // wished when --edge is not given

// Points given once, in their order.
PointCloud without_doubles(const PointCloud& cloud) {
  std::vector<std::size_t> order(cloud.points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto key = [&](std::size_t i) {
    const Vec3& p = cloud.points[i];
    return std::array<double, 3>{p.x(), p.y(), p.z()};
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return key(a) < key(b); });
  std::vector<char> doubled(order.size(), 0);
  for (std::size_t i = 1; i < order.size(); ++i) {
    doubled[order[i]] = key(order[i]) == key(order[i - 1]) ? 1 : 0;
  }
  PointCloud once;
  for (std::size_t i = 0; i < doubled.size(); ++i) {
    if (doubled[i] != 0) continue;
    once.points.push_back(cloud.points[i]);
    if (!cloud.normals.empty()) once.normals.push_back(cloud.normals[i]);
  }
  return once;
}

// Circumcentres underflow with coordinates of 1e-200 m, and normals need not be of unit length in a
// file: what does not change the shape and would end CGAL's exact numbers.
void make_tame(PointCloud& cloud) {
  constexpr double kNothing = 1e-12;  // [m]
  for (Vec3& p : cloud.points)
    for (int k = 0; k < 3; ++k)
      if (std::abs(p[k]) < kNothing) p[k] = 0;
  for (Vec3& n : cloud.normals) {
    const double largest = n.cwiseAbs().maxCoeff();
    if (largest > 0 && std::abs(n.norm() - 1) > 1e-3) n = (n / largest).normalized();
  }
}

// What no method can use is refused before any of them sees it.
void require_body_points(const std::vector<Vec3>& points, ReconstructMethod method,
                         const std::string& name) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].allFinite()) continue;
    fail_input(name, fmt::format("point {} is not finite", i), "remove it");
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double far = points[i].cwiseAbs().maxCoeff();
    if (far >= kFarthest)
      fail_input(name, fmt::format("point {} lies {:.3g} m away", i, far), "remove it");
  }
  require_surface_points(points, name);
  if (points.size() < kLeastPoints) {
    fail_input(name, fmt::format("only {} different points", points.size()),
               fmt::format("scan at least {}, better some hundred", kLeastPoints));
  }
  if (method == ReconstructMethod::kAuto || method == ReconstructMethod::kHeight) return;
  const LocalPlane plane = fit_plane(points);
  if (plane.spread[0] < kFlat * plane.spread[2]) {
    fail_input(name, "all points lie in one plane",
               "scan the sides too, or use --method height with --base-depth");
  }
}

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

// Chooses the method and says why; sets has_base.
void choose_method(const ScanView& view, const ReconstructOptions& options,
                   ReconstructReport& report) {
  const bool all_round = view.under_cover > kSeenBelow;
  const bool has_sides = view.ring_cover >= 0.7;
  // Of the walls between the lowest points and a bottom clearly below them nothing was seen: what
  // was is a height over the plan view.
  const double unseen = options.base ? view.low - *options.base : options.base_depth.value_or(0);
  const bool upper_side = view.steep_share < kFewSteep && unseen > 2 * view.spacing;
  report.has_base = !(all_round && options.no_base);
  if (options.method != ReconstructMethod::kAuto) {
    report.method = options.method;
    report.why = "asked for";
    if (options.method == ReconstructMethod::kHeight) report.has_base = true;
  } else if (all_round) {
    report.method = ReconstructMethod::kPoisson;
    report.why = percent(view.under_cover) + " of the plan view was seen from below too";
  } else if (has_sides && upper_side) {
    report.method = ReconstructMethod::kHeight;
    report.why = fmt::format(
        "{:.2g} % of the points are steep, and the bottom lies {:.2g} m below the lowest",
        100 * view.steep_share, unseen);
  } else if (has_sides) {
    report.method = ReconstructMethod::kPoisson;
    report.why = "side walls reach down in " + percent(view.ring_cover) + " of the directions";
  } else {
    report.method = ReconstructMethod::kHeight;
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
  if (view.under_cover > kSeenBelow && report.method != ReconstructMethod::kHeight) {
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
  } else if (report.method != ReconstructMethod::kHeight) {
    report.base = view.low;
    report.base_why = "the lowest level of the points; --base sets another";
  } else {
    const double depth = 0.25 * std::sqrt(view.area);
    report.base = view.low - depth;
    report.base_why =
        fmt::format("a guess, {:.2g} m below the lowest points; --base-depth sets it", depth);
  }
}

// How far a body goes on beyond the points.
double beyond_points(const ScanView& view, const ReconstructOptions& options, double base) {
  if (options.beyond >= 0) return options.beyond;
  return std::min((view.low + view.high) / 2 - base, 0.5 * std::sqrt(view.area));
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

// 90 % of the points lie nearer than this [m].
double typical_distance(const Surface& surface, const std::vector<Vec3>& points) {
  const SurfaceTree tree(surface);
  std::vector<double> distance;
  for (const Vec3& p : points) distance.push_back(tree.nearest(p).distance);
  const auto rank = static_cast<std::size_t>(0.9 * static_cast<double>(distance.size()));
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
  if (options.method != ReconstructMethod::kAuto)
    return attempt(cloud, frame, report.method, name, report.sharp);
  // The others need points of the sides, which a patch has not.
  std::vector<ReconstructMethod> methods{report.method};
  if (report.method != ReconstructMethod::kHeight) {
    methods.insert(methods.end(), {ReconstructMethod::kDelaunay, ReconstructMethod::kPowerCrust,
                                   ReconstructMethod::kAdvancingFront, ReconstructMethod::kWrap});
  }
  const double near =
      std::max(kFarOff * std::max(frame.spacing, frame.edge / 3), kNoises * noise_of(cloud.points));
  Surface best;
  double least = 1e300;
  std::string failure;
  for (const ReconstructMethod method : methods) {
    try {
      bool sharp = false;
      Surface surface = attempt(cloud, frame, method, name, sharp);
      const double off = typical_distance(surface, cloud.points);
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

void check_size(const std::vector<Vec3>& points, const std::string& unit, const std::string& name) {
  double size = 0;
  std::vector<double> along(points.size());
  const auto cut = static_cast<std::size_t>(0.02 * static_cast<double>(points.size()));
  for (int k = 0; k < 3; ++k) {
    for (std::size_t i = 0; i < points.size(); ++i) along[i] = points[i][k];
    std::sort(along.begin(), along.end());
    if (!along.empty()) size = std::max(size, along[along.size() - 1 - cut] - along[cut]);
  }
  if (size > 5) {
    fail_input(name, fmt::format("the surface is {:.3g} m wide when read in {}", size, unit),
               "give its unit, as --unit mm");
  }
  if (size < 1e-3 && size > 0) {
    fail_input(name, fmt::format("the surface is {:.3g} mm wide when read in {}", 1e3 * size, unit),
               "give its unit, as --unit m");
  }
}

Surface reconstruct(const PointCloud& cloud, const ReconstructOptions& options,
                    const std::string& name, ReconstructReport& report) {
  report = {};
  PointCloud scan = cloud;
  make_tame(scan);
  scan = without_doubles(scan);
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
