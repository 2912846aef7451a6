#include "realtime/several_tools.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cassert>
#include <limits>

#include "realtime/disc_rotation.h"
#include "realtime/tool_torque.h"

namespace hapsim {
namespace {

constexpr std::size_t kNobody = kMostTools;

Eigen::Quaterniond turned_by(const Vec3& rotation) noexcept {
  const double angle = rotation.norm();
  if (angle == 0) return Eigen::Quaterniond::Identity();
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, rotation / angle));
}

Vec3 rotation_vector(Eigen::Quaterniond q) noexcept {
  if (q.w() < 0) q.coeffs() *= -1;
  const Eigen::AngleAxisd turn(q);
  return turn.angle() * turn.axis();
}

ToolLoopOptions holding(ToolLoopOptions options) {
  options.contact.slides = false;
  return options;
}

}  // namespace

struct SeveralTools::Tool {
  Tool(const PreparedBody& body, const ToolLoopOptions& options)
      : loop(body, options), contact(body.distance(), options.contact), torque(body) {}

  ForceLoop loop;
  ToolContact contact;
  ToolTorque torque;
  bool touches = false;
  bool placed = false;        // it has touched, or (press()) was told where it will
  bool told = false;          // step(): a point was told before its first touch
  int press = 0;              // of the last pose, by press()
  Vec3 point = Vec3::Zero();  // the contact's, on the undeformed surface
  // The last finite ones, by step(); at first there is no tool.
  Vec3 tip = Vec3::Constant(std::numeric_limits<double>::quiet_NaN()), turn = Vec3::Zero();
  Eigen::Quaterniond at_touch = Eigen::Quaterniond::Identity();
  Matrix6 K = Matrix6::Identity();
  Matrix6 C = Matrix6::Identity();  // its inverse
  Vector6 d = Vector6::Zero();      // way and turn since it touched
  ToolCoupling::Patch patch;
  std::array<Matrix6, kMostTools> cross;  // of its patch by what acts on each that touches
};

SeveralTools::SeveralTools(const PreparedBody& body, const ToolCoupling* coupling,
                           std::size_t tools, const ToolLoopOptions& options)
    : body_(body), coupling_(coupling), options_(holding(options)), feel_(tools) {
  assert(tools >= 1 && tools <= kMostTools && (tools == 1 || coupling != nullptr));
  for (std::size_t k = 0; k < tools; ++k) tools_.push_back(std::make_unique<Tool>(body, options_));
}

SeveralTools::~SeveralTools() = default;

void SeveralTools::set_temperature(double temperature) noexcept {
  for (const auto& tool : tools_) tool->loop.set_temperature(temperature);
}

// Takes the place of a contact that begins at a point of the surface.
void SeveralTools::touch(std::size_t k, const Vec3& point) noexcept {
  Tool& tool = *tools_[k];
  const SurfaceSide side = body_.distance().at(point);
  const StepPlace place = body_.facts().at(side.face, side.point, side.normal);
  tool.point = side.point;
  tool.placed = true;
  tool.loop.begin(point);
  tool.torque.take_place(side.face, side.point, place.contact.K);
  if (options_.relaxed) tool.torque.forget();
  tool.K = disc_stiffness(place.contact.K, place.contact.modulus, place.contact.nu,
                          body_.tool_radius(), place.normal);
  tool.C = tool.K.llt().solve(Matrix6::Identity());
  if (tools_.size() == 1) return;
  tool.patch = coupling_->patch(side.point, place.normal, place.contact.modulus);
  for (std::size_t l = 0; l < tools_.size(); ++l) {
    if (l == k || !tools_[l]->placed) continue;
    tool.cross[l] = coupling_->between(tool.patch, tools_[l]->patch);
    tools_[l]->cross[k] = tool.cross[l].transpose();
  }
}

// Forces and moments that move the patches of all that touch, `but` one, as they are.
void SeveralTools::find_loads(std::size_t but, Loads& loads) const noexcept {
  loads.tools = 0;
  for (std::size_t k = 0; k < tools_.size(); ++k)
    if (k != but && tools_[k]->touches) loads.tool[loads.tools++] = k;
  if (loads.tools == 0) return;
  if (loads.tools == 1) {
    const Tool& tool = *tools_[loads.tool[0]];
    loads.p[0] = tool.K * tool.d;
    return;
  }
  const auto size = 6 * static_cast<Eigen::Index>(loads.tools);
  Matrix C(size, size);
  Vector d(size);
  for (std::size_t a = 0; a < loads.tools; ++a) {
    const Tool& tool = *tools_[loads.tool[a]];
    const auto row = 6 * static_cast<Eigen::Index>(a);
    d.segment<6>(row) = tool.d;
    for (std::size_t b = 0; b < loads.tools; ++b)
      C.block<6, 6>(row, 6 * static_cast<Eigen::Index>(b)) =
          a == b ? tool.C : tool.cross[loads.tool[b]];
  }
  const Eigen::LLT<Eigen::Ref<Matrix>> factor(C);
  if (factor.info() == Eigen::Success) factor.solveInPlace(d);
  for (std::size_t a = 0; a < loads.tools; ++a) {
    const Tool& tool = *tools_[loads.tool[a]];
    // Tools that lie in each other (kBeyondClose) may have no such loads: each then has its own.
    loads.p[a] = factor.info() == Eigen::Success
                     ? Vector6(d.segment<6>(6 * static_cast<Eigen::Index>(a)))
                     : Vector6(tool.K * tool.d);
  }
}

// How far the others have moved the surface at the tip [m], and whether the tool touches there.
void SeveralTools::find_contact(std::size_t k, const ToolPose& pose) noexcept {
  Tool& tool = *tools_[k];
  if (pose.point.allFinite()) tool.tip = pose.point;
  if (pose.turn.allFinite()) tool.turn = pose.turn;
  Loads others;
  find_loads(k, others);
  Vec3 moved = Vec3::Zero();
  if (tool.touches) {
    for (std::size_t a = 0; a < others.tools; ++a)
      moved += (tool.cross[others.tool[a]] * others.p[a]).head<3>();
  } else if (others.tools > 0 && tool.tip.allFinite()) {
    double farthest = 0;  // nothing moves farther than the tools
    for (std::size_t a = 0; a < others.tools; ++a)
      farthest = std::max(farthest, tools_[others.tool[a]]->d.head<3>().norm());
    const SurfaceSide side = body_.distance().at(tool.tip, tool.contact.state().surface.face);
    if (side.distance - options_.contact.radius <= farthest) {
      const StepPlace place = body_.facts().at(side.face, side.point, side.normal);
      const ToolCoupling::Patch patch =
          coupling_->patch(side.point, place.normal, place.contact.modulus);
      for (std::size_t a = 0; a < others.tools; ++a)
        moved += (coupling_->between(patch, tools_[others.tool[a]]->patch) * others.p[a]).head<3>();
    }
  }
  const ToolState& state = tool.contact.update(tool.tip - moved);
  if (state.phase == ContactPhase::kBegan) {
    touch(k, state.anchor);
    tool.at_touch = turned_by(tool.turn);
    feel_[k].press = ++touches_;
  }
  tool.touches = state.touching();
  if (tool.touches) {
    tool.d.head<3>() = state.displacement + moved;
    tool.d.tail<3>() = rotation_vector(turned_by(tool.turn) * tool.at_touch.conjugate());
  } else {
    tool.d.setZero();
    // Before its first touch it is told at one place, as every other press is.
    if (!tool.placed && !tool.told) tool.point = state.surface.point;
    tool.told = true;
  }
}

std::span<const ToolFeel> SeveralTools::step(double t, std::span<const ToolPose> poses) noexcept {
  assert(poses.size() == tools_.size());
  for (std::size_t k = 0; k < tools_.size(); ++k) {
    if (!tools_[k]->placed) feel_[k].press = -static_cast<int>(k);
    find_contact(k, poses[k]);
  }
  feel(t);
  return feel_;
}

std::span<const ToolFeel> SeveralTools::press(double t, std::span<const ToolPose> poses) noexcept {
  assert(poses.size() == tools_.size());
  for (std::size_t k = 0; k < tools_.size(); ++k) {
    Tool& tool = *tools_[k];
    const ToolPose& pose = poses[k];
    const bool is_there = pose.point.allFinite() && pose.u.allFinite() && pose.turn.allFinite();
    if (is_there) {
      if (!tool.placed || pose.press != tool.press) touch(k, pose.point);
      tool.press = feel_[k].press = pose.press;
      tool.point = pose.point;
      tool.d << pose.u, pose.turn;
    }
    tool.touches = tool.placed && !pose.in_air;
  }
  feel(t);
  return feel_;
}

void SeveralTools::feel(double t) noexcept {
  Loads all;
  find_loads(kNobody, all);
  for (std::size_t k = 0; k < tools_.size(); ++k) {
    Tool& tool = *tools_[k];
    ToolFeel& feel = feel_[k];
    feel.point = tool.point;
    feel.in_air = !tool.touches;
    feel.u = tool.d.head<3>();
    feel.turn = tool.d.tail<3>();
    if (!tool.touches) {
      feel.force = tool.loop.press(t, feel.u, true);
      feel.beyond = tool.loop.beyond();
      feel.uncertainty = 0;  // the body exerts nothing
      feel.torque.setZero();
      tool.torque.advance(t, Vec3::Zero());
      continue;
    }
    Vector6 way = tool.d;
    bool close = false;
    for (std::size_t a = 0; a < all.tools; ++a) {
      const std::size_t l = all.tool[a];
      if (l == k) continue;
      way -= tool.cross[l] * all.p[a];
      close = close || (tools_[l]->point - tool.point).norm() < 2 * body_.tool_radius();
    }
    // The displacement without turn that has the same force.
    const Vec3 push = way.head<3>() + tool.K.topLeftCorner<3, 3>().inverse() *
                                          (tool.K.topRightCorner<3, 3>() * way.tail<3>());
    feel.force = tool.loop.press(t, push);
    const Vec3 held = tool.loop.pressed() - push;
    feel.u += held;
    way.head<3>() += held;
    feel.beyond = tool.loop.beyond() | (close ? kBeyondClose : 0);
    feel.uncertainty = tool.loop.uncertainty() * feel.force.norm();
    feel.torque = tool.torque.advance(t, -(tool.K.bottomRows<3>() * way));
  }
}

}  // namespace hapsim
