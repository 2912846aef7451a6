#include "estimate/simplex_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace hapsim {
namespace {

struct Corner {
  Eigen::VectorXd x;
  double value = 0;
};

class Simplex {
 public:
  Simplex(const std::function<double(const Eigen::VectorXd&)>& function, int most)
      : function_(function), most_(most) {}

  Corner descend(const Eigen::VectorXd& start, double step, const SimplexSearchOptions& options) {
    const Eigen::Index n = start.size();
    corners_.assign(1, {start, evaluate(start)});
    for (Eigen::Index i = 0; i < n; ++i) {
      Eigen::VectorXd x = start;
      x[i] += step;
      corners_.push_back({x, evaluate(x)});
    }
    const auto order = [](const Corner& a, const Corner& b) { return a.value < b.value; };
    for (;;) {
      std::sort(corners_.begin(), corners_.end(), order);
      double size = 0;
      for (const Corner& c : corners_)
        size = std::max(size, (c.x - corners_[0].x).cwiseAbs().maxCoeff());
      small_ = size <= options.tolerance ||
               corners_.back().value - corners_[0].value <= options.value_tolerance;
      if (small_ || evaluations_ >= most_) return corners_[0];
      Eigen::VectorXd middle = Eigen::VectorXd::Zero(n);
      for (std::size_t k = 0; k + 1 < corners_.size(); ++k) middle += corners_[k].x;
      middle /= static_cast<double>(n);
      Corner& worst = corners_.back();
      const auto along = [&](double factor) {
        Corner c;
        c.x = middle + factor * (worst.x - middle);
        c.value = evaluate(c.x);
        return c;
      };
      const Corner reflected = along(-1);
      if (reflected.value < corners_[0].value) {
        const Corner further = along(-2);
        worst = further.value < reflected.value ? further : reflected;
      } else if (reflected.value < corners_[corners_.size() - 2].value) {
        worst = reflected;
      } else {
        const Corner nearer = along(reflected.value < worst.value ? -0.5 : 0.5);
        if (nearer.value < std::min(reflected.value, worst.value)) {
          worst = nearer;
          continue;
        }
        for (std::size_t k = 1; k < corners_.size(); ++k) {
          corners_[k].x = 0.5 * (corners_[0].x + corners_[k].x);
          corners_[k].value = evaluate(corners_[k].x);
        }
      }
    }
  }
  int evaluations() const { return evaluations_; }
  bool small() const { return small_; }

 private:
  double evaluate(const Eigen::VectorXd& x) {
    ++evaluations_;
    const double value = function_(x);
    return std::isfinite(value) ? value : std::numeric_limits<double>::max();
  }
  const std::function<double(const Eigen::VectorXd&)>& function_;
  int most_, evaluations_ = 0;
  bool small_ = false;
  std::vector<Corner> corners_;
};

}  // namespace

SimplexSearchResult simplex_search(const Eigen::VectorXd& start,
                                   const std::function<double(const Eigen::VectorXd&)>& function,
                                   const SimplexSearchOptions& options) {
  Simplex simplex(function, options.most_evaluations);
  Corner best = simplex.descend(start, options.first_step, options);
  SimplexSearchResult result;
  while (simplex.small()) {
    const Corner again = simplex.descend(best.x, 0.3 * options.first_step, options);
    const bool gained = again.value < best.value - std::max(options.value_tolerance,
                                                            1e-6 * (1 + std::abs(best.value)));
    if (again.value < best.value) best = again;
    result.converged = simplex.small() && !gained;
    if (!gained) break;
  }
  result.x = best.x;
  result.value = best.value;
  result.evaluations = simplex.evaluations();
  return result;
}

}  // namespace hapsim
