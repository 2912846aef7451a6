#include "robot/robot.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <kdl/chain.hpp>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainiksolverpos_lma.hpp>
#include <kdl/chainjnttojacsolver.hpp>
#include <utility>

#include "base/random.h"
#include "robot/urdf_chain.h"

namespace hapsim {
namespace {

constexpr double kPoseError = 1e-10;  // [m], [rad]
constexpr int kIterations = 100;
constexpr int kRandomStarts = 8;

KDL::Vector to_kdl(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

KDL::Frame to_kdl(const Pose& pose) {
  const auto& r = pose.linear();
  return {KDL::Rotation(r(0, 0), r(0, 1), r(0, 2), r(1, 0), r(1, 1), r(1, 2), r(2, 0), r(2, 1),
                        r(2, 2)),
          to_kdl(pose.translation())};
}

Pose from_kdl(const KDL::Frame& frame) {
  Pose pose = Pose::Identity();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) pose.linear()(i, j) = frame.M(i, j);
    pose.translation()[i] = frame.p(i);
  }
  return pose;
}

// KDL's segment: its joint stands in the frame before, its tip is the frame of the carried link.
KDL::Segment segment(const ChainJoint& j) {
  const KDL::Frame origin = to_kdl(j.origin);
  if (j.fixed) {
    return KDL::Segment(j.joint.name, KDL::Joint(j.joint.name, KDL::Joint::None), origin);
  }
  const KDL::Joint joint(j.joint.name, origin.p, origin.M * to_kdl(j.axis),
                         j.joint.turns ? KDL::Joint::RotAxis : KDL::Joint::TransAxis);
  return KDL::Segment(j.joint.name, joint, origin);
}

// The same angle, a whole number of turns away, within the limits and nearest to `near`.
bool wrap(const RobotJoint& joint, double near, double& q) {
  constexpr double kTurn = 2 * M_PI, kSlack = 1e-9;
  if (joint.turns) {
    q -= kTurn * std::round((q - near) / kTurn);
    if (q > joint.upper + kSlack) q -= kTurn * std::ceil((q - joint.upper - kSlack) / kTurn);
    if (q < joint.lower - kSlack) q += kTurn * std::ceil((joint.lower - kSlack - q) / kTurn);
  }
  return std::isfinite(q) && q >= joint.lower - kSlack && q <= joint.upper + kSlack;
}

// Newton's steps to the last digits: the solver takes turns below 1e-7 rad for none.
void polish(const Robot& robot, const KDL::Chain& chain, const Pose& pose, KDL::JntArray& q) {
  KDL::ChainJntToJacSolver solver(chain);
  KDL::Jacobian jacobian(q.rows());
  for (int step = 0; step < 3 && q.data.allFinite(); ++step) {
    const Pose at = robot.forward(q.data);
    const Eigen::Matrix3d turn = pose.linear() * at.linear().transpose();
    Eigen::Matrix<double, 6, 1> off;
    off << pose.translation() - at.translation(), (turn(2, 1) - turn(1, 2)) / 2,
        (turn(0, 2) - turn(2, 0)) / 2, (turn(1, 0) - turn(0, 1)) / 2;
    if (off.norm() > 1e-3 || off.norm() < 1e-14) return;
    solver.JntToJac(q, jacobian);
    q.data += jacobian.data.completeOrthogonalDecomposition().solve(off);
  }
}

}  // namespace

struct Robot::Impl {
  std::string name, root, tip;
  std::vector<RobotJoint> joints;
  KDL::Chain chain;
  double reach = 0;
  Vec3 shoulder = Vec3::Zero();
};

Robot::Robot(const std::string& urdf, const std::string& name, const std::string& root,
             const std::string& tip)
    : impl_(std::make_unique<Impl>()) {
  const UrdfChain chain = read_urdf_chain(urdf, name, root, tip);
  impl_->name = name;
  impl_->root = chain.root;
  impl_->tip = chain.tip;
  Pose before = Pose::Identity();
  for (const ChainJoint& j : chain.joints) {
    impl_->chain.addSegment(segment(j));
    const bool first = impl_->joints.empty();
    if (first) {
      before = before * j.origin;
      impl_->shoulder = before.translation();
    } else {
      impl_->reach += j.origin.translation().norm();
    }
    if (j.fixed) continue;
    impl_->joints.push_back(j.joint);
    if (!j.joint.turns) {
      impl_->reach += std::max(std::abs(j.joint.lower), std::abs(j.joint.upper));
    }
  }
}

Robot::~Robot() = default;
Robot::Robot(Robot&&) noexcept = default;

const std::string& Robot::name() const {
  return impl_->name;
}
const std::string& Robot::root() const {
  return impl_->root;
}
const std::string& Robot::tip() const {
  return impl_->tip;
}
const std::vector<RobotJoint>& Robot::joints() const {
  return impl_->joints;
}
double Robot::reach() const {
  return impl_->reach;
}
Vec3 Robot::shoulder() const {
  return impl_->shoulder;
}

Pose Robot::forward(const Eigen::VectorXd& q) const {
  KDL::ChainFkSolverPos_recursive solver(impl_->chain);
  KDL::JntArray joints(impl_->chain.getNrOfJoints());
  joints.data = q;
  KDL::Frame frame;
  solver.JntToCart(joints, frame);
  return from_kdl(frame);
}

Eigen::VectorXd Robot::middle() const {
  Eigen::VectorXd q(static_cast<Eigen::Index>(impl_->joints.size()));
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    const RobotJoint& j = impl_->joints[static_cast<std::size_t>(i)];
    q[i] = std::isfinite(j.lower) && std::isfinite(j.upper) ? (j.lower + j.upper) / 2 : 0;
  }
  return q;
}

std::optional<Eigen::VectorXd> Robot::inverse(const Pose& pose,
                                              const Eigen::VectorXd& start) const {
  if ((pose.translation() - impl_->shoulder).norm() > impl_->reach + 1e-9) return {};
  // Angles weigh as much as positions a tenth of a metre out.
  Eigen::Matrix<double, 6, 1> weight;
  weight << 1, 1, 1, 0.1, 0.1, 0.1;
  KDL::ChainIkSolverPos_LMA solver(impl_->chain, weight, 1e-12, kIterations);
  const KDL::Frame goal = to_kdl(pose);
  KDL::JntArray from(impl_->chain.getNrOfJoints()), found(impl_->chain.getNrOfJoints());

  const auto attempt = [&](const Eigen::VectorXd& begin) -> std::optional<Eigen::VectorXd> {
    from.data = begin;
    solver.CartToJnt(from, goal, found);
    polish(*this, impl_->chain, pose, found);
    // The solver reports stalled steps as failures even where the pose is met: look at the pose.
    if (!found.data.allFinite()) return {};
    Eigen::VectorXd q = found.data;
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      if (!wrap(impl_->joints[static_cast<std::size_t>(i)], start[i], q[i])) return {};
    }
    const Pose reached = forward(q);
    const double off = (reached.translation() - pose.translation()).norm();
    const double turned = (reached.linear() - pose.linear()).norm();
    if (!(off < kPoseError && turned < kPoseError)) return {};
    return q;
  };

  if (auto q = attempt(start)) return q;
  std::optional<Eigen::VectorXd> best = attempt(middle());
  Random random(1);
  for (int k = 0; k < kRandomStarts; ++k) {
    Eigen::VectorXd begin(start.size());
    for (Eigen::Index i = 0; i < begin.size(); ++i) {
      const RobotJoint& j = impl_->joints[static_cast<std::size_t>(i)];
      const double lower = std::isfinite(j.lower) ? j.lower : -M_PI;
      const double upper = std::isfinite(j.upper) ? j.upper : M_PI;
      begin[i] = lower + (upper - lower) * random.uniform();
    }
    const auto q = attempt(begin);
    if (q && (!best || (*q - start).cwiseAbs().maxCoeff() < (*best - start).cwiseAbs().maxCoeff()))
      best = q;
  }
  return best;
}

}  // namespace hapsim
