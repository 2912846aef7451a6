#include "regions/region_boundary.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "regions/curve_search.h"

namespace hapsim {
namespace {

using PlanPoint = Eigen::Vector2d;

constexpr double kPi = 3.14159265358979323846;
constexpr int kAngles = 24, kOffsets = 16;  // of the straight lines tried
constexpr int kMoves = 200;                 // of the search from the best of them
// Each side must hold so much of the strain energy at some position, or its modulus is anything.
constexpr double kMostlyThere = 0.6;
constexpr int kCurvePoints = 24;  // that draw a curve of any shape
constexpr float kTrace = 1e-5f;   // of the strain energy, in a cell that does not count
// What the geometric mean of two moduli may err, of the difference from the arithmetic one.
constexpr double kMixing = 0.2;

// Signed distance [m] from a boundary through `middle`: shape = angle of the normal, offset along
// it [m] and, of a bent one, curvature [1/m]. A round one has centre and radius [m].
enum class Shape { kStraight, kBent, kRound };
double distance_from(Shape kind, const Eigen::VectorXd& shape, const PlanPoint& p) {
  if (kind == Shape::kRound) return shape[2] - (p - shape.head<2>()).norm();
  const PlanPoint normal(std::cos(shape[0]), std::sin(shape[0]));
  const double along = normal.x() * p.y() - normal.y() * p.x();
  const double bend = kind == Shape::kBent ? 0.5 * shape[2] * along * along : 0;
  return normal.dot(p) - shape[1] - bend;
}

class Search {
 public:
  Search(const std::vector<LocationSample>& samples, const std::vector<std::vector<float>>& share,
         const PlanGrid& grid)
      : samples_(samples), share_(share), step_(std::min(grid.step_x, grid.step_y)) {
    for (const LocationSample& s : samples_) middle_ += s.point.head<2>();
    middle_ /= static_cast<double>(samples_.size());
    for (const LocationSample& s : samples_)
      reach_ = std::max(reach_, (s.point.head<2>() - middle_).norm());
    for (std::size_t c = 0; c < share_.front().size(); ++c)
      if (std::any_of(share_.begin(), share_.end(), [&](const auto& s) { return s[c] > kTrace; })) {
        cell_.push_back(c);
        place_.push_back(grid.centre(static_cast<int>(c)).head<2>() - middle_);
      }
  }

  struct Found {
    Shape kind = Shape::kStraight;
    Eigen::VectorXd shape;
    double log_gain[2] = {0, 0};  // where the distance is negative, positive
    double squares = std::numeric_limits<double>::infinity();
  };

  Found straight() const {
    Found best;
    for (int a = 0; a < kAngles; ++a)
      for (int k = 0; k < kOffsets; ++k)
        keep_better(best,
                    fitted(Shape::kStraight,
                           PlanPoint(kPi * a / kAngles, reach_ * ((2.0 * k + 1) / kOffsets - 1))));
    return refined(best, PlanPoint(kPi / kAngles, reach_ / kOffsets));
  }
  // From the straight one on, to both sides.
  Found bent(const Found& line) const {
    Found best;
    for (const double bend : {-1.0, -0.5, 0.5, 1.0})
      keep_better(best, refined(fitted(Shape::kBent, Eigen::Vector3d(line.shape[0], line.shape[1],
                                                                     bend / reach_)),
                                Eigen::Vector3d(kPi / kAngles, reach_ / kOffsets, 0.5 / reach_)));
    return best;
  }
  Found round() const {
    Found best;
    for (const LocationSample& s : samples_)
      for (const double radius : {0.15, 0.3, 0.5}) {
        const PlanPoint centre = s.point.head<2>() - middle_;
        keep_better(
            best, fitted(Shape::kRound, Eigen::Vector3d(centre.x(), centre.y(), radius * reach_)));
      }
    return refined(best, Eigen::Vector3d::Constant(0.2 * reach_));
  }

  RegionBoundary result(const Found& found) const {
    RegionBoundary boundary;
    const bool rises = found.log_gain[1] >= found.log_gain[0];
    boundary.log_gain[0] = found.log_gain[rises ? 0 : 1];
    boundary.log_gain[1] = found.log_gain[rises ? 1 : 0];
    boundary.side = [found, rises, middle = middle_](const PlanPoint& p) {
      return static_cast<int>((distance_from(found.kind, found.shape, p - middle) > 0) == rises);
    };
    boundary.criterion = found.squares + static_cast<double>(2 + found.shape.size()) *
                                             std::log(static_cast<double>(samples_.size()));
    return boundary;
  }

 private:
  static void keep_better(Found& best, const Found& other) {
    if (other.squares < best.squares) best = other;
  }

  // The two moduli by weighted linear regression on the share of either side.
  Found fitted(Shape kind, const Eigen::VectorXd& shape) const {
    Found found{kind, shape};
    std::vector<double> positive(samples_.size(), 0);
    for (std::size_t c = 0; c < cell_.size(); ++c) {
      const double in = std::clamp(0.5 + distance_from(kind, shape, place_[c]) / step_, 0.0, 1.0);
      if (in > 0)
        for (std::size_t i = 0; i < samples_.size(); ++i) positive[i] += in * share_[i][cell_[c]];
    }
    const auto [least, most] = std::minmax_element(positive.begin(), positive.end());
    if (*most < kMostlyThere || *least > 1 - kMostlyThere) return found;
    double contrast = 0;
    for (int pass = 0; pass < 2; ++pass) {
      double w = 0, ws = 0, wss = 0, wy = 0, wsy = 0;
      const auto weight = [&](std::size_t i) {
        const double error = samples_[i].error / samples_[i].gain;
        const double mixing = kMixing * contrast * contrast / 2 * positive[i] * (1 - positive[i]);
        return 1 / (error * error + mixing * mixing);
      };
      for (std::size_t i = 0; i < samples_.size(); ++i) {
        const double k = weight(i), s = positive[i], y = std::log(samples_[i].gain);
        w += k, ws += k * s, wss += k * s * s, wy += k * y, wsy += k * s * y;
      }
      const double determinant = w * wss - ws * ws;
      if (!(determinant > 1e-6 * w * w)) return found;  // all on one side
      contrast = (w * wsy - ws * wy) / determinant;
      found.log_gain[0] = (wy - contrast * ws) / w;
      found.log_gain[1] = found.log_gain[0] + contrast;
      found.squares = 0;
      for (std::size_t i = 0; i < samples_.size(); ++i) {
        const double left = std::log(samples_[i].gain) - found.log_gain[0] - contrast * positive[i];
        found.squares += weight(i) * left * left;
      }
    }
    return found;
  }

  // Compass search (Hooke and Jeeves, 1961): one parameter at a time, steps halved when none helps.
  Found refined(Found best, Eigen::VectorXd step) const {
    if (best.shape.size() == 0) return best;
    const Eigen::VectorXd least = step / 64;
    for (int move = 0; move < kMoves && step[0] > least[0]; ++move) {
      bool better = false;
      for (Eigen::Index k = 0; k < step.size(); ++k)
        for (const double sign : {1.0, -1.0}) {
          Eigen::VectorXd shape = best.shape;
          shape[k] += sign * step[k];
          const Found other = fitted(best.kind, shape);
          if (other.squares < best.squares) best = other, better = true;
        }
      if (!better) step /= 2;
    }
    return best;
  }

  const std::vector<LocationSample>& samples_;
  const std::vector<std::vector<float>>& share_;
  double step_, reach_ = 0;  // [m]: of the grid, and the samples' extent
  PlanPoint middle_ = PlanPoint::Zero();
  std::vector<std::size_t> cell_;  // that any sample feels
  std::vector<PlanPoint> place_;   // their centres, from the middle
};

}  // namespace

std::optional<RegionBoundary> find_boundary(const std::vector<LocationSample>& samples,
                                            const std::vector<std::vector<float>>& share,
                                            const PlanGrid& grid) {
  constexpr std::size_t kLeast = 2 + 2 + 1;
  if (samples.size() < kLeast) return std::nullopt;
  const Search search(samples, share, grid);
  const Search::Found line = search.straight();
  std::vector<Search::Found> all{line};
  if (samples.size() > kLeast && line.shape.size() > 0) {
    all.push_back(search.bent(line));
    all.push_back(search.round());
  }
  std::optional<RegionBoundary> best;
  for (const Search::Found& found : all) {
    if (found.shape.size() == 0 || !std::isfinite(found.squares)) continue;
    RegionBoundary boundary = search.result(found);
    if (!best || boundary.criterion < best->criterion - kStrongEvidence) best = std::move(boundary);
  }
  const auto curve = find_curve(samples, share, grid, best ? best->side : PlaneClassifier());
  if (curve && (!best || curve->criterion < best->criterion - kStrongEvidence))
    best = RegionBoundary{[curve = *curve](const PlanPoint& p) { return curve.region(p); },
                          {curve->log_gain[0], curve->log_gain[1]},
                          kCurvePoints,
                          curve->criterion};
  return best;
}

}  // namespace hapsim
