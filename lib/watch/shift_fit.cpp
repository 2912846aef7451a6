#include "watch/shift_fit.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "estimate/least_squares.h"

namespace hapsim {
namespace {

constexpr double kUsualShift = 0.005;   // [m]: what is expected before the presses tell
constexpr double kFarthest = 0.02;      // [m]: farther, the body is scanned and placed again
constexpr double kGrid = 0.0025;        // [m]
constexpr int kGridSteps = 3;           // to each side
constexpr std::size_t kPolished = 3;    // valleys of the grid, no two beside each other
constexpr std::size_t kSearched = 200;  // samples that the grid is tried on

std::vector<WatchedSample> thinned(const std::vector<WatchedSample>& window) {
  const std::size_t every = std::max<std::size_t>(1, window.size() / kSearched);
  std::vector<WatchedSample> few;
  for (std::size_t i = 0; i < window.size(); i += every) few.push_back(window[i]);
  return few;
}

struct Start {
  double squares;
  Vec3 shift;
};

// The best points of a grid about `centre`, no two beside each other.
std::vector<Start> search(const PreparedBody& body, const SurfaceOffsets& offsets,
                          const std::vector<WatchedSample>& window, const Correction& from) {
  const std::vector<WatchedSample> few = thinned(window);
  std::vector<Start> grid;
  for (int i = -kGridSteps; i <= kGridSteps; ++i)
    for (int j = -kGridSteps; j <= kGridSteps; ++j)
      for (int k = -kGridSteps; k <= kGridSteps; ++k) {
        Correction c = from;
        c.shift += kGrid * Vec3(i, j, k);
        grid.push_back({chi_square(few, corrected_forces(body, offsets, few, c)), c.shift});
      }
  std::sort(grid.begin(), grid.end(),
            [](const Start& a, const Start& b) { return a.squares < b.squares; });
  std::vector<Start> best;
  for (const Start& point : grid) {
    const bool beside = std::any_of(best.begin(), best.end(), [&](const Start& b) {
      return (b.shift - point.shift).norm() < 1.5 * kGrid;
    });
    if (!beside) best.push_back(point);
    if (best.size() == kPolished) break;
  }
  return best;
}

// Unknowns: the shift, then how far the stiffness of all is off, then the gap that all presses
// have, then each its own, then what each press's force is off, relative to its size; all but the
// shift in their usual sizes.
class ShiftResiduals {
 public:
  ShiftResiduals(const PreparedBody& body, const SurfaceOffsets& offsets,
                 const std::vector<WatchedSample>& window, const Correction& from,
                 const UsualStiffness& usual)
      : body_(body),
        offsets_(offsets),
        window_(window),
        from_(from),
        press_(press_indices(window)),
        presses_(static_cast<Eigen::Index>(press_.back()) + 1),
        gap_(std::max(offsets.uncertainty(), kLeastGap)),
        usual_(usual),
        factor_(usual.factor),
        factor_error_(std::max(usual.error, kLeastShare)),
        share_(std::max(usual.share / std::sqrt(3.0), kLeastShare)) {}

  Eigen::Index unknowns() const { return kFirst + 4 * presses_; }

  std::vector<double> gaps(const Eigen::VectorXd& x) const {
    const Eigen::VectorXd g = gap_ * (x.segment(kFirst, presses_).array() + x[4]);
    return {g.begin(), g.end()};
  }
  double stiffness(const Eigen::VectorXd& x) const {
    return from_.stiffness * std::max(factor_ + factor_error_ * x[3], kLeastFactor);
  }

  void operator()(const Eigen::VectorXd& x, Eigen::VectorXd& r, Eigen::MatrixXd* J) const {
    std::vector<Vec3> f;
    r = at(x, &f);
    if (J == nullptr) return;
    J->setZero(r.size(), unknowns());
    for (Eigen::Index k = 0; k < 3; ++k)
      J->col(k) = slope(x, r, kStep * Eigen::VectorXd::Unit(x.size(), k)) / kStep;
    // A gap of all presses at once: each has its own rows.
    Eigen::VectorXd all = Eigen::VectorXd::Zero(x.size());
    all.segment(kFirst, presses_).setConstant(kStep / gap_);
    const Eigen::VectorXd by_gap = slope(x, r, all) / (kStep / gap_);
    for (std::size_t i = 0; i < window_.size(); ++i) {
      const auto row = 3 * static_cast<Eigen::Index>(i);
      const auto press = static_cast<Eigen::Index>(press_[i]);
      J->block<3, 1>(row, 4) = by_gap.segment<3>(row);
      J->block<3, 1>(row, kFirst + press) = by_gap.segment<3>(row);
      if (!window_[i].counted) continue;
      J->block<3, 1>(row, 3) =
          -factor_error_ * from_.stiffness / stiffness(x) * f[i] / window_[i].size;
      J->block<3, 3>(row, kFirst + presses_ + 3 * press)
          .diagonal()
          .setConstant(-share_ * f[i].norm() / window_[i].size);
    }
    J->bottomRightCorner(2 + 4 * presses_, 2 + 4 * presses_).setIdentity();
  }

 private:
  static constexpr double kStep = 2e-5;        // [m]
  static constexpr double kLeastGap = 1e-5;    // [m]
  static constexpr double kLeastShare = 1e-3;  // errors that are told as less divide by nothing
  static constexpr double kLeastFactor = 0.1;  // a body as soft as that has not only moved
  static constexpr Eigen::Index kFirst = 5;    // of the presses' own

  // Change of r by a step. A sample at which the tool comes free jumps in one direction or the
  // other: the smaller change of the two is the slope.
  Eigen::VectorXd slope(const Eigen::VectorXd& x, const Eigen::VectorXd& r,
                        const Eigen::VectorXd& step) const {
    Eigen::VectorXd up = at(x + step, nullptr) - r;
    const Eigen::VectorXd down = r - at(x - step, nullptr);
    for (Eigen::Index i = 0; i < up.size(); ++i)
      if (std::abs(down[i]) < std::abs(up[i])) up[i] = down[i];
    return up;
  }

  // Residuals over the size that the measured force gives them, so that it does not move with the
  // shift. `f`: of the body alone.
  Eigen::VectorXd at(const Eigen::VectorXd& x, std::vector<Vec3>* f) const {
    Correction c = from_;
    c.shift = x.head<3>();
    c.stiffness = stiffness(x);
    std::vector<Vec3> forces = corrected_forces(body_, offsets_, window_, c, gaps(x));
    const auto rows = 3 * static_cast<Eigen::Index>(window_.size());
    Eigen::VectorXd out = Eigen::VectorXd::Zero(rows + unknowns());
    Vec3 usually_off = Vec3::Zero();
    for (std::size_t i = 0; i < window_.size(); ++i) {
      if (i == 0 || press_[i] != press_[i - 1])
        usually_off = usual_.off_at(window_[i].line.point - c.shift);
      forces[i] -= c.bias;
      forces[i] += forces[i].norm() * usually_off;
      const Vec3 off = share_ * forces[i].norm() *
                       x.segment<3>(kFirst + presses_ + 3 * static_cast<Eigen::Index>(press_[i]));
      if (window_[i].counted)
        out.segment<3>(3 * static_cast<Eigen::Index>(i)) =
            (window_[i].measured - c.bias - forces[i] - off) / window_[i].size;
    }
    out.segment<3>(rows) = x.head<3>() / kUsualShift;
    out.tail(2 + 4 * presses_) = x.tail(2 + 4 * presses_);
    if (f != nullptr) *f = std::move(forces);
    return out;
  }

  const PreparedBody& body_;
  const SurfaceOffsets& offsets_;
  const std::vector<WatchedSample>& window_;
  Correction from_;
  std::vector<std::size_t> press_;
  Eigen::Index presses_;
  double gap_;  // common to all, and a press's own [m]
  const UsualStiffness& usual_;
  double factor_, factor_error_, share_;
};

}  // namespace

ShiftFit fit_shift(const PreparedBody& body, const SurfaceOffsets& offsets,
                   const std::vector<WatchedSample>& window, const Correction& known,
                   const Vec3& about, const UsualStiffness& usual, bool everywhere) {
  const ShiftResiduals residuals(body, offsets, window, known, usual);
  Correction from = known;
  from.shift = about;
  from.stiffness *= usual.factor;
  std::vector<Start> starts{{0, about}};
  if (everywhere) starts = search(body, offsets, window, from);
  ShiftFit best;
  best.sum_of_squares = 1e300;
  LeastSquaresResult found;
  for (const Start& from_here : starts) {
    std::vector<Unknown> start(static_cast<std::size_t>(residuals.unknowns()));
    for (Eigen::Index k = 0; k < 3; ++k) {
      Unknown& unknown = start[static_cast<std::size_t>(k)];
      unknown.value = std::clamp(from_here.shift[k], -kFarthest, kFarthest);
      unknown.scale = 1e-3;
      unknown.lower = -kFarthest;
      unknown.upper = kFarthest;
    }
    LeastSquaresOptions options;
    options.max_iterations = 15;
    options.step_tolerance = 1e-2;
    LeastSquaresResult fit = minimise(start, residuals, options);
    if (fit.sum_of_squares >= best.sum_of_squares) continue;
    best.sum_of_squares = fit.sum_of_squares;
    found = std::move(fit);
  }
  best.shift = found.x.head<3>();
  best.stiffness = residuals.stiffness(found.x);
  best.gaps = residuals.gaps(found.x);
  using Common = Eigen::Matrix<double, 5, 5>;
  const Common covariance = found.covariance.topLeftCorner<5, 5>();
  best.std_error = covariance.diagonal().head<3>().cwiseMax(0.0).cwiseSqrt();
  Eigen::VectorXd r;
  Eigen::MatrixXd J;
  residuals(found.x, r, &J);
  const Eigen::MatrixXd J5 = J.leftCols<5>().topRows(3 * static_cast<Eigen::Index>(window.size()));
  const Common seen = J5.transpose() * J5;
  best.force_error = std::sqrt(std::max(0.0, (seen * covariance).trace()) /
                               (3 * static_cast<double>(window.size())));
  return best;
}

}  // namespace hapsim
