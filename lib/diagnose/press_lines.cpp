#include "diagnose/press_lines.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace hapsim {
namespace {

constexpr Eigen::Index kOfStretch = 8, kThirds = 3;  // samples; of the stretches one is foretold
constexpr double kPeriods = 2;                       // in a press
constexpr Eigen::Index kMostSamples = 300;           // of a press; more are averaged

using Rows = Eigen::MatrixX3d;  // one sample each

// What columns leave of both parts, fitted to the first; nothing to fit by takes nothing.
struct Fitted {
  double seen = std::numeric_limits<double>::infinity(), unseen = 0;
};
Fitted fit_by(const Eigen::MatrixXd& columns, const Rows& values,
              const std::vector<Eigen::Index>& seen, const std::vector<Eigen::Index>& unseen) {
  const Eigen::MatrixXd known = columns(seen, Eigen::all);
  const Eigen::LDLT<Eigen::MatrixXd> normal(known.transpose() * known);
  if (normal.info() != Eigen::Success || !normal.isPositive()) return {};
  const Eigen::MatrixXd by = normal.solve(known.transpose() * values(seen, Eigen::all));
  const auto left = [&](const std::vector<Eigen::Index>& rows) {
    return (values(rows, Eigen::all) - columns(rows, Eigen::all) * by).squaredNorm();
  };
  return {left(seen), left(unseen)};
}

struct PressLine {
  double taken = 0, frequency = 0;  // squares of what was not seen [N^2]
};
PressLine line_of(const Eigen::VectorXd& t, const Rows& values) {
  const double length = t[t.size() - 1] - t[0], least = kPeriods / length,
               most = 0.5 * static_cast<double>(t.size() - 1) / length;
  const int count = static_cast<int>(4 * length * std::max(0.0, most - least));
  const Eigen::ArrayXd along = (t.array() - t[0]) / length;
  Eigen::MatrixX3d course(t.size(), 3), swing(t.size(), 3);
  course << Eigen::VectorXd::Ones(t.size()), along.matrix(), along.square().matrix();
  swing.setOnes();
  PressLine line;
  for (Eigen::Index part = 0; part < kThirds; ++part) {
    std::vector<Eigen::Index> seen, unseen;
    for (Eigen::Index i = 0; i < t.size(); ++i)
      (i / kOfStretch % kThirds == part ? unseen : seen).push_back(i);
    const double slow = std::min(values(unseen, Eigen::all).squaredNorm(),
                                 fit_by(course, values, seen, unseen).unseen);
    Fitted best;
    for (int k = 0; k < count; ++k) {
      const double frequency = least + (most - least) * k / count;
      const Eigen::ArrayXd angle = 2 * M_PI * frequency * t.array();
      swing.rightCols(2) << angle.sin().matrix(), angle.cos().matrix();
      const Fitted now = fit_by(swing, values, seen, unseen);
      if (now.seen >= best.seen) continue;
      best = now;
      if (part == 0) line.frequency = frequency;
    }
    if (count > 0) line.taken += slow - best.unseen;
  }
  return line;
}

// Means of so many samples that no more than kMostSamples are left, one column each quantity.
Eigen::MatrixXd averaged(const Eigen::MatrixXd& columns) {
  const Eigen::Index each = (columns.rows() + kMostSamples - 1) / kMostSamples;
  Eigen::MatrixXd means(columns.rows() / each, columns.cols());
  for (Eigen::Index i = 0; i < means.rows(); ++i)
    means.row(i) = columns.middleRows(i * each, each).colwise().mean();
  return means;
}

}  // namespace

PressLines find_press_lines(const Eigen::VectorXd& residual, const Dataset& dataset, double noise) {
  std::vector<double> frequencies;
  double taken = 0;
  Eigen::Index at = 0;
  for (const Episode& e : dataset.episodes) {
    const auto count = static_cast<Eigen::Index>(e.rows.size());
    const Eigen::VectorXd part = residual.segment(3 * at, 3 * count);
    at += count;
    if (e.view.t.empty() || count < kThirds * kOfStretch || e.view.t.back() <= e.view.t.front())
      continue;
    Eigen::MatrixXd samples(count, 4);
    samples << Eigen::Map<const Eigen::VectorXd>(e.view.t.data(), count),
        part.reshaped(3, count).transpose();
    samples = averaged(samples);
    const PressLine line = line_of(samples.col(0), samples.rightCols<3>());
    taken += static_cast<double>(count / samples.rows()) * line.taken;
    frequencies.push_back(line.frequency);
  }
  const double beyond = residual.squaredNorm() -
                        noise * noise * dataset.axes() / 3.0 * static_cast<double>(residual.size());
  if (frequencies.empty() || !(beyond > 0)) return {};
  std::sort(frequencies.begin(), frequencies.end());
  const std::size_t quarter = frequencies.size() / 4;
  return {taken / beyond, frequencies[quarter], frequencies[frequencies.size() - 1 - quarter]};
}

}  // namespace hapsim
