// What standard errors are more where the misfit goes together over a place, or over a press.
#include <algorithm>
#include <cmath>
#include <map>

#include "estimate/probability.h"
#include "fit/fitting.h"
#include "model/interval.h"

namespace hapsim {
namespace {

// Fewer tell no variance between groups.
constexpr std::size_t kLeastGroups = 8;

// The group of each episode: its position, its press where there are few positions; empty where
// there are few presses.
std::vector<int> groups(const Dataset& dataset, const Selection& selection) {
  std::map<int, int> of_position;
  std::vector<int> by_position, by_press;
  for (const int e : selection) {
    const int position = dataset.episodes[static_cast<std::size_t>(e)].position;
    const auto known = of_position.try_emplace(position, static_cast<int>(of_position.size()));
    by_position.push_back(known.first->second);
    by_press.push_back(static_cast<int>(by_press.size()));
  }
  if (of_position.size() >= kLeastGroups) return by_position;
  return by_press.size() >= kLeastGroups ? by_press : std::vector<int>{};
}

}  // namespace

void Fitting::widen_by_groups(const Signal& signal, const Eigen::VectorXd& residual) {
  if (options_.robust != RobustLoss::kNone || !constraints_.empty()) return;
  const std::vector<int> group = groups(dataset_, selection_);
  if (group.empty()) return;
  Eigen::MatrixXd J = signal.df;
  Eigen::VectorXd r = residual;
  whiten(J);
  whiten(r);
  const int count = *std::max_element(group.begin(), group.end()) + 1;
  Eigen::MatrixXd scores = Eigen::MatrixXd::Zero(J.cols(), count);
  Eigen::Index row = 0;
  for (std::size_t e = 0; e < group.size(); ++e) {
    const auto rows = static_cast<Eigen::Index>(
        3 * dataset_.episodes[static_cast<std::size_t>(selection_[e])].rows.size());
    scores.col(group[e]) += J.middleRows(row, rows).transpose() * r.segment(row, rows);
    row += rows;
  }
  scores.colwise() -= scores.rowwise().mean().eval();
  const Eigen::MatrixXd moves = solution_.covariance * scores;
  // Intervals are 1.96 errors wide; of few groups those are Student's.
  const double others = count - 1;
  const double widening = std::sqrt(count / others) * student_half95(others) / kHalf95;
  const std::vector<int> free = result_.model.free_parameters();
  for (std::size_t c = 0; c < free.size(); ++c) {
    Parameter& p = result_.model.parameters[static_cast<std::size_t>(free[c])];
    const double error = widening * moves.row(static_cast<Eigen::Index>(c)).norm();
    if (error > p.std_error) p.std_error = error;  // never of a NaN
  }
}

}  // namespace hapsim
