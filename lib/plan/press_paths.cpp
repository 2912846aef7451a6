#include "plan/press_paths.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>

namespace hapsim {
namespace {

constexpr double kAir = 0.2;                          // [s] before and after a press
constexpr double kLift = 5e-4;                        // [m] of the tool over the body, in the air
constexpr double kSlow = 3, kFast = 0.15, kHold = 5;  // [s]
constexpr int kLeastSteps = 15;                       // of a movement, however slow the recording

void append_row(Recording& r, int press, double t, const Vec3& position, const Vec3& u, bool air) {
  r.line.push_back(0);
  r.press.push_back(press);
  r.t.push_back(t);
  r.position.push_back(position);
  r.u.push_back(u);
  r.contact.push_back(air ? 0 : 1);
}

}  // namespace

std::vector<PressPath> press_paths(double deepest) {
  std::vector<PressPath> result;
  const auto down = [](double depth) { return Vec3(0, 0, depth); };
  for (const double share : {0.3, 1.0, kDeepestPath}) {
    const double d = share * deepest;
    const std::string depth = fmt::format("{:.2g} mm deep", 1e3 * d);
    result.push_back({"slowly " + depth, {{down(d), kSlow}, {down(0), kSlow}}});
    result.push_back({"fast " + depth, {{down(d), kFast}, {down(0), kFast}}});
    result.push_back(
        {"fast " + depth + ", held", {{down(d), kFast}, {down(d), kHold}, {down(0), kFast}}});
  }
  const double side = 0.5 * deepest;
  const auto sideways = [&](const std::string& name, double x, double y) {
    result.push_back(
        {fmt::format("{:.2g} mm deep, then {:.2g} mm sideways {}", 1e3 * deepest, 1e3 * side, name),
         {{down(deepest), 1},
          {Vec3(side * x, side * y, deepest), 1},
          {Vec3(-side * x, -side * y, deepest), 2},
          {down(deepest), 1},
          {down(0), 1}}});
  };
  sideways("along x and back", 1, 0);
  sideways("along y and back", 0, 1);
  sideways("diagonally and back", std::sqrt(0.5), std::sqrt(0.5));
  return result;
}

const PressPath& path_in_turn(const std::vector<PressPath>& paths, std::size_t turn) {
  // Held at one and a half, along x, slowly, along y, held, diagonally; of press_paths().
  constexpr std::size_t kTurns[] = {8, 9, 3, 10, 5, 11};
  return paths.at(kTurns[turn % std::size(kTurns)]);
}

void append_press(Recording& r, int press, double start, double step, const Vec3& position,
                  const Vec3& normal, const PressPath& path) {
  Vec3 x_tangent = Vec3::UnitX() - normal.x() * normal;
  if (x_tangent.norm() < 0.1) x_tangent = Vec3::UnitY() - normal.y() * normal;
  x_tangent.normalize();
  const Vec3 y_tangent = normal.cross(x_tangent);
  const auto world = [&](const Vec3& local) {
    return Vec3(local.x() * x_tangent + local.y() * y_tangent - local.z() * normal);
  };
  double t = start;
  const auto air = [&] {
    for (const double end = t + kAir; t < end - step / 2; t += step)
      append_row(r, press, t, position, kLift * normal, true);
  };
  air();
  Vec3 at = Vec3::Zero();
  for (const Leg& leg : path.legs) {
    const int steps = std::max(kLeastSteps, static_cast<int>(std::lround(leg.seconds / step)));
    for (int i = 0; i < steps; ++i, t += leg.seconds / steps)
      append_row(r, press, t, position, world(at + (leg.to - at) * i / steps), false);
    at = leg.to;
  }
  air();
}

}  // namespace hapsim
