#include "imaging/lump_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/random.h"
#include "imaging/lump_errors.h"
#include "imaging/lump_signal.h"

namespace hapsim {
namespace {

using State = Eigen::Matrix<double, 5, 1>;  // x, y, z, log radius, log ratio

constexpr int kBurn = 4000, kKept = 12000, kEvery = 4, kRounds = 4;
constexpr std::size_t kDraws = 300;  // that are kept of the posterior
constexpr double kSettled = 4;       // of chi^2, at the balls that are solved anew
constexpr std::size_t kMostSolved = 16, kMostBeside = 10;  // positions about a ball

struct Sample {
  State at;
  double depth = 0;
};

struct Chain {
  std::vector<Sample> samples;
  State best = State::Zero();
  double least = std::numeric_limits<double>::infinity();  // of chi^2
};

// The ball that all of one posterior's rounds are about.
class Search {
 public:
  Search(const LumpData& data, const LumpScene& scene, bool stiffer)
      : data_(data), scene_(scene), stiffer_(stiffer), signal_(data) {}

  Eigen::VectorXd signal(const State& s) const {
    return signal_.at(s.head<3>(), std::exp(s[3]), std::exp(s[4]));
  }
  LumpSignal& model() { return signal_; }

  // The depth of the centre, or a negative number where no such ball may be.
  double depth_of(const State& s) const {
    constexpr double kAside = 3;  // tool radii from the nearest press
    const double radius = std::exp(s[3]), ratio = std::exp(s[4]);
    if (radius < 0.4 * scene_.tool_radius || (ratio > 1) != stiffer_) return -1;
    if (ratio < kLeastRatio || ratio > kMostRatio) return -1;
    const double depth = -scene_.surface.at(s.head<3>()).distance;
    if (depth < 1.02 * radius || depth > scene_.largest_depth) return -1;
    for (const PreparedContact& c : scene_.contacts) {
      const Vec3 d = s.head<3>() - c.point;
      if ((d - d.dot(c.normal) * c.normal).norm() < kAside * scene_.tool_radius) return depth;
    }
    return -1;
  }

  // Metropolis' chain whose steps learn the posterior's shape while it burns in.
  Chain run(const LumpErrors& errors, const State& start, int burn, int kept) const {
    Random random(7);
    const Eigen::VectorXd data = errors.white(data_.gain);
    const auto chi2_of = [&](const State& s) {
      return (data - errors.white(signal(s))).squaredNorm();
    };
    Chain chain;
    State at = start;
    double depth = depth_of(at), chi2 = chi2_of(at);
    chain.best = at;
    chain.least = chi2;
    const double step = scene_.tool_radius;
    State width;
    width << 0.1 * step, 0.1 * step, 0.1 * step, 0.1, 0.2;
    Eigen::Matrix<double, 5, 5> shape = width.asDiagonal();
    double scale = 1;
    State mean = at;
    Eigen::Matrix<double, 5, 5> spread = width.cwiseAbs2().asDiagonal();
    for (int k = 0; k < burn + kept; ++k) {
      State z;
      for (int i = 0; i < 5; ++i) z[i] = random.normal();
      const State to = at + scale * shape * z;
      const double to_depth = depth_of(to);
      double accepted = 0;
      if (to_depth > 0) {
        const double to_chi2 = chi2_of(to);
        accepted = std::min(1.0, std::exp(0.5 * (chi2 - to_chi2)));
        if (random.uniform() < accepted) {
          at = to;
          chi2 = to_chi2;
          depth = to_depth;
          if (chi2 < chain.least) {
            chain.least = chi2;
            chain.best = at;
          }
        }
      }
      if (k < burn) {
        const double gain = 1 / std::pow(k + 2.0, 0.6);
        scale *= std::exp(gain * (accepted - 0.25));
        const State d = at - mean;
        mean += gain * d;
        spread += gain * (d * d.transpose() - spread);
        if (k % 50 == 49) {
          Eigen::Matrix<double, 5, 5> safe = spread;
          safe.diagonal() += 1e-4 * width.cwiseAbs2();
          shape = safe.llt().matrixL();
        }
      } else if (k % kEvery == 0) {
        chain.samples.push_back({at, depth});
      }
    }
    return chain;
  }

  // The common error of a position at which this ball leaves what chance would leave.
  double common_error(const State& best, const Eigen::MatrixXd& slopes) const {
    const Eigen::VectorXd left = data_.gain - signal(best);
    double low = data_.floor, high = 0.5;
    const auto too_much = [&](double common) {
      const LumpErrors errors(data_, common, slopes);
      return errors.chi2(left) > static_cast<double>(errors.freedom() - 5);
    };
    if (!too_much(low)) return low;
    for (int k = 0; k < 20; ++k) (too_much(0.5 * (low + high)) ? low : high) = 0.5 * (low + high);
    return high;
  }

  // What a metre of the contact points to the side does to the gains: the ball moves the other way.
  Eigen::MatrixXd slopes(const State& s) const {
    const double h = 0.2 * scene_.tool_radius;
    Eigen::MatrixXd by(data_.gain.size(), 3);
    for (int c = 0; c < 3; ++c) {
      State up = s, down = s;
      up[c] += h;
      down[c] -= h;
      by.col(c) = (signal(up) - signal(down)) / (2 * h);
    }
    Eigen::MatrixXd result(by.rows(), 2);
    for (Eigen::Index v = 0; v < by.rows(); ++v) {
      const Vec3& n = scene_.contacts[static_cast<std::size_t>(data_.position[v])].normal;
      const Vec3 a = n.unitOrthogonal(), b = n.cross(a);
      result(v, 0) = by.row(v) * a;
      result(v, 1) = by.row(v) * b;
    }
    return result;
  }

  Eigen::MatrixXd tangent(const State& s) const {
    Eigen::MatrixXd by(data_.gain.size(), 5);
    for (int c = 0; c < 5; ++c) {
      State up = s, down = s;
      const double h = c < 3 ? 0.2 * scene_.tool_radius : 0.05;
      up[c] += h;
      down[c] -= h;
      by.col(c) = (signal(up) - signal(down)) / (2 * h);
    }
    return by;
  }

  // Positions whose gains such a ball changes by some share of their errors, the most changed
  // first.
  std::vector<int> touched(const State& s, const LumpErrors& errors, std::size_t count) const {
    const Eigen::VectorXd change = signal(s).cwiseQuotient(errors.standard()).cwiseAbs();
    std::vector<double> most(scene_.contacts.size(), 0);
    for (Eigen::Index v = 0; v < change.size(); ++v) {
      double& m = most[static_cast<std::size_t>(data_.position[v])];
      m = std::max(m, change[v]);
    }
    std::vector<int> order(most.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return most[a] > most[b]; });
    std::erase_if(order, [&](int p) { return most[p] < 0.3; });
    if (order.size() > count) order.resize(count);
    return order;
  }

 private:
  const LumpData& data_;
  const LumpScene& scene_;
  bool stiffer_;
  LumpSignal signal_;
};

double quantile(std::vector<double> values, double share) {
  const auto at = static_cast<std::size_t>(share * static_cast<double>(values.size() - 1) + 0.5);
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(at), values.end());
  return values[at];
}

// Mean states about some radii of the ridge, in ascending order of the radius, or about the middle.
std::vector<State> along_ridge(std::vector<Sample> samples, bool middle_alone) {
  std::stable_sort(samples.begin(), samples.end(),
                   [](const Sample& a, const Sample& b) { return a.at[3] < b.at[3]; });
  const std::size_t n = samples.size();
  const double spread = samples[n * 9 / 10].at[3] - samples[n / 10].at[3];
  std::vector<State> states;
  for (const double share : {0.08, 0.5, 0.92}) {
    if ((spread < 0.12 || middle_alone) && share != 0.5) continue;
    const auto middle = static_cast<std::size_t>(share * static_cast<double>(n));
    const std::size_t half = std::max<std::size_t>(1, n / 25);
    State sum = State::Zero();
    double count = 0;
    for (std::size_t k = middle - std::min(middle, half); k < std::min(n, middle + half); ++k) {
      sum += samples[k].at;
      ++count;
    }
    states.push_back(sum / count);
  }
  return states;
}

template <class Value>
Interval middle_95(const std::vector<Sample>& samples, const Value& value, double* median) {
  std::vector<double> values;
  for (const Sample& s : samples) values.push_back(value(s));
  if (median != nullptr) *median = quantile(values, 0.5);
  return {quantile(values, 0.025), quantile(values, 0.975)};
}

}  // namespace

LumpPosterior fit_lump(const LumpData& data, const LumpScene& scene, const Lump& start,
                       const BallSolver& solve) {
  const bool stiffer = start.ratio > 1;
  Search search(data, scene, stiffer);
  State at;
  at << start.centre, std::log(start.radius), std::log(start.ratio);
  if (search.depth_of(at) <= 0) {  // as large as there is room for, and no more extreme than asked
    const double depth = -scene.surface.at(start.centre).distance;
    at[3] = std::log(std::clamp(start.radius, 0.41 * scene.tool_radius,
                                std::max(0.42 * scene.tool_radius, 0.95 * depth)));
    at[4] = std::log(std::clamp(start.ratio, 1.1 * kLeastRatio, 0.9 * kMostRatio));
  }
  double common = search.common_error(at, {});
  Eigen::MatrixXd slopes;
  LumpErrors errors(data, common, slopes);
  Chain chain = search.run(errors, at, kBurn, kKept);
  for (int round = 0; round < kRounds; ++round) {
    slopes = search.slopes(chain.best);
    common = search.common_error(chain.best, slopes);
    errors = LumpErrors(data, common, slopes);
    double change = 0;  // of chi^2, at the balls that are solved
    const std::vector<State> ridge = along_ridge(chain.samples, round == 0);
    for (const State& s : ridge) {
      const bool beside = ridge.size() > 1 && &s != &ridge[1];
      const Vec3 centre = s.head<3>();
      const double radius = std::min(std::exp(s[3]), 0.93 * -scene.surface.at(centre).distance);
      const Eigen::MatrixXd gains =
          solve(centre, radius, solved_ratios(stiffer),
                search.touched(s, errors, beside ? kMostBeside : kMostSolved));
      State same = s;
      same[3] = std::log(radius);
      const Eigen::VectorXd before = search.signal(same);
      search.model().add(
          solved_ball(centre, radius, stiffer, gains, search.model().share(centre, radius)));
      change = std::max(change, errors.chi2(before - search.signal(same)));
    }
    chain = search.run(errors, chain.best, kBurn, kKept);
    if (round > 0 && change < kSettled) break;
  }
  slopes = search.slopes(chain.best);
  LumpPosterior result;
  result.error = search.common_error(chain.best, slopes);
  errors = LumpErrors(data, result.error, slopes);
  chain = search.run(errors, chain.best, kBurn, 2 * kKept);
  Lump& lump = result.lump;
  const auto& samples = chain.samples;
  lump.x = middle_95(
      samples, [](const Sample& s) { return s.at[0]; }, &lump.centre[0]);
  lump.y = middle_95(
      samples, [](const Sample& s) { return s.at[1]; }, &lump.centre[1]);
  lump.z = middle_95(
      samples, [](const Sample& s) { return s.at[2]; }, &lump.centre[2]);
  lump.depth_in = middle_95(
      samples, [](const Sample& s) { return s.depth; }, &lump.depth);
  lump.radius_in = middle_95(
      samples, [](const Sample& s) { return std::exp(s.at[3]); }, &lump.radius);
  lump.ratio_in = middle_95(
      samples, [](const Sample& s) { return std::exp(s.at[4]); }, &lump.ratio);
  for (std::size_t k = 0; k < samples.size(); k += samples.size() / kDraws)
    lump.draws.push_back(
        {samples[k].at.head<3>(), std::exp(samples[k].at[3]), std::exp(samples[k].at[4])});
  lump.drop = errors.chi2(data.gain) - chain.least;
  result.signal = search.signal(chain.best);
  result.tangent = search.tangent(chain.best);
  return result;
}

}  // namespace hapsim
