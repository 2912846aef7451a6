#include "regions/curve_search.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "estimate/least_squares.h"

namespace hapsim {
namespace {

using CurvePlace = Eigen::Vector2d;

constexpr int kModes = 24;            // at most, of the level
constexpr double kPin = 0.02;         // by which the mean slope along the curve may differ from 1
constexpr float kFelt = 1e-5f;        // of the strain energy, in a cell that counts
constexpr double kCurveMixing = 0.2;  // as in find_boundary()
constexpr double kBends[] = {0.6, 0.2, 0.06, 0.02};
constexpr double kThere = 0.6;  // share of the energy that a side has at some place at least

// Half-way between the means of the two groups into which the log gains are best split.
double middle_of(const std::vector<LocationSample>& samples, double mean[2]) {
  std::vector<double> value;
  for (const LocationSample& s : samples) value.push_back(std::log(s.gain));
  std::sort(value.begin(), value.end());
  double best = std::numeric_limits<double>::infinity(), middle = 0;
  for (std::size_t cut = 1; cut < value.size(); ++cut) {
    double squares = 0, m[2];
    for (int side = 0; side < 2; ++side) {
      const auto from = value.begin() + static_cast<std::ptrdiff_t>(side == 0 ? 0 : cut);
      const auto to = side == 0 ? value.begin() + static_cast<std::ptrdiff_t>(cut) : value.end();
      double sum = 0;
      for (auto v = from; v != to; ++v) sum += *v;
      m[side] = sum / static_cast<double>(to - from);
      for (auto v = from; v != to; ++v) squares += (*v - m[side]) * (*v - m[side]);
    }
    if (squares >= best) continue;
    best = squares;
    mean[0] = m[0], mean[1] = m[1];
    middle = 0.5 * (m[0] + m[1]);
  }
  return middle;
}

class CurveProblem {
 public:
  CurveProblem(const std::vector<LocationSample>& samples,
               const std::vector<std::vector<float>>& share, const PlanGrid& grid,
               const PlanLevel& level)
      : level_(level), width_(2 * std::max(grid.step_x, grid.step_y)) {
    std::vector<std::size_t> cell;
    for (std::size_t c = 0; c < share.front().size(); ++c)
      if (std::any_of(share.begin(), share.end(), [&](const auto& s) { return s[c] > kFelt; }))
        cell.push_back(c);
    const auto n = static_cast<Eigen::Index>(samples.size());
    const auto cells = static_cast<Eigen::Index>(cell.size());
    share_.resize(n, cells);
    basis_.resize(cells, level.size());
    slope_x_.resize(cells, level.size());
    slope_y_.resize(cells, level.size());
    for (Eigen::Index c = 0; c < cells; ++c) {
      const std::size_t at = cell[static_cast<std::size_t>(c)];
      for (Eigen::Index i = 0; i < n; ++i) share_(i, c) = share[static_cast<std::size_t>(i)][at];
      const CurvePlace p = grid.centre(static_cast<int>(at)).head<2>();
      basis_.row(c) = level.basis(p);
      const Eigen::MatrixXd slope = level.slope(p);
      slope_x_.row(c) = slope.row(0);
      slope_y_.row(c) = slope.row(1);
    }
    value_.resize(n);
    error_.resize(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const LocationSample& s = samples[static_cast<std::size_t>(i)];
      value_[i] = std::log(s.gain);
      error_[i] = s.error / s.gain;
    }
  }

  struct Found {
    Eigen::VectorXd x;  // log gains of both sides, theta
    double bend = 0, evidence = std::numeric_limits<double>::infinity();  // -2 log
    double criterion = 0;
  };

  // From x at one `bend`; the samples' errors have what mixing may err at x.
  Found solved(Eigen::VectorXd x, double bend) const {
    Found found;
    const Eigen::VectorXd error = with_mixing(x);
    std::vector<Unknown> unknowns;
    for (const double value : x) unknowns.push_back({value, -20, 20, 0.1, false});
    LeastSquaresOptions options;
    options.max_iterations = 15;  // from the solution of another bend on
    options.step_tolerance = 1e-2;
    options.decrease_tolerance = 1e-2;
    x = minimise(
            unknowns,
            [&](const Eigen::VectorXd& at, Eigen::VectorXd& left, Eigen::MatrixXd* by) {
              residuals(at, error, bend, left, by);
            },
            options)
            .x;
    Eigen::VectorXd r;
    Eigen::MatrixXd J;
    residuals(x, error, bend, r, &J);
    const Eigen::Index n = value_.size(), modes = level_.size() - PlanLevel::kPlane;
    Eigen::MatrixXd H = J.transpose() * J;
    H.diagonal().array() += 1e-9;
    const Eigen::LDLT<Eigen::MatrixXd> solver(H);
    found.x = x;
    found.bend = bend;
    const double squares = r.head(n).squaredNorm();
    const double errors = 2 * error.array().log().sum();
    found.evidence = r.squaredNorm() + errors + 2 * static_cast<double>(modes) * std::log(bend) +
                     solver.vectorD().array().max(1e-300).log().sum();
    const Eigen::MatrixXd data = J.topRows(n).transpose() * J.topRows(n);
    const double told = solver.solve(data).trace();
    found.criterion =
        squares + errors - 2 * error_.array().log().sum() + told * std::log(static_cast<double>(n));
    return found;
  }

  // Whether either side is felt at some place nearly alone.
  bool both_there(const Eigen::VectorXd& x) const {
    const Eigen::VectorXd in = stiff_share(x);
    return in.maxCoeff() > kThere && in.minCoeff() < 1 - kThere;
  }

 private:
  Eigen::VectorXd stiff_share(const Eigen::VectorXd& x) const {
    const Eigen::VectorXd theta = x.tail(level_.size());
    Eigen::VectorXd s(basis_.rows());
    const Eigen::VectorXd phi = basis_ * theta, gx = slope_x_ * theta, gy = slope_y_ * theta;
    for (Eigen::Index c = 0; c < s.size(); ++c)
      s[c] = smooth_step(phi[c] / std::max(0.2, std::hypot(gx[c], gy[c])), width_).value;
    const Eigen::VectorXd felt = share_.rowwise().sum();
    return (share_ * s).cwiseQuotient(felt.cwiseMax(1e-12));
  }

  Eigen::VectorXd with_mixing(const Eigen::VectorXd& x) const {
    const Eigen::VectorXd in = stiff_share(x);
    const double contrast = std::clamp(x[1] - x[0], -3.0, 3.0);
    const Eigen::ArrayXd mixing =
        kCurveMixing * contrast * contrast / 2 * in.array() * (1 - in.array());
    return (error_.array().square() + mixing.square()).sqrt();
  }

  void residuals(const Eigen::VectorXd& x, const Eigen::VectorXd& error, double bend,
                 Eigen::VectorXd& r, Eigen::MatrixXd* J) const {
    const Eigen::Index n = value_.size(), m = level_.size();
    const Eigen::Index modes = m - PlanLevel::kPlane;
    const Eigen::VectorXd theta = x.tail(m);
    const Eigen::VectorXd phi = basis_ * theta, gx = slope_x_ * theta, gy = slope_y_ * theta;
    Eigen::VectorXd step(phi.size()), by(phi.size());
    // Mean slope in a band along the curve.
    double weight = 1e-12, slope = 0;
    Eigen::RowVectorXd by_slope = Eigen::RowVectorXd::Zero(m);
    for (Eigen::Index c = 0; c < phi.size(); ++c) {
      const double steep = std::max(0.2, std::hypot(gx[c], gy[c]));
      const SmoothStep s = smooth_step(phi[c] / steep, width_);
      step[c] = s.value;
      by[c] = s.slope / steep;
      const double near = s.slope * width_;
      if (near <= 0) continue;
      weight += near;
      slope += near * steep;
      by_slope += near / steep * (gx[c] * slope_x_.row(c) + gy[c] * slope_y_.row(c));
    }
    const double contrast = x[1] - x[0];
    const Eigen::VectorXd in = share_ * step, felt = share_.rowwise().sum();
    r.resize(n + modes + 1);
    const Eigen::VectorXd share = in.cwiseQuotient(felt.cwiseMax(1e-12));
    r.head(n) =
        (Eigen::VectorXd::Constant(n, x[0]) + contrast * share - value_).cwiseQuotient(error);
    r.segment(n, modes) = theta.tail(modes) / bend;
    r[n + modes] = (slope / weight - 1) / kPin;
    if (J == nullptr) return;
    *J = Eigen::MatrixXd::Zero(n + modes + 1, 2 + m);
    J->col(0).head(n) = (1 - share.array()) / error.array();
    J->col(1).head(n) = share.array() / error.array();
    // The curve moves what lies in the band about it alone.
    std::vector<Eigen::Index> band;
    for (Eigen::Index c = 0; c < by.size(); ++c)
      if (by[c] != 0) band.push_back(c);
    const Eigen::VectorXd scale =
        contrast * (felt.cwiseMax(1e-12).cwiseProduct(error)).cwiseInverse();
    J->block(0, 2, n, m) =
        scale.asDiagonal() *
        (share_(Eigen::all, band) * (by(band).asDiagonal() * basis_(band, Eigen::all)));
    J->block(n, 2 + PlanLevel::kPlane, modes, modes).diagonal().setConstant(1 / bend);
    J->block(n + modes, 2, 1, m) = by_slope / (weight * kPin);
  }

  const PlanLevel& level_;
  double width_;  // [m] over which one side goes over to the other
  Eigen::MatrixXd share_, basis_, slope_x_, slope_y_;
  Eigen::VectorXd value_, error_;
};

}  // namespace

SmoothStep smooth_step(double distance, double width) {
  const double t = std::clamp(0.5 + distance / width, 0.0, 1.0);
  return {t * t * (3 - 2 * t), 6 * t * (1 - t) / width};
}

std::optional<RegionCurve> find_curve(const std::vector<LocationSample>& samples,
                                      const std::vector<std::vector<float>>& share,
                                      const PlanGrid& grid,
                                      const std::function<int(const CurvePlace&)>& side) {
  constexpr std::size_t kLeast = 6;
  if (samples.size() < kLeast) return std::nullopt;
  std::vector<CurvePlace> places;
  for (const LocationSample& s : samples) places.push_back(s.point.head<2>());
  double mean[2] = {0, 0};
  const double middle = middle_of(samples, mean);
  if (!(mean[1] > mean[0])) return std::nullopt;
  double spacing = 0;
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  for (const CurvePlace& p : places) {
    double least = std::numeric_limits<double>::infinity();
    for (const CurvePlace& q : places)
      if (&p != &q) least = std::min(least, (p - q).norm());
    spacing += least / static_cast<double>(places.size());
    spread += (p - places.front()) * (p - places.front()).transpose();
  }
  if (spread.determinant() < 1e-4 * std::pow(spread.trace(), 2)) return std::nullopt;
  const PlanLevel level(places, kModes);
  const CurveProblem problem(samples, share, grid, level);

  // Distances as the samples' own values tell them: little beyond half a spacing.
  const auto n = static_cast<Eigen::Index>(samples.size());
  std::vector<Eigen::VectorXd> starts;
  Eigen::VectorXd distance(n);
  for (Eigen::Index i = 0; i < n; ++i)
    distance[i] = 0.5 * spacing *
                  std::clamp(2 * (std::log(samples[static_cast<std::size_t>(i)].gain) - middle) /
                                 (mean[1] - mean[0]),
                             -1.0, 1.0);
  starts.push_back(level.fitted(places, distance, 0.03));
  if (side) {
    for (Eigen::Index i = 0; i < n; ++i)
      distance[i] = side(places[static_cast<std::size_t>(i)]) > 0 ? 0.5 * spacing : -0.5 * spacing;
    starts.push_back(level.fitted(places, distance, 1e-3));
  }
  CurveProblem::Found best;
  for (const Eigen::VectorXd& theta : starts) {
    Eigen::VectorXd x(2 + theta.size());
    x << mean[0], mean[1], theta;
    for (const double bend : kBends) {
      CurveProblem::Found found = problem.solved(x, bend);
      x = found.x;
      if (!problem.both_there(found.x)) continue;
      if (found.evidence < best.evidence) best = std::move(found);
    }
  }
  if (best.x.size() == 0) return std::nullopt;
  RegionCurve curve;
  curve.level = level;
  curve.theta = best.x.tail(level.size());
  curve.bend = best.bend;
  curve.criterion = best.criterion;
  const bool rises = best.x[1] >= best.x[0];
  if (!rises) curve.theta = -curve.theta;
  curve.log_gain[0] = best.x[rises ? 0 : 1];
  curve.log_gain[1] = best.x[rises ? 1 : 0];
  return curve;
}

}  // namespace hapsim
