#include "plan/press_depths.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "base/error.h"
#include "mesh/way_through.h"
#include "plan/press_paths.h"

namespace hapsim {
namespace {

constexpr double kUnknownShare = 1.0 / 3;  // of the way through a body that nobody knows yet
constexpr double kOffRadii = 3, kLeastOff = 0.01;  // [radii], [m]: as where a contact is meshed

double first_depth(const Surface& surface, double tool_radius) {
  Eigen::AlignedBox3d box;
  for (const Vec3& v : surface.vertices) box.extend(v);
  return kDeepestPath * std::min(0.75 * tool_radius, 0.1 * box.sizes().minCoeff());
}

}  // namespace

double deepest_so_far(const SignedDistance& surface, const Recording& r) {
  double deepest = 0;
  Vec3 normal = Vec3::Zero();
  for (std::size_t row = 0; row < r.rows(); ++row) {
    if (row == 0 || r.position[row] != r.position[row - 1])
      normal = surface.at(r.position[row]).normal;
    if (!r.in_air(row)) deepest = std::max(deepest, -r.u[row].dot(normal));
  }
  return deepest;
}

void require_on_body(const SignedDistance& surface, const Recording& r) {
  const double most = std::max(kOffRadii * r.disc_radius(), kLeastOff);
  for (std::size_t row = 0; row < r.rows(); ++row) {
    if (row > 0 && r.position[row] == r.position[row - 1]) continue;
    const double off = std::abs(surface.at(r.position[row]).distance);
    if (!(off <= most))
      fail_input(fmt::format("{}:{}", r.name, r.line[row]),
                 fmt::format("the contact lies {:.3g} m off the body's surface, more than 3 tool "
                             "radii",
                             off),
                 "check the unit and that the body and the recording share one frame");
  }
}

PressDepths::PressDepths(const SignedDistance& surface, const Recording& so_far, double asked)
    : surface_(surface), deepest_(asked), share_(asked > 0 ? kValidShare : kUnknownShare) {
  if (!(deepest_ > 0)) deepest_ = deepest_so_far(surface, so_far);
  if (!(deepest_ > 0)) deepest_ = first_depth(surface.surface(), so_far.tool_radius());
}

double PressDepths::deepest_at(const Vec3& point, const Vec3& normal) const {
  const Vec3 from = surface_.at(point).point;
  return std::min(deepest_, share_ * way_through(surface_, from, -normal));
}

double PressDepths::full_at(const Vec3& point, const Vec3& normal) const {
  return deepest_at(point, normal) / kDeepestPath;
}

std::string PressDepths::shallower_words(const Vec3& point) const {
  const double here = deepest_at(point, surface_.at(point).normal);
  if (here >= 0.99 * deepest_) return "";
  return fmt::format(
      "at ({:.1f}, {:.1f}, {:.1f}) mm presses go {:.2g} mm deep at most, not {:.2g}: the body is "
      "thin there",
      1e3 * point.x(), 1e3 * point.y(), 1e3 * point.z(), 1e3 * here, 1e3 * deepest_);
}

}  // namespace hapsim
