#include "watch/change_test.h"

#include <algorithm>
#include <cmath>

namespace hapsim {
namespace {

// The limit h of a one-sided cumulative sum of independent unit normal values with reference k, at
// which false alarms come every `run` values: run = (e^(2kb) - 2kb - 1) / (2 k^2), b = h + 1.166.
double limit_for(double run, double k) {
  double low = 0, high = 100;
  for (int i = 0; i < 100; ++i) {
    const double b = 0.5 * (low + high), x = 2 * k * b;
    (((std::exp(x) - x - 1) / (2 * k * k) < run) ? low : high) = b;
  }
  return std::max(low - 1.166, 0.5);
}

}  // namespace

ChangeTest::ChangeTest(const ChangeTestOptions& options)
    : options_(options),
      block_length_(
          std::max<std::size_t>(1, static_cast<std::size_t>(options.block * options.rate + 0.5))),
      limit_(limit_for(3600 / options.block / std::max(options.false_alarms, 1e-9), kReference)) {}

double ChangeTest::size(const Vec3& force) const {
  return std::sqrt(noise_ * noise_ + share_ * share_ * force.squaredNorm() / 3);
}

bool ChangeTest::add(const Vec3& model, const Vec3& measured, bool touches) {
  ++count_;
  const double squared = (measured - model).squaredNorm();
  if (!learned_) {
    usual_.push_back({model.squaredNorm(), squared});
    in_contact_ += touches ? 1 : 0;
    if (static_cast<double>(in_contact_) >= options_.learning * options_.rate) learn();
    return false;
  }
  const double usual = size(model);
  block_squares_ += squared / (usual * usual);
  if (++block_samples_ < block_length_) return false;
  const double root = std::cbrt(block_squares_ / (3 * static_cast<double>(block_samples_)));
  block_squares_ = 0;
  block_samples_ = 0;
  if (sum_ == 0) since_ = count_ - block_length_;
  sum_ = std::max(0.0, sum_ + (root - mean_) / deviation_ - kReference);
  return sum_ > limit_;
}

void ChangeTest::restart() {
  sum_ = 0;
  since_ = count_;
  block_squares_ = 0;
  block_samples_ = 0;
}

void ChangeTest::learn_anew() {
  restart();
  learned_ = false;
  in_contact_ = 0;
}

// Squared residuals straight in the squared force: noise^2 and share^2, neither negative.
void ChangeTest::learn() {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (const auto& [force, residual] : usual_) {
    n += 1;
    x += force;
    y += residual;
    xx += force * force;
    xy += force * residual;
  }
  const double spread = xx - x * x / n;
  double slope = spread > 0 ? (xy - x * y / n) / spread : 0;
  double base = (y - slope * x) / n;
  if (slope < 0) slope = 0, base = y / n;
  if (base <= 0) base = 1e-4 * y / n + 1e-300, slope = x > 0 ? y / x : 0;
  noise_ = std::sqrt(base / 3);
  share_ = std::sqrt(slope);
  // The blocks' own mean and scatter, which tell how much neighbours go together.
  double sum = 0, squares = 0, count = 0;
  std::vector<double> roots;
  for (std::size_t i = 0; i + block_length_ <= usual_.size(); i += block_length_) {
    double mean = 0;
    for (std::size_t k = i; k < i + block_length_; ++k)
      mean += usual_[k][1] / (base + slope * usual_[k][0]) / static_cast<double>(block_length_);
    roots.push_back(std::cbrt(mean));
    sum += roots.back();
    squares += roots.back() * roots.back();
    count += 1;
  }
  mean_ = seen_ = sum / count;
  const double variance = std::max(squares / count - mean_ * mean_, 1e-6) * count / (count - 1);
  double together = 0;
  for (std::size_t i = 1; i < roots.size(); ++i)
    together += (roots[i] - mean_) * (roots[i - 1] - mean_);
  const double rho = std::clamp(together / (variance * count), 0.0, 0.9);
  // A sum of values that go together scatters like one of independent ones that much wider; and
  // both are known from so many blocks only: two standard errors to the safe side.
  deviation_ = std::sqrt(variance * (1 + rho) / (1 - rho));
  const double independent = count * (1 - rho) / (1 + rho);
  mean_ += 2 * deviation_ / std::sqrt(count);
  deviation_ *= 1 + 2 / std::sqrt(2 * std::max(independent, 2.0));
  learned_ = true;
  usual_.clear();
  usual_.shrink_to_fit();
  since_ = count_;
}

}  // namespace hapsim
