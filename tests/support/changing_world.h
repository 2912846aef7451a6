// A stream of presses on a body that changes while it is watched.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "base/random.h"
#include "effects/catalogue.h"
#include "realtime/force_loop.h"
#include "realtime/motion_source.h"
#include "support/block_mesh.h"

namespace hapsim::test {

// A block whose top is bent down towards its edges.
inline TetMesh dome_mesh(int cells) {
  TetMesh mesh = block_mesh({0.08, 0.08, 0.04}, cells, cells, (2 * cells + 2) / 3, 1);
  for (Vec3& p : mesh.nodes)
    p.z() *= 1 - 0.4 * (Vec3(p.x() - 0.04, p.y() - 0.04, 0).squaredNorm()) / (0.04 * 0.04);
  return mesh;
}

inline std::unique_ptr<PreparedBody> prepared_soft(const TetMesh& body, double modulus = 2e4,
                                                   double relaxing = 6e3, double time = 0.15) {
  Model model;
  model.parameters = effect_rows(*find_effect("elastic"), 1, {modulus, 0.45});
  for (const Parameter& p : effect_rows(*find_effect("viscoelastic"), 1, {relaxing, time}))
    model.parameters.push_back(p);
  PreparedBodyOptions options;
  options.tool_radius = 0.004;
  options.tolerance = 0.02;
  return std::make_unique<PreparedBody>(body, model, options);
}

inline std::unique_ptr<PreparedBody> prepared_dome(int cells, double modulus = 2e4,
                                                   double relaxing = 6e3, double time = 0.15) {
  return prepared_soft(dome_mesh(cells), modulus, relaxing, time);
}

struct World {
  double stiffness = 1;
  Vec3 bias = Vec3::Zero(), shift = Vec3::Zero();
  bool gone = false;
};

// Presses at random places over the middle of the body in plan, from above, one a second, each some
// 0.4 s in contact; the world changes at `when` [s].
class PressStream {
 public:
  PressStream(const PreparedBody& truth, std::uint64_t seed)
      : loop_(truth), random_(seed), truth_(truth) {
    for (const Vec3& p : truth.field().surface().vertices) box_.extend(p);
  }
  World before, after;
  // The body is another after the change, of the same shape.
  void becomes(const PreparedBody& other) { other_.emplace(other); }
  double when = 1e9;
  double noise = 0.015;  // [N]

  std::pair<MotionLine, Vec3> next() {
    const double in_press = 1e-3 * static_cast<double>(count_ % 1000);
    if (count_ % 1000 == 0) {
      const double along = random_.uniform(), across = random_.uniform();
      const Vec3 size = box_.sizes();
      const Vec3 above = box_.min() + Vec3((0.25 + 0.5 * along) * size.x(),
                                           (0.25 + 0.5 * across) * size.y(), 1.5 * size.z());
      const SurfaceSide side = truth_.distance().at(above);
      place_ = side.point;
      normal_ = side.normal;
      side_ = 0.3 * (random_.uniform() - 0.5);
      depth_ = 0.003 + 0.003 * random_.uniform();
      ++press_;
    }
    const double t = 1e-3 * static_cast<double>(count_++);
    const World& world = t < when ? before : after;
    MotionLine line;
    line.press = press_;
    line.t = t;
    line.point = place_;
    // Down and up again on a straight line, 8 mm clear of the body at first, moved or not.
    const double way = kClear - (kClear + depth_) * std::pow(std::sin(3.1416 * in_press), 2);
    line.in_air = way >= 0;
    line.u = way * (normal_ - side_ * Vec3(1, 0.5, 0));
    const Vec3 tool = line.point + line.u - world.shift;
    Vec3 f = Vec3::Zero();
    if (!world.gone) f = world.stiffness * loop_.step(t, tool);
    if (other_) {
      const Vec3 g = other_->step(t, tool);
      if (t >= when) f = g;
    }
    touches_ = f != Vec3::Zero();
    f += world.bias;
    for (int k = 0; k < 3; ++k) f[k] += noise * random_.normal();
    return {line, f};
  }
  bool touches() const { return touches_; }  // the last one

 private:
  static constexpr double kClear = 0.008;  // [m]
  ForceLoop loop_;
  std::optional<ForceLoop> other_;
  Random random_;
  const PreparedBody& truth_;
  Eigen::AlignedBox3d box_;
  long count_ = 0;
  int press_ = 0;
  Vec3 place_, normal_;
  double side_ = 0, depth_ = 0;
  bool touches_ = false;
};

}  // namespace hapsim::test
