#include "cluster/division.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace hapsim {
namespace {

// Logarithms of the sum of squares within k clusters over that within one, k = 2 .. most.
Eigen::VectorXd tightness(const Eigen::MatrixXd& distances, Linkage linkage, int most) {
  const int n = static_cast<int>(distances.rows());
  const Dendrogram tree = agglomerate(distances, linkage);
  std::vector<std::vector<int>> below(2 * n - 1);
  std::vector<double> squares(2 * n - 1, 0);
  for (int i = 0; i < n; ++i) below[i] = {i};
  std::vector<double> within(n + 1, 0);  // by number of clusters
  double sum = 0;
  for (int m = 0; m < n - 1; ++m) {
    const auto& a = below[tree.merges[m].left];
    const auto& b = below[tree.merges[m].right];
    const double sa = squares[tree.merges[m].left], sb = squares[tree.merges[m].right];
    double cross = 0;
    for (const int i : a)
      for (const int j : b) cross += distances(i, j) * distances(i, j);
    const double na = static_cast<double>(a.size()), nb = static_cast<double>(b.size());
    squares[n + m] = (na * sa + nb * sb + cross) / (na + nb);
    sum += squares[n + m] - sa - sb;
    within[n - 1 - m] = sum;
    below[n + m] = a;
    below[n + m].insert(below[n + m].end(), b.begin(), b.end());
  }
  Eigen::VectorXd result(most - 1);
  for (int k = 2; k <= most; ++k)
    result[k - 2] = std::log(std::max(within[k], 1e-9 * within[1]) / within[1]);
  return result;
}

double scatter(const Eigen::MatrixXd& distances) {
  return distances.squaredNorm() / 2 / static_cast<double>(distances.rows());
}

class Divider {
 public:
  Divider(const Eigen::MatrixXd& samples, const Eigen::MatrixXd& errors, Linkage linkage,
          Random& random, const DivisionOptions& options)
      : x_(samples), s_(errors), linkage_(linkage), random_(random), options_(options) {}

  void divide(const std::vector<int>& branch, Division& result) {
    const std::size_t at = result.tests.size();
    result.tests.push_back(test(branch));
    if (!result.tests[at].divided) {
      for (const int i : branch) result.label[i] = next_;
      ++next_;
      return;
    }
    const std::vector<int> side = cut(
        agglomerate(scaled_distances(x_(branch, Eigen::all), s_(branch, Eigen::all)), linkage_), 2);
    for (int k = 0; k < 2; ++k) {
      std::vector<int> part;
      for (std::size_t i = 0; i < branch.size(); ++i)
        if (side[i] == k) part.push_back(branch[i]);
      divide(part, result);
    }
  }

 private:
  BranchTest test(const std::vector<int>& branch) {
    BranchTest result;
    result.samples = branch;
    const auto n = static_cast<Eigen::Index>(branch.size());
    const Eigen::MatrixXd x = x_(branch, Eigen::all), s = s_(branch, Eigen::all);
    const Eigen::Index d = x.cols();
    const Eigen::MatrixXd distances = scaled_distances(x, s);
    result.level = options_.significance * static_cast<double>(n - 1) /
                   static_cast<double>(std::max<Eigen::Index>(1, x_.rows() - 1));
    const double spread = scatter(distances);
    if (n > 1) result.scatter = std::sqrt(spread / static_cast<double>((n - 1) * d));
    if (n < 4 || spread <= 0) return result;
    const int simulations =
        std::clamp(static_cast<int>(1e9 / (static_cast<double>(n) * static_cast<double>(n))), 99,
                   options_.simulations);

    // Columns in units of their typical error; principal axes and what the errors do not explain.
    const Eigen::RowVectorXd unit = s.array().square().colwise().mean().sqrt();
    const Eigen::MatrixXd y = (x.rowwise() - x.colwise().mean()).array().rowwise() / unit.array();
    const Eigen::MatrixXd t = s.array().rowwise() / unit.array();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> axes(y.transpose() * y /
                                                              static_cast<double>(n - 1));
    const Eigen::VectorXd beyond = (axes.eigenvalues().array() - 1).max(0);
    const Eigen::MatrixXd along =
        (t.array().square().matrix() * axes.eigenvectors().array().square().matrix());  // n x d

    const int most = std::clamp<int>(static_cast<int>(n) / 2, 2, options_.most);
    Eigen::MatrixXd reference(most - 1, simulations);
    int as_scattered = 0;
    Eigen::MatrixXd draw(n, d);
    for (int b = 0; b < simulations; ++b) {
      for (Eigen::Index i = 0; i < n; ++i)
        for (Eigen::Index c = 0; c < d; ++c) draw(i, c) = t(i, c) * random_.normal();
      as_scattered += scatter(scaled_distances(draw, t)) >= spread;
      for (Eigen::Index i = 0; i < n; ++i)
        for (Eigen::Index c = 0; c < d; ++c)
          draw(i, c) = std::sqrt(12 * (beyond[c] + along(i, c))) * (random_.uniform() - 0.5);
      reference.col(b) =
          tightness(scaled_distances(draw * axes.eigenvectors().transpose(), t), linkage_, most);
    }
    const Eigen::VectorXd mean = reference.rowwise().mean();
    const Eigen::VectorXd deviation =
        ((reference.colwise() - mean).array().square().rowwise().mean().sqrt()).max(1e-12);
    const auto gap = [&](const Eigen::VectorXd& w) {
      return ((mean - w).array() / deviation.array()).maxCoeff();
    };
    const double seen = gap(tightness(distances, linkage_, most));
    int as_tight = 0;
    for (int b = 0; b < simulations; ++b) as_tight += gap(reference.col(b)) >= seen;
    result.p_scatter = (1.0 + as_scattered) / (1.0 + simulations);
    result.p_gaps = (1.0 + as_tight) / (1.0 + simulations);
    result.divided = result.p_scatter <= result.level && result.p_gaps <= result.level;
    return result;
  }

  const Eigen::MatrixXd& x_;
  const Eigen::MatrixXd& s_;
  Linkage linkage_;
  Random& random_;
  const DivisionOptions& options_;
  int next_ = 0;
};

}  // namespace

Division natural_division(const Eigen::MatrixXd& samples, const Eigen::MatrixXd& errors,
                          Linkage linkage, Random& random, const DivisionOptions& options) {
  Division result;
  std::vector<int> all(static_cast<std::size_t>(samples.rows()));
  std::iota(all.begin(), all.end(), 0);
  result.label.assign(all.size(), 0);
  Divider(samples, errors, linkage, random, options).divide(all, result);
  return result;
}

}  // namespace hapsim
