#include "experiment/markers.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>

#include "base/counted.h"
#include "base/error.h"
#include "effects/catalogue.h"
#include "experiment/press_clock.h"
#include "mesh/surface_tree.h"
#include "model/relaxation_steps.h"
#include "recording/tools_together.h"
#include "recording/torque_columns.h"

namespace hapsim {
namespace {

// Points of a scanned surface are known about as well as contacts are.
constexpr double kLeastOff = 1e-3;  // [m]
constexpr double kPartOff = 0.02;   // of the body's largest extent
// No point of the surface of a bonded body moves much farther than the tool that moves it.
constexpr double kMostOverTool = 3;
constexpr double kSteady = 1e-9;  // of the largest eigenvalue: a direction that was not moved

// Whether the field under this effect is another than that of the linear body moved as recorded.
bool changes_field(const EffectInstance& instance) {
  const Stage stage = instance.effect->card().stage;
  if (stage == Stage::kSensor) return false;
  if (stage == Stage::kMotion || stage == Stage::kContact) return true;
  MaterialSpec material;
  instance.effect->describe(instance.values, material);
  if (!material.features.empty()) return true;
  FullSpec spec;
  return !instance.effect->full(instance.values, 1e4, spec) || spec.finite;
}

double reach_of(const Surface& surface) {
  Eigen::AlignedBox3d box;
  for (const Vec3& p : surface.vertices) box.extend(p);
  return std::max(kLeastOff, kPartOff * box.sizes().maxCoeff());
}

std::size_t off_surface(const SurfaceTree& tree, const std::vector<Vec3>& points, double factor,
                        double reach) {
  return static_cast<std::size_t>(std::count_if(points.begin(), points.end(), [&](const Vec3& p) {
    return tree.nearest(factor * p).distance > reach;
  }));
}

// The best straight line's squares, and how many rows' worth of components are free of it.
void add_off_line(const MarkerSums& s, double& squares, double& free) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(s.uu);
  double explained = 0;
  int directions = 0;
  for (int k = 0; k < 3; ++k) {
    const double value = eigen.eigenvalues()[k];
    if (!(value > kSteady * eigen.eigenvalues()[2])) continue;
    explained += (s.uy.transpose() * eigen.eigenvectors().col(k)).squaredNorm() / value;
    ++directions;
  }
  if (static_cast<int>(s.rows) <= directions) return;
  squares += std::max(0.0, s.yy - explained);
  free += 3.0 * (static_cast<double>(s.rows) - directions);
}

Noise noise_of(const MarkerTable& table, const Markers& markers, const Dataset& dataset) {
  if (const auto declared = table.noise()) return {*declared, false, "declared"};
  double squares = 0, free = 0, all = 0;
  std::map<std::pair<int, std::size_t>, MarkerSums> by_place;
  for (std::size_t e = 0; e < markers.sums.size(); ++e)
    for (std::size_t m = 0; m < markers.sums[e].size(); ++m)
      by_place[{dataset.episodes[e].position, m}] += markers.sums[e][m];
  for (const auto& [where, sums] : by_place) {
    add_off_line(sums, squares, free);
    all += sums.yy;
  }
  if (!(free > 0))
    fail_input(table.name, "too few rows of each point at a place to tell the points' noise from",
               "declare it: # marker_noise: 20e-6 (standard deviation of a component [m])");
  const double least = 1e-4 * std::sqrt(all / (3 * static_cast<double>(markers.rows)));
  return {std::max({std::sqrt(squares / free), least, 1e-9}), true, "measured from the data"};
}

}  // namespace

std::string marker_refusal(const Model& model, const Dataset& dataset) {
  if (dataset.recording.has_ball()) return "under a ball the contact grows";
  if (tool_turns(dataset.recording)) return "the tool turns (thx,thy,thz)";
  if (!tools_together(dataset.recording).empty()) return "several tools press at once";
  for (const Episode& e : dataset.episodes)
    if (e.view.height > 0) return "the tool covers the whole body";
  for (const EffectInstance& i : effect_instances(model, true))
    if (changes_field(i))
      return fmt::format("with '{}' they are no constant times the tool's displacement",
                         i.effect->card().name);
  if (!regional_relaxation_of(model, material_of(model)).empty())
    return "its regions relax each in its own way";
  return "";
}

MarkerSums& MarkerSums::operator+=(const MarkerSums& other) {
  rows += other.rows;
  uu += other.uu;
  uy += other.uy;
  yy += other.yy;
  return *this;
}

double MarkerSums::squares(const Eigen::Matrix3d& G) const {
  return std::max(0.0, yy - 2 * (G * uy).trace() + (G * uu * G.transpose()).trace());
}

void require_on_surface(const MarkerTable& table, const Experiment& w) {
  const Surface& surface = w.places.setup(0)->surface();
  const SurfaceTree tree(surface);
  const double reach = reach_of(surface);
  const std::size_t off = off_surface(tree, table.rest, 1, reach);
  if (off == 0) return;
  std::string what = "give where the points lie on the unpressed body, in the frame of the body";
  for (const double factor : {1e-3, 1e3, 1e-2, 1e2})
    if (off_surface(tree, table.rest, factor, reach) == 0)
      what = factor == 1e-3 ? "times 0.001 they lie on it: name the columns x_mm,y_mm,z_mm"
                            : fmt::format("times {:g} they lie on it: mend their unit", factor);
  fail_input(table.name,
             fmt::format("{} of {} marked points {} farther than {:.2g} mm from the body's surface",
                         off, table.rest.size(), off == 1 ? "lies" : "lie", 1e3 * reach),
             what);
}

Markers match_markers(const MarkerTable& table, const Experiment& w) {
  const Dataset& dataset = w.dataset;
  const Recording& r = dataset.recording;
  require_on_surface(table, w);
  Markers markers;
  markers.names = table.points;
  markers.points = table.rest;
  markers.sums.assign(dataset.episodes.size(), std::vector<MarkerSums>(table.points.size()));
  const PressClock clock(table, dataset);
  std::size_t outside = 0, air = 0, under = 0, still = 0;
  double farthest = 0, tool = 0;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const PressTime at = clock.of_row(row);
    if (at.episode < 0) {
      ++outside;
      continue;
    }
    if (clock.in_air(at)) {
      ++air;
      continue;
    }
    const auto e = static_cast<std::size_t>(at.episode);
    const auto m = static_cast<std::size_t>(table.point[row]);
    const auto p = static_cast<std::size_t>(dataset.episodes[e].position);
    const double radius = dataset.setups[static_cast<std::size_t>(dataset.setup_of[p])].tool_radius;
    if ((table.rest[m] - w.places.position(p)).norm() < radius) {
      ++under;
      continue;
    }
    const Vec3 u = clock.displacement(at);
    if (u.isZero(0)) {
      ++still;
      continue;
    }
    const Vec3& y = table.u[row];
    MarkerSums& sums = markers.sums[e][m];
    ++sums.rows;
    sums.uu += u * u.transpose();
    sums.uy += u * y.transpose();
    sums.yy += y.squaredNorm();
    farthest = std::max(farthest, y.norm());
    tool = std::max(tool, u.norm());
    ++markers.rows;
  }
  if (markers.rows == 0)
    fail_input(
        table.name,
        fmt::format("none of {} counts: {} at no time of a press in {}, {} with the tool in the "
                    "air, {} of points under it, {} before it has moved",
                    counted(table.rows(), "row", "rows"), outside, r.name, air, under, still),
        outside > 0
            ? "give times by the recording's clock, in s or with the unit in the header (t_ms)"
            : "give points beside the tool while it presses");
  if (farthest > kMostOverTool * tool + 10 * table.noise().value_or(0))
    fail_input(
        table.name,
        fmt::format("a point moves {:.3g} mm, {:.3g} times as far as the tool ever; a body's "
                    "surface moves no farther than the tool",
                    1e3 * farthest, farthest / tool),
        "of displacements in mm, which are 1000 times too large, name the columns "
        "ux_mm,uy_mm,uz_mm");
  markers.noise = noise_of(table, markers, dataset);
  markers.words.push_back(
      fmt::format("{} of {} of {} matched", markers.rows, counted(table.rows(), "row", "rows"),
                  counted(table.points.size(), "marked point", "marked points")));
  const auto not_counted = [&](std::size_t count, const char* why) {
    if (count > 0)
      markers.words.push_back(
          fmt::format("{} not: {}", counted(count, "row does", "rows do"), why));
  };
  not_counted(outside, "at no time of a press that counts");
  not_counted(air, "the tool is in the air");
  not_counted(under, "the point is under the tool");
  not_counted(still, "the tool has not moved");
  return markers;
}

}  // namespace hapsim
