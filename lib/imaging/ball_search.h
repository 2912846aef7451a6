// A ball of another modulus inside a body that explains what each press asks for.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "contact/contact_library.h"
#include "contact/field_stiffness.h"

namespace hapsim {

// One ball of another modulus that explains the presses better than no ball: its centre with the
// standard errors along x, y, z, its radius and the ratio of its modulus, which trade for each
// other.
struct FoundBall {
  Vec3 centre = Vec3::Zero(), error = Vec3::Zero();
  double depth = 0, depth_error = 0;  // of the centre below the surface [m]
  double radius = 0, ratio = 1;
  double drop = 0;    // of chi^2
  double chance = 1;  // that a body without a ball has such a drop at some place
};

// One body in so many that has no ball is said to have one: kFalseAlarm of them.
constexpr double kFalseAlarm = 0.005;

// Down to which depth of its centre such a ball is found in 95 of 100.
struct Sight {
  double radius = 0, ratio = 1, depth = 0;  // [m]; depth 0: nowhere
};

struct BallSearch {
  std::optional<FoundBall> ball;  // none: nothing compact is seen
  std::vector<Sight> sight;
  Eigen::VectorXd errors;    // relative standard error of each gain, with what the best ball leaves
  double error = 0;          // their root mean square
  double critical = 0;       // the drop of chi^2 from which on a ball is claimed
  double misfit_before = 0;  // of the log gains without balls or field
};

struct BallScene {
  const std::vector<PreparedContact>& contacts;
  const Surface& surface;    // of the body
  double tool_radius = 0;    // [m]
  double largest_depth = 0;  // [m]
  // Gains x directions that are not told from other causes; empty: a common gain.
  Eigen::MatrixXd free = {};
  double least_error = 0;  // of a gain, beside its noise
  int threads = 0;         // 0: as many as the machine has
};

// A ball that could be there, and its ball_signal().
struct BallCandidate {
  Vec3 centre;
  double depth = 0, radius = 0;  // [m]
  Eigen::VectorXd signal;
};

// Balls of several sizes about the nodes of the grid that lie wholly inside the body and under the
// presses. Depends on nothing that was measured.
std::vector<BallCandidate> ball_candidates(const Eigen::MatrixXd& J, const FieldGrid& grid,
                                           const BallScene& scene);

// `J`: derivatives of the log gains `data` by log E at the nodes of the grid; `noise`: their
// standard errors. The best of the `candidates` (ball_candidates()), at errors that grow until it
// leaves no misfit; it must drop chi^2 by more than all places together do by chance in kFalseAlarm
// of the bodies without one (drawn).
BallSearch search_ball(const Eigen::MatrixXd& J, const FieldGrid& grid,
                       const std::vector<BallCandidate>& candidates, const Eigen::VectorXd& data,
                       const Eigen::VectorXd& noise, const BallScene& scene);

}  // namespace hapsim
