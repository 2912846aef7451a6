#include "imaging/ball_search.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <numbers>

#include "base/parallel.h"
#include "base/random.h"
#include "imaging/ball_signal.h"
#include "mesh/signed_distance.h"

namespace hapsim {
namespace {

// The same by blocks, which are worth a thread's while.
void in_blocks(std::size_t count, int threads, const std::function<void(std::size_t)>& task) {
  constexpr std::size_t kBlock = 64;
  in_parallel((count + kBlock - 1) / kBlock, threads, [&](std::size_t b) {
    for (std::size_t i = b * kBlock; i < std::min(count, (b + 1) * kBlock); ++i) task(i);
  });
}

double ratio_of(double effect) {
  constexpr double kMost = 2.4;  // a rigid ball has 2.5
  const double e = std::min(effect, kMost);
  return std::max(0.02, 1 + e / (1 - 0.4 * e));
}

// Least squares of the gains on what is free and a ball of unknown effect.
class Scan {
 public:
  Scan(const Eigen::VectorXd& data, const Eigen::VectorXd& error, const Eigen::MatrixXd& free)
      : weight_(error.cwiseInverse()), data_(data.cwiseProduct(weight_)) {
    if (free.cols() == 0) explain(Eigen::VectorXd::Ones(data.size()));
    for (Eigen::Index c = 0; c < free.cols(); ++c) explain(free.col(c));
  }
  // Takes a signal out of everything that follows.
  void explain(const Eigen::VectorXd& signal) {
    const Eigen::VectorXd whole = signal.cwiseProduct(weight_);
    Eigen::VectorXd q = out(whole);
    if (!(q.norm() > 1e-3 * whole.norm())) return;  // the others span it
    q.normalize();
    data_ -= q * q.dot(data_);
    basis_.push_back(q);
  }
  double chi2() const { return data_.squaredNorm(); }
  // Effect of a signal and what it takes from chi^2.
  std::pair<double, double> fit(const Eigen::VectorXd& signal) const {
    const Eigen::VectorXd s = out(signal.cwiseProduct(weight_));
    const double power = s.squaredNorm(), product = s.dot(data_);
    return power > 0 ? std::pair(product / power, product * product / power) : std::pair(0.0, 0.0);
  }
  double size(const Eigen::VectorXd& signal) const { return left(signal).norm(); }
  // Of a signal over its errors, what is not explained.
  Eigen::VectorXd left(const Eigen::VectorXd& signal) const {
    return out(signal.cwiseProduct(weight_));
  }

 private:
  Eigen::VectorXd out(Eigen::VectorXd s) const {
    for (const Eigen::VectorXd& q : basis_) s -= q * q.dot(s);
    return s;
  }
  Eigen::VectorXd weight_, data_;
  std::vector<Eigen::VectorXd> basis_;
};

// The best ball; its numbers are means over all candidates by their likelihood.
FoundBall best_ball(const Scan& scan, const std::vector<BallCandidate>& all, int threads) {
  double most = 0;
  std::vector<std::pair<double, double>> fits(all.size());
  in_blocks(all.size(), threads, [&](std::size_t i) {
    fits[i] = scan.fit(all[i].signal);
    const bool possible = fits[i].first > ball_effect(0.02) && fits[i].first < 2.4;
    if (!possible) fits[i].second = 0;
  });
  for (const auto& [effect, drop] : fits) most = std::max(most, drop);
  FoundBall ball;
  ball.drop = most;
  double sum = 0, log_radius = 0, log_ratio = 0, squares = 0;
  Vec3 square = Vec3::Zero();
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double likelihood = std::exp(0.5 * (fits[i].second - most));
    if (fits[i].second == 0 || likelihood < 1e-6) continue;
    sum += likelihood;
    ball.centre += likelihood * all[i].centre;
    square += likelihood * all[i].centre.cwiseAbs2();
    ball.depth += likelihood * all[i].depth;
    squares += likelihood * all[i].depth * all[i].depth;
    log_radius += likelihood * std::log(all[i].radius);
    log_ratio += likelihood * std::log(ratio_of(fits[i].first));
  }
  if (sum == 0) return {};
  ball.centre /= sum;
  ball.depth /= sum;
  ball.error = (square / sum - ball.centre.cwiseAbs2()).cwiseMax(0).cwiseSqrt();
  ball.depth_error = std::sqrt(std::max(0.0, squares / sum - ball.depth * ball.depth));
  ball.radius = std::exp(log_radius / sum);
  ball.ratio = std::exp(log_ratio / sum);
  return ball;
}

// The largest drop of chi^2 over all places that noise alone makes: Gumbel's law of the greatest,
// from draws.
struct ByChance {
  double mode = 0, scale = 1;
  double critical(double chance) const { return mode - scale * std::log(-std::log1p(-chance)); }
  double chance(double drop) const { return -std::expm1(-std::exp(-(drop - mode) / scale)); }
};

ByChance by_chance(const Scan& scan, const std::vector<BallCandidate>& all) {
  constexpr std::size_t kMost = 4000;  // neighbours say nearly the same
  constexpr int kDraws = 300;
  if (all.empty()) return {};
  const Eigen::Index n = all.front().signal.size();
  const std::size_t every = (all.size() + kMost - 1) / kMost;
  Eigen::MatrixXd signals(n, static_cast<Eigen::Index>((all.size() + every - 1) / every));
  for (Eigen::Index k = 0; k < signals.cols(); ++k) {
    signals.col(k) = scan.left(all[static_cast<std::size_t>(k) * every].signal);
    const double norm = signals.col(k).norm();
    if (norm > 0) signals.col(k) /= norm;
  }
  Random random(1);
  Eigen::MatrixXd draws(n, kDraws);
  for (Eigen::Index k = 0; k < draws.size(); ++k) draws.data()[k] = random.normal();
  const Eigen::VectorXd most =
      (signals.transpose() * draws).cwiseAbs2().colwise().maxCoeff().transpose();
  const double mean = most.mean();
  const double deviation = std::sqrt((most.array() - mean).square().mean());
  const double scale = deviation * std::sqrt(6.0) / std::numbers::pi;
  return {mean - std::numbers::egamma * scale, scale};
}

}  // namespace

std::vector<BallCandidate> ball_candidates(const Eigen::MatrixXd& J, const FieldGrid& grid,
                                           const BallScene& w) {
  const SignedDistance surface(w.surface);
  const double tool = w.tool_radius;
  std::vector<std::vector<BallCandidate>> at(grid.size());
  in_blocks(grid.size(), w.threads, [&](std::size_t n) {
    const Vec3 p = grid.node(n);
    const double depth = -surface.at(p).distance;
    if (depth <= 0 || depth > w.largest_depth) return;
    double nearest = std::numeric_limits<double>::infinity();
    for (const PreparedContact& contact : w.contacts) {
      const Vec3 d = p - contact.point;
      nearest = std::min(nearest, (d - d.dot(contact.normal) * contact.normal).norm());
    }
    if (nearest > 3 * tool) return;  // not under the presses
    for (const double radius : {0.75 * tool, tool, 1.5 * tool, 2 * tool, 3 * tool})
      if (depth >= radius) at[n].push_back({p, depth, radius, ball_signal(J, grid, p, radius)});
  });
  std::vector<BallCandidate> all;
  for (std::vector<BallCandidate>& some : at)
    std::move(some.begin(), some.end(), std::back_inserter(all));
  return all;
}

BallSearch search_ball(const Eigen::MatrixXd& J, const FieldGrid& grid,
                       const std::vector<BallCandidate>& all, const Eigen::VectorXd& data,
                       const Eigen::VectorXd& noise, const BallScene& w) {
  const Eigen::Index n = data.size();
  const double tool = w.tool_radius, depth = w.largest_depth;
  BallSearch image;

  // Errors that grow, alike everywhere, until the best ball leaves no more than they allow.
  const auto errors = [&](double extra) -> Eigen::VectorXd {
    return (noise.array().square() + extra * extra).sqrt();
  };
  const auto too_small = [&](double extra) {
    const Scan scan(data, errors(extra), w.free);
    const double left = (scan.chi2() - best_ball(scan, all, w.threads).drop) /
                        std::max<double>(1, static_cast<double>(n) - 6);
    return left > 1.05;
  };
  double extra = w.least_error;
  if (too_small(extra)) {
    double high = std::max(2 * extra, 0.01);
    while (too_small(high) && high < 10) {
      extra = high;
      high *= 2;
    }
    while (high - extra > 0.05 * high)
      (too_small(0.5 * (extra + high)) ? extra : high) = 0.5 * (extra + high);
    extra = high;
  }
  const Eigen::VectorXd error = errors(extra);
  image.error = std::sqrt(error.cwiseAbs2().mean());
  const Scan scan(data, error, w.free);
  image.misfit_before = std::sqrt(scan.chi2() / double(n)) * image.error;
  const ByChance chance = by_chance(scan, all);
  image.critical = chance.critical(kFalseAlarm);
  FoundBall ball = best_ball(scan, all, w.threads);
  if (ball.drop >= image.critical) {
    ball.chance = chance.chance(ball.drop);
    // The candidates are a step apart, and the linear signal errs as well.
    ball.error = (ball.error.cwiseAbs2() + Vec3::Constant(grid.step * grid.step / 4)).cwiseSqrt();
    ball.depth_error = std::hypot(ball.depth_error, grid.step / 2);
    image.ball = ball;
  }

  // How deep: under the position nearest to the middle of all.
  Vec3 middle = Vec3::Zero();
  for (const PreparedContact& c : w.contacts) middle += c.point / double(w.contacts.size());
  std::size_t at = 0;
  for (std::size_t p = 0; p < w.contacts.size(); ++p)
    if ((w.contacts[p].point - middle).norm() < (w.contacts[at].point - middle).norm()) at = p;
  const double seen = std::sqrt(image.critical) + 1.645;  // found in 95 of 100
  for (const double radius : {tool, 1.5 * tool, 3 * tool})
    for (const double ratio : {0.02, 2.0, 5.0}) {
      Sight sight{radius, ratio, 0};
      for (double d = radius; d <= depth; d += 0.25 * tool) {
        const Vec3 centre = w.contacts[at].point - d * w.contacts[at].normal;
        const double size = scan.size(ball_signal(J, grid, centre, radius));
        if (std::abs(ball_effect(ratio)) * size < seen) break;
        sight.depth = d;
      }
      image.sight.push_back(sight);
    }
  image.errors = error;
  return image;
}

}  // namespace hapsim
