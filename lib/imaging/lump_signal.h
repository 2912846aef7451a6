// What a ball does to the gains: its share of the energies, put right by finite elements.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "imaging/lump_fit.h"

namespace hapsim {

// A ball that was solved. The log gain of a view is A t / (1 + B t), t = ratio - 1 (exact for a
// small ball in an even strain), with A as a factor on the ball's share of the energies.
struct SolvedBall {
  Vec3 centre = Vec3::Zero();
  double radius = 0;       // [m]
  Eigen::VectorXd factor;  // by view
  Eigen::VectorXd B;
};

// The ratios at which a stiffer, or a softer, ball is solved.
std::vector<double> solved_ratios(bool stiffer);
// From log gains at these ratios (views x 2, NaN where not solved: there the mean of the others
// over `share`, the ball's own).
SolvedBall solved_ball(const Vec3& centre, double radius, bool stiffer,
                       const Eigen::MatrixXd& log_gains, const Eigen::VectorXd& share);

class LumpSignal {
 public:
  explicit LumpSignal(const LumpData& data) : data_(data) {}
  // Between solved balls what they say is weighted by the fourth power of their nearness (Shepard,
  // ACM National Conference, 1968), in centres over the radius and logarithms of the radius.
  void add(SolvedBall solved) { solved_.push_back(std::move(solved)); }
  Eigen::VectorXd share(const Vec3& centre, double radius) const;
  Eigen::VectorXd at(const Vec3& centre, double radius, double ratio) const;

 private:
  const LumpData& data_;
  std::vector<SolvedBall> solved_;
};

}  // namespace hapsim
