#include "model/stiffness_image.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/parallel.h"
#include "effects/catalogue.h"
#include "geometry/signed_distance.h"

namespace hapsim {
namespace {

constexpr double kRim = 0.25;      // edge length at the rim over the radius, of the image's meshes
constexpr double kLinear = 0.25;   // share of a strong ball's signal that the linear one may miss
constexpr double kLeastDrop = 30;  // of chi^2 for a ball, among the many places it could be

// What a ball of ratio q adds to the stiffness, over what its volume would at small contrast.
double effective(double ratio) {
  return (ratio - 1) / (1 + 0.4 * (ratio - 1));
}
double ratio_of(double effect) {
  constexpr double kMost = 2.4;  // a rigid ball has 2.5
  const double e = std::min(effect, kMost);
  return std::max(0.02, 1 + e / (1 - 0.4 * e));
}

// What the steps share.
struct Scene {
  const Dataset& dataset;
  const BodyStiffness& stiffness;
  const ContactBase& base;
  double tool;  // radius [m]
  const std::vector<Vec3>& positions() const { return dataset.positions; }
  const Vec3& normal(std::size_t p) const { return stiffness.contacts()[p].normal; }
};

FieldGrid grid_about(const Scene& w, double step, double depth) {
  Vec3 low = w.positions().front(), high = low;
  for (std::size_t p = 0; p < w.positions().size(); ++p) {
    const Vec3& top = w.positions()[p];
    const Vec3 deep = top - depth * w.normal(p);
    low = low.cwiseMin(top).cwiseMin(deep);
    high = high.cwiseMax(top).cwiseMax(deep);
  }
  Eigen::AlignedBox3d box;
  for (const Vec3& v : w.base.fine.vertices) box.extend(v);
  const double margin = 4 * w.tool;
  low = (low - Vec3::Constant(margin)).cwiseMax(box.min());
  high = (high + Vec3::Constant(margin)).cwiseMin(box.max());
  FieldGrid grid;
  grid.low = low;
  grid.step = step;
  for (int c = 0; c < 3; ++c)
    grid.count[c] = 1 + static_cast<int>(std::ceil((high[c] - low[c]) / step - 1e-9));
  return grid;
}

// Derivatives of the log gains by log E at the nodes: views x nodes.
Eigen::MatrixXd sensitivities(const Scene& w, double nu, const std::vector<ImageView>& views,
                              const FieldGrid& grid, const ImageOptions& options) {
  Eigen::MatrixXd J(static_cast<Eigen::Index>(views.size()),
                    static_cast<Eigen::Index>(grid.size()));
  const Eigen::VectorXd homogeneous = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(grid.size()));
  in_parallel(w.positions().size(), options.threads, [&](std::size_t p) {
    FieldBody field(w.base, w.positions()[p], w.tool, kRim * w.tool, kGrowth, grid);
    const FieldBody::Solution s = field.solve(nu, homogeneous, true);
    const Eigen::MatrixXd by_node = field.by_node(s);
    // The coarser mesh's K is brought to the model's: K = S K_c S'.
    Eigen::Matrix3d fine, by_nu;
    w.stiffness.contacts()[p].stiffness.evaluate(nu, fine, by_nu);
    const Eigen::Matrix3d S =
        fine.llt().matrixL().toDenseMatrix() * s.K.llt().matrixL().toDenseMatrix().inverse();
    for (std::size_t v = 0; v < views.size(); ++v) {
      if (views[v].position != static_cast<int>(p)) continue;
      const Eigen::Matrix3d C = S.transpose() * views[v].B * S;
      Eigen::Matrix<double, 1, 6> row;
      row << C(0, 0), C(1, 1), C(2, 2), C(0, 1) + C(1, 0), C(1, 2) + C(2, 1), C(0, 2) + C(2, 0);
      J.row(static_cast<Eigen::Index>(v)) = row * by_node / (C * s.K).trace();
    }
    if (options.progress) options.progress();
  });
  return J;
}

// What a ball of unit effect does to the log gains: the share of the energy inside it.
Eigen::VectorXd ball_signal(const Eigen::MatrixXd& J, const FieldGrid& grid, const Vec3& centre,
                            double radius) {
  // Nodes stand for their cells; cells that the boundary cuts count by how far they reach in. The
  // whole has the ball's volume.
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(J.rows());
  double volume = 0;
  std::array<int, 3> from{}, to{};
  for (int c = 0; c < 3; ++c) {
    const double at = (centre[c] - grid.low[c]) / grid.step, reach = radius / grid.step + 0.5;
    from[c] = std::max(0, static_cast<int>(std::ceil(at - reach)));
    to[c] = std::min(grid.count[c] - 1, static_cast<int>(std::floor(at + reach)));
  }
  for (int k = from[2]; k <= to[2]; ++k)
    for (int j = from[1]; j <= to[1]; ++j)
      for (int i = from[0]; i <= to[0]; ++i) {
        const std::size_t n = grid.index(i, j, k);
        const double inside = (radius - (grid.node(n) - centre).norm()) / grid.step + 0.5;
        const double share = std::clamp(inside, 0.0, 1.0);
        if (share == 0) continue;
        sum += share * J.col(static_cast<Eigen::Index>(n));
        volume += share * std::pow(grid.step, 3);
      }
  const double wanted = 4.0 / 3 * std::numbers::pi * std::pow(radius, 3);
  return volume > 0 ? Eigen::VectorXd(wanted / volume * sum) : sum;
}

struct Candidate {
  Vec3 centre;
  double depth = 0, radius = 0;
  Eigen::VectorXd signal;
};

std::vector<Candidate> candidates(const Eigen::MatrixXd& J, const FieldGrid& grid, const Scene& w,
                                  double largest_depth) {
  const SignedDistance surface(w.base.fine);
  const double tool = w.tool;
  std::vector<Candidate> result;
  for (std::size_t n = 0; n < grid.size(); ++n) {
    const Vec3 p = grid.node(n);
    const double depth = -surface.at(p).distance;
    if (depth <= 0 || depth > largest_depth) continue;
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t q = 0; q < w.positions().size(); ++q) {
      const Vec3 d = p - w.positions()[q];
      const Vec3& normal = w.normal(q);
      nearest = std::min(nearest, (d - d.dot(normal) * normal).norm());
    }
    if (nearest > 3 * tool) continue;  // not under the presses
    for (const double radius : {0.75 * tool, tool, 1.5 * tool, 2 * tool, 3 * tool})
      if (depth >= radius) result.push_back({p, depth, radius, ball_signal(J, grid, p, radius)});
  }
  return result;
}

// Least squares of the gains on a common gain, the balls so far and one more of unknown effect.
class Scan {
 public:
  Scan(const Eigen::VectorXd& data, const Eigen::VectorXd& error)
      : weight_(error.cwiseInverse()), data_(data.cwiseProduct(weight_)) {
    explain(Eigen::VectorXd::Ones(data.size()));
  }
  // Takes a signal out of everything that follows.
  void explain(const Eigen::VectorXd& signal) {
    Eigen::VectorXd q = out(signal.cwiseProduct(weight_));
    if (q.norm() <= 0) return;
    q.normalize();
    data_ -= q * q.dot(data_);
    basis_.push_back(q);
  }
  double chi2() const { return data_.squaredNorm(); }
  Eigen::Index freedom() const {
    return std::max<Eigen::Index>(1, data_.size() - static_cast<Eigen::Index>(basis_.size()));
  }
  // Effect of a signal and what it takes from chi^2.
  std::pair<double, double> fit(const Eigen::VectorXd& signal) const {
    const Eigen::VectorXd s = out(signal.cwiseProduct(weight_));
    const double power = s.squaredNorm(), product = s.dot(data_);
    return power > 0 ? std::pair(product / power, product * product / power) : std::pair(0.0, 0.0);
  }
  double size(const Eigen::VectorXd& signal) const {
    return out(signal.cwiseProduct(weight_)).norm();
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
FoundBall best_ball(const Scan& scan, const std::vector<Candidate>& all, double variance) {
  double most = 0;
  std::vector<std::pair<double, double>> fits;
  for (const Candidate& c : all) {
    fits.push_back(scan.fit(c.signal));
    const bool possible = fits.back().first > effective(0.02) && fits.back().first < 2.4;
    if (!possible) fits.back().second = 0;
    most = std::max(most, fits.back().second);
  }
  FoundBall ball;
  ball.drop = most / variance;
  double sum = 0, log_radius = 0, log_ratio = 0, squares = 0;
  Vec3 square = Vec3::Zero();
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double likelihood = std::exp(0.5 * (fits[i].second - most) / variance);
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

// The field on a grid twice as coarse, by the sensitivities of the finer one.
void solve_for_field(StiffnessImage& image, const Eigen::MatrixXd& J, const FieldGrid& fine,
                     const std::vector<ImageView>& views, const Eigen::VectorXd& data,
                     const Eigen::VectorXd& error, Penalty penalty) {
  FieldGrid& grid = image.grid;
  grid = fine;
  grid.step = 2 * fine.step;
  for (int& n : grid.count) n = (n + 2) / 2;
  FieldProblem problem;
  problem.J = Eigen::MatrixXd::Zero(J.rows(), static_cast<Eigen::Index>(grid.size()));
  Eigen::VectorXd weights(static_cast<Eigen::Index>(grid.size()));
  for (std::size_t n = 0; n < fine.size(); ++n) {
    weights.setZero();
    grid.add_weights(fine.node(n), 1, weights);
    for (Eigen::Index k = 0; k < weights.size(); ++k)
      if (weights[k] != 0) problem.J.col(k) += weights[k] * J.col(static_cast<Eigen::Index>(n));
  }
  Eigen::VectorXd seen = problem.J.colwise().norm().transpose();
  seen = (seen / seen.maxCoeff()).cwiseMax(1e-4).cwiseSqrt();
  problem.J = error.cwiseInverse().asDiagonal() * problem.J;
  problem.data = data.cwiseQuotient(error);
  for (const ImageView& v : views) problem.group.push_back(v.position);
  std::vector<double> edge_weight;
  for (int k = 0; k < grid.count[2]; ++k)
    for (int j = 0; j < grid.count[1]; ++j)
      for (int i = 0; i < grid.count[0]; ++i) {
        const std::size_t a = grid.index(i, j, k);
        const auto join = [&](bool there, std::size_t b) {
          if (!there) return;
          problem.edges.push_back({static_cast<int>(a), static_cast<int>(b)});
          edge_weight.push_back(
              0.5 * (seen[static_cast<Eigen::Index>(a)] + seen[static_cast<Eigen::Index>(b)]));
        };
        join(i + 1 < grid.count[0], a + 1);
        join(j + 1 < grid.count[1], grid.index(i, j + 1, k));
        join(k + 1 < grid.count[2], grid.index(i, j, k + 1));
      }
  problem.edge_weight = Eigen::Map<const Eigen::VectorXd>(
      edge_weight.data(), static_cast<Eigen::Index>(edge_weight.size()));
  problem.node_weight = 0.02 * seen;
  const FieldSolution s = solve_field(problem, penalty);
  const double unit = std::sqrt(error.cwiseAbs2().mean());
  image.log_ratio = s.m;
  image.weight = s.weight;
  image.misfit = s.misfit * unit;
  image.held_out = s.held_out * unit;
}

}  // namespace

std::vector<ImageView> image_views(const Model& model, const Dataset& dataset,
                                   const BodyStiffness& body, double noise) {
  Model without_sensor = model;
  std::erase_if(without_sensor.parameters, [](const Parameter& p) {
    return require_effect(p.effect).card().stage == Stage::kSensor;
  });
  const Selection all = all_episodes(dataset);
  const Eigen::VectorXd full = model_forces(model, dataset, all, body, false).f;
  const Eigen::VectorXd f = model_forces(without_sensor, dataset, all, body, false).f;
  const Eigen::VectorXd target = measured_forces(dataset, all) - (full - f);
  const MaterialSpec material = material_of(model);
  struct Sums {
    Vec3 direction;
    Eigen::Matrix3d ff = Eigen::Matrix3d::Zero();
    double ft = 0;
    int position = 0;
  };
  std::vector<Sums> sums;
  constexpr double kAlike = 0.966;  // 15 degrees
  Eigen::Index at = 0;
  for (const int e : all) {
    const Episode& episode = dataset.episodes[e];
    auto same = std::find_if(sums.begin(), sums.end(), [&](const Sums& s) {
      return s.position == episode.position && s.direction.dot(episode.view.direction) > kAlike;
    });
    if (same == sums.end()) {
      sums.push_back({episode.view.direction, Eigen::Matrix3d::Zero(), 0, episode.position});
      same = sums.end() - 1;
    }
    for (std::size_t i = 0; i < episode.rows.size(); ++i, at += 3) {
      same->ff += f.segment<3>(at) * f.segment<3>(at).transpose();
      same->ft += f.segment<3>(at).dot(target.segment<3>(at));
    }
  }
  std::vector<ImageView> views;
  for (const Sums& s : sums) {
    const double power = s.ff.trace();
    if (power <= 0 || s.ft <= 0) continue;
    const Eigen::Matrix3d K = body.at(static_cast<std::size_t>(s.position), material).K;
    views.push_back(
        {s.position, K.inverse() * s.ff / power, s.ft / power, noise / std::sqrt(power)});
  }
  return views;
}

StiffnessImage stiffness_image(const Model& model, const Dataset& dataset,
                               const BodyStiffness& stiffness, const TetMesh& body, double noise_N,
                               const ImageOptions& options) {
  const ContactBase base = make_contact_base(body);
  const double tool = dataset.recording.tool_radius();
  const Scene w{dataset, stiffness, base, tool};
  const double depth = options.largest_depth > 0 ? options.largest_depth : 15 * tool;
  const std::vector<ImageView> views = image_views(model, dataset, stiffness, noise_N);
  const auto n = static_cast<Eigen::Index>(views.size());
  const FieldGrid grid = grid_about(w, options.step > 0 ? options.step : 0.7 * tool, depth);
  const Eigen::MatrixXd J = sensitivities(w, material_of(model).nu, views, grid, options);
  Eigen::VectorXd data(n), noise(n);
  for (Eigen::Index v = 0; v < n; ++v) {
    data[v] = std::log(views[v].gain);
    noise[v] = views[v].error / views[v].gain;
  }
  StiffnessImage image;
  image.views = views.size();
  const std::vector<Candidate> all = candidates(J, grid, w, depth);

  // Errors that grow, alike everywhere, until the best ball leaves no more than they allow.
  double extra = 0;
  Eigen::VectorXd error = noise;
  for (int round = 0; round < 4; ++round) {
    error = (noise.array().square() + extra * extra).sqrt();
    Scan scan(data, error);
    const FoundBall ball = best_ball(scan, all, 1);
    const double left = (scan.chi2() - ball.drop) / std::max<double>(1, double(n) - 6);
    if (left <= 1.05) break;
    const double mean = error.cwiseAbs2().mean();
    extra = std::sqrt(extra * extra + (left - 1) * mean);
  }
  image.error = std::sqrt(error.cwiseAbs2().mean());
  Scan scan(data, error);
  image.misfit_before = std::sqrt(scan.chi2() / double(n)) * image.error;
  image.held_out_before = image.misfit_before * double(n) / double(n - 1);
  constexpr std::size_t kMost = 3;
  while (image.balls.size() < kMost) {
    FoundBall ball = best_ball(scan, all, 1);
    const double first = image.balls.empty() ? 0 : image.balls.front().drop;
    if (ball.drop < std::max(kLeastDrop, kLinear * kLinear * first)) break;
    // The candidates are a step apart, and the linear signal errs as well.
    ball.error = (ball.error.cwiseAbs2() + Vec3::Constant(grid.step * grid.step / 4)).cwiseSqrt();
    ball.depth_error = std::hypot(ball.depth_error, grid.step / 2);
    image.balls.push_back(ball);
    scan.explain(ball_signal(J, grid, ball.centre, ball.radius));
  }

  // How deep: under the position nearest to the middle of all.
  Vec3 middle = Vec3::Zero();
  for (const Vec3& p : w.positions()) middle += p / double(w.positions().size());
  std::size_t at = 0;
  for (std::size_t p = 0; p < w.positions().size(); ++p)
    if ((w.positions()[p] - middle).norm() < (w.positions()[at] - middle).norm()) at = p;
  const Scan plain(data, error);
  for (const double radius : {tool, 1.5 * tool, 3 * tool})
    for (const double ratio : {2.0, 5.0}) {
      Sight sight{radius, ratio, 0};
      for (double d = radius; d <= depth; d += 0.25 * tool) {
        const Vec3 centre = w.positions()[at] - d * w.normal(at);
        if (effective(ratio) * plain.size(ball_signal(J, grid, centre, radius)) < kSeen) break;
        sight.depth = d;
      }
      image.sight.push_back(sight);
    }
  solve_for_field(image, J, grid, views, data, error, options.penalty);
  return image;
}

std::vector<std::string> words_of(const StiffnessImage& image) {
  std::vector<std::string> words;
  for (const FoundBall& b : image.balls)
    words.push_back(fmt::format(
        "something {} at ({:.1f}, {:.1f}, {:.1f}) ± ({:.1f}, {:.1f}, {:.1f}) mm, its centre {:.1f} "
        "± "
        "{:.1f} mm deep: as a ball of {:.0f} mm diameter and {:.2g} times the modulus (size and "
        "modulus trade for each other)",
        b.ratio > 1 ? "stiffer" : "softer", 1e3 * b.centre.x(), 1e3 * b.centre.y(),
        1e3 * b.centre.z(), 1e3 * b.error.x(), 1e3 * b.error.y(), 1e3 * b.error.z(), 1e3 * b.depth,
        1e3 * b.depth_error, 2e3 * b.radius, b.ratio));
  if (image.balls.empty())
    words.push_back("nothing compact is seen: no ball explains the presses better than none");
  for (const Sight& s : image.sight) {
    const std::string ball =
        fmt::format("a ball of {:.0f} mm diameter, {:g} times as stiff, ", 2e3 * s.radius, s.ratio);
    words.push_back(s.depth > 0 ? ball + fmt::format("is seen with its centre down to {:.0f} mm; "
                                                     "deeper it cannot be seen by these presses",
                                                     1e3 * s.depth)
                                : ball + "cannot be seen by these presses at any depth");
  }
  words.push_back(
      fmt::format("gains differ by {:.2g} % from place to place, {:.2g} % on positions left out; "
                  "with the field "
                  "{:.2g} % and {:.2g} %; their errors are {:.2g} %",
                  100 * image.misfit_before, 100 * image.held_out_before, 100 * image.misfit,
                  100 * image.held_out, 100 * image.error));
  return words;
}

double modulus_ratio(const StiffnessImage& image, const Vec3& p) {
  if (image.balls.empty()) return std::exp(image.grid.value(image.log_ratio, p));
  double ratio = 1;
  for (const FoundBall& b : image.balls)
    if ((p - b.centre).norm() < b.radius) ratio *= b.ratio;
  return ratio;
}

}  // namespace hapsim
