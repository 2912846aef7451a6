#include "imaging/lump_signal.h"

#include <algorithm>
#include <cmath>

#include "imaging/ball_signal.h"

namespace hapsim {

std::vector<double> solved_ratios(bool stiffer) {
  return stiffer ? std::vector<double>{3, 15} : std::vector<double>{0.4, 0.05};
}

SolvedBall solved_ball(const Vec3& centre, double radius, bool stiffer,
                       const Eigen::MatrixXd& log_gains, const Eigen::VectorXd& share) {
  // Below that of the largest share a quotient says nothing.
  constexpr double kLeast = 0.03;
  const std::vector<double> ratios = solved_ratios(stiffer);
  const double t1 = ratios[0] - 1, t2 = ratios[1] - 1, most = share.cwiseAbs().maxCoeff();
  SolvedBall ball{centre, radius, Eigen::VectorXd::Constant(share.size(), 1),
                  Eigen::VectorXd::Constant(share.size(), 0.4)};
  double weight = 0, factor = 0, b = 0;
  std::vector<Eigen::Index> lacking;
  for (Eigen::Index v = 0; v < share.size(); ++v) {
    const double s1 = log_gains(v, 0), s2 = log_gains(v, 1);
    if (!(share[v] > kLeast * most) || !(s1 / t1 > 0) || !(s2 / t2 > 0)) {
      lacking.push_back(v);
      continue;
    }
    // 1/s = 1/(A t) + B/A.
    const double inverse_A = (1 / s1 - 1 / s2) / (1 / t1 - 1 / t2);
    const double B_over_A = 1 / s1 - inverse_A / t1;
    if (!(inverse_A > 0)) {
      lacking.push_back(v);
      continue;
    }
    ball.factor[v] = 1 / inverse_A / share[v];
    ball.B[v] = std::clamp(B_over_A / inverse_A, 0.0, 0.95);
    const double w = share[v] * share[v];
    weight += w;
    factor += w * ball.factor[v];
    b += w * ball.B[v];
  }
  if (weight > 0)
    for (const Eigen::Index v : lacking) {
      ball.factor[v] = factor / weight;
      ball.B[v] = b / weight;
    }
  return ball;
}

Eigen::VectorXd LumpSignal::share(const Vec3& centre, double radius) const {
  return ball_signal(data_.J, data_.grid, centre, radius);
}

Eigen::VectorXd LumpSignal::at(const Vec3& centre, double radius, double ratio) const {
  const Eigen::VectorXd e = share(centre, radius);
  if (solved_.empty()) return ball_effect(ratio) * e;
  const double t = ratio - 1;
  double weight = 0;
  Eigen::ArrayXd sum = Eigen::ArrayXd::Zero(e.size());
  for (const SolvedBall& s : solved_) {
    constexpr double kSame = 1e-4;  // so near that it is the same ball
    const double aside = (centre - s.centre).squaredNorm() / (radius * s.radius);
    const double square = aside + std::pow(std::log(radius / s.radius), 2) + kSame;
    const double w = 1 / (square * square);
    weight += w;
    sum += w * s.factor.array() / (1 + t * s.B.array());
  }
  return (t / weight * e.array() * sum).matrix();
}

}  // namespace hapsim
