#include "plan/spread_places.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace hapsim {
namespace {

constexpr double kNoise = 0.1;  // variance of an observation over that of the process
// Of the spacing that the presses will have: long ones part the surface evenly, short ones follow
// what is seen of it.
constexpr double kWideLength = 1.1, kCloseLength = 0.5;
constexpr double kMostWeight = 10;     // of a place that is suspected
constexpr double kLeastSpread = 0.01;  // of gains: so much the meshes do

// Covariance of the process at the places, its mean, as presses come in one after the other.
class Process {
 public:
  Process(const std::vector<PressablePlace>& places, double length)
      : places_(places),
        length_(length),
        n_(static_cast<Eigen::Index>(places.size())),
        mean_(Eigen::VectorXd::Zero(n_)),
        covariance_(n_, n_) {
    for (Eigen::Index a = 0; a < n_; ++a)
      for (Eigen::Index b = 0; b < n_; ++b) covariance_(a, b) = alike(point(a), point(b));
  }
  // Presses that were done, all at once.
  void see(const std::vector<SeenPlace>& seen, double middle) {
    const auto m = static_cast<Eigen::Index>(seen.size());
    if (m == 0) return;
    Eigen::MatrixXd among(m, m), to(n_, m);
    Eigen::VectorXd gain(m);
    for (Eigen::Index s = 0; s < m; ++s) {
      const SeenPlace& own = seen[static_cast<std::size_t>(s)];
      for (Eigen::Index o = 0; o < m; ++o)
        among(s, o) = alike(own.point, seen[static_cast<std::size_t>(o)].point);
      among(s, s) += kNoise;
      for (Eigen::Index a = 0; a < n_; ++a) to(a, s) = alike(point(a), own.point);
      gain[s] = std::isfinite(own.gain) ? own.gain - middle : 0;
    }
    const Eigen::LDLT<Eigen::MatrixXd> solve(among);
    mean_ = to * solve.solve(gain);
    covariance_ -= to * solve.solve(to.transpose());
  }
  // How much a press at a place lowers the weighted variance of all.
  double worth(Eigen::Index a, const Eigen::VectorXd& weight) const {
    return covariance_.col(a).cwiseAbs2().dot(weight) / (std::max(0.0, covariance_(a, a)) + kNoise);
  }
  void press(Eigen::Index a) {
    const Eigen::VectorXd column = covariance_.col(a);
    covariance_ -= column * column.transpose() / (std::max(0.0, column[a]) + kNoise);
  }
  const Eigen::VectorXd& mean() const { return mean_; }

 private:
  const Vec3& point(Eigen::Index a) const { return places_[static_cast<std::size_t>(a)].point; }
  double alike(const Vec3& a, const Vec3& b) const {
    return std::exp(-0.5 * (a - b).squaredNorm() / (length_ * length_));
  }

  const std::vector<PressablePlace>& places_;
  double length_;
  Eigen::Index n_;
  Eigen::VectorXd mean_;
  Eigen::MatrixXd covariance_;
};

// A share of the spacing of so many presses over the places, in plan view.
double length_for(const std::vector<PressablePlace>& places, std::size_t presses, double least,
                  double share) {
  Vec3 low = places.front().point, high = low;
  for (const PressablePlace& p : places) {
    low = low.cwiseMin(p.point);
    high = high.cwiseMax(p.point);
  }
  const Vec3 size = high - low;
  const double area = std::max(size.x() * size.y(), least * least);
  return std::max(least,
                  share * std::sqrt(area / static_cast<double>(std::max<std::size_t>(presses, 1))));
}

}  // namespace

std::vector<PressablePlace> spread_places(const std::vector<PressablePlace>& places,
                                          const std::vector<SeenPlace>& seen, double least_length,
                                          std::size_t count, const std::vector<double>& asked) {
  std::vector<PressablePlace> chosen;
  if (places.empty()) return chosen;
  double middle = 0, squares = 0;
  std::size_t known = 0;
  for (const SeenPlace& s : seen)
    if (std::isfinite(s.gain)) middle += s.gain, ++known;
  if (known > 0) middle /= static_cast<double>(known);
  for (const SeenPlace& s : seen)
    if (std::isfinite(s.gain)) squares += (s.gain - middle) * (s.gain - middle);
  Process process(places, length_for(places, seen.size() + count, least_length,
                                     known > 1 ? kCloseLength : kWideLength));
  process.see(seen, middle);
  Eigen::VectorXd weight = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(places.size()));
  if (!asked.empty()) {
    weight = Eigen::Map<const Eigen::VectorXd>(asked.data(), weight.size());
  } else if (known > 1) {
    const double spread =
        std::max(kLeastSpread, std::sqrt(squares / static_cast<double>(known - 1)));
    weight += (process.mean() / spread).cwiseAbs2();
    weight = weight.cwiseMin(kMostWeight);
  }
  std::vector<bool> taken(places.size(), false);
  while (chosen.size() < std::min(count, places.size())) {
    Eigen::Index best = -1;
    double most = -1;
    for (Eigen::Index a = 0; a < weight.size(); ++a) {
      const double worth = taken[static_cast<std::size_t>(a)] ? -1 : process.worth(a, weight);
      if (worth > most) most = worth, best = a;
    }
    if (best < 0) break;
    taken[static_cast<std::size_t>(best)] = true;
    chosen.push_back(places[static_cast<std::size_t>(best)]);
    process.press(best);
  }
  return chosen;
}

}  // namespace hapsim
