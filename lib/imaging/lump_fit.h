// One ball of another modulus inside a body, with all that the presses leave open about it.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "contact/contact_library.h"
#include "contact/field_stiffness.h"
#include "mesh/signed_distance.h"

namespace hapsim {

struct Interval {
  double low = 0, high = 0;
  bool holds(double value) const { return low <= value && value <= high; }
};

// Ratios that are asked: beyond them a ball does what a rigid one, or a cavity, does.
constexpr double kLeastRatio = 0.02, kMostRatio = 50;

// One ball that the presses allow.
struct LumpDraw {
  Vec3 centre = Vec3::Zero();    // [m]
  double radius = 0, ratio = 1;  // [m]
};

// A ball, and the middle 95 % of what its numbers may be.
struct Lump {
  Vec3 centre = Vec3::Zero();    // [m]
  double depth = 0;              // of the centre below the surface [m]
  double radius = 0, ratio = 1;  // [m]; modulus over that around it
  Interval x, y, z, depth_in, radius_in, ratio_in;
  double chance = 1;            // that a body without one looks so at some place
  double drop = 0;              // of chi^2
  std::vector<LumpDraw> draws;  // of its posterior, alike likely
};

// Log gains of the presses (views), and how they err.
struct LumpData {
  Eigen::VectorXd gain, noise;  // log gains over the body without lumps; standard errors
  std::vector<int> position;    // of each view, in ascending order
  Eigen::MatrixXd free;         // views x directions that are not told from other causes
  double off = 0;               // error of a contact point along the surface [m]
  double floor = 0;             // least error that the views of a position have in common
  Eigen::MatrixXd J;            // views x nodes: derivatives of the log gains by log E
  FieldGrid grid;
};

struct LumpScene {
  const std::vector<PreparedContact>& contacts;
  const SignedDistance& surface;  // of the body
  double tool_radius = 0;         // [m]
  double largest_depth = 0;       // [m]
};

// Log gains (views x ratios) that a ball at that place gives the views of the asked positions, by
// finite elements; NaN elsewhere and where the ball cannot be meshed.
using BallSolver = std::function<Eigen::MatrixXd(const Vec3& centre, double radius,
                                                 const std::vector<double>& ratios,
                                                 const std::vector<int>& positions)>;

struct LumpPosterior {
  Lump lump;
  Eigen::VectorXd signal;   // of its most likely values, by view
  Eigen::MatrixXd tangent;  // derivatives of that by its values
  double error = 0;         // that the views of a position have in common, as it was found
};

// Samples the posterior of centre, radius and ratio (Metropolis' chain, J. Chem. Phys. 21, 1953):
// even over the places below the presses, the logarithms of radius and ratio. The signal is the
// ball's share of the energies (ball_signal.h), times what finite elements say of it at balls along
// the posterior's ridge, where it is solved again until that changes nothing. Gains err by their
// noise, by what the views of a position have in common (as large as the best ball leaves) and by
// contact points that lie off. `start`: where a first search found it.
LumpPosterior fit_lump(const LumpData& data, const LumpScene& scene, const Lump& start,
                       const BallSolver& solve);

}  // namespace hapsim
