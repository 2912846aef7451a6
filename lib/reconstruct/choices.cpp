#include "reconstruct/choices.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace hapsim {
namespace {

constexpr double kFewSteep = 0.02;  // share of the points: a scan of the upper side alone
constexpr double kRest = 0.05;      // share of the height cut off such a body so that it can stand

std::string percent(double share) {
  return fmt::format("{:.0f} %", 100 * share);
}

}  // namespace

Vec3 find_up(const PointCloud& cloud, const ReconstructOptions& options) {
  if (options.up) return options.up->normalized();
  Vec3 mean = Vec3::Zero();
  for (const Vec3& n : cloud.normals) mean += n;
  mean /= static_cast<double>(cloud.normals.size());
  // A scan from all round has no mean normal, one from above a long one.
  if (mean.norm() < 0.3 || mean.z() > 0.5 * mean.norm()) return Vec3::UnitZ();
  return mean.normalized();
}

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

double beyond_points(const ScanView& view, const ReconstructOptions& options, double base) {
  if (options.beyond >= 0) return options.beyond;
  return std::min((view.low + view.high) / 2 - base, 0.5 * std::sqrt(view.area));
}

}  // namespace hapsim
