// The cumulative sum of a change test, press by press.
#include <algorithm>
#include <cmath>

#include "watch/change_test.h"

namespace hapsim {
namespace {

// Of the cube root of a squared error over what is stated of it, two of its components free: the
// presses learned from may have met less of it than later ones.
constexpr double kStatedMean = 0.89, kStatedDeviation = 1.0 / 3;

}  // namespace

// run = (e^(2kb) - 2kb - 1) / (2 k^2), b = h + 1.166, k = 1/2.
double change_limit(double run) {
  constexpr double k = 0.5;
  double low = 0, high = 100;
  for (int i = 0; i < 100; ++i) {
    const double b = 0.5 * (low + high), x = 2 * k * b;
    (((std::exp(x) - x - 1) / (2 * k * k) < run) ? low : high) = b;
  }
  return std::max(low - 1.166, 0.5);
}

void PressSum::learn(const std::vector<double>& values, double run) {
  restart();
  learned_ = !values.empty();
  if (!learned_) return;
  const auto count = static_cast<double>(values.size());
  double sum = 0, squares = 0, together = 0;
  for (const double v : values) sum += v;
  seen_ = sum / count;
  for (const double v : values) squares += (v - seen_) * (v - seen_);
  for (std::size_t i = 1; i < values.size(); ++i)
    together += (values[i] - seen_) * (values[i - 1] - seen_);
  const double rho = squares > 0 ? std::clamp(together / squares, 0.0, 0.9) : 0;
  limit_ = change_limit(run);
  deviation_ = kStatedDeviation;
  mean_ = seen_ + 2 * deviation_;
  if (values.size() == 1) return;
  // A sum of values that go together scatters like one of independent ones that much wider.
  const double independent = std::max(count * (1 - rho) / (1 + rho), 2.0);
  deviation_ = std::sqrt(squares / (count - 1) * (1 + rho) / (1 - rho));
  // Both are known from so many presses only: two standard errors to the safe side, those of the
  // variance by the cube root of chi squared (Wilson and Hilferty).
  mean_ = seen_ + 2 * deviation_ / std::sqrt(count);
  const double freedom = 2 / (9 * (independent - 1));
  deviation_ /= std::pow(std::max(1 - freedom - 2 * std::sqrt(freedom), 0.2), 1.5);
  deviation_ = std::max(deviation_, 1e-3);
}

void PressSum::begin_press() {
  blocks_ = samples_ = 0;
  squares_ = stated_ = most_stated_ = 0;
  most_ = -1;
  rises_.clear();
}

void PressSum::restart() {
  begin_press();
  sum_ = 0;
  presses_.clear();
}

double PressSum::end_press() {
  // Of a press too short for a block, what there is.
  if (blocks_ == 0 && 2 * samples_ >= block_length_ && samples_ > 0)
    most_ = std::cbrt(squares_ / static_cast<double>(samples_));
  const double value = most_;
  if (learned_ && most_ >= 0) {
    sum_ = level();
    if (sum_ == 0)
      presses_.clear();
    else
      presses_.push_back(this_press());
  }
  begin_press();
  return value;
}

bool PressSum::add(double square, double stated, std::size_t at) {
  squares_ += square;
  stated_ += stated;
  if (++samples_ < block_length_) return false;
  window_[blocks_++ % kWindow] = squares_ / static_cast<double>(samples_);
  most_stated_ = std::max(most_stated_, stated_ / static_cast<double>(samples_));
  samples_ = 0;
  squares_ = stated_ = 0;
  const std::size_t n = std::min(blocks_, kWindow);
  double mean = 0;
  for (std::size_t i = 0; i < n; ++i) mean += window_[i] / static_cast<double>(n);
  if (const double root = std::cbrt(mean); root > most_) {
    most_ = root;
    if (learned_) rises_.push_back({at - std::min(at, block_length_), excess()});
  }
  return true;
}

double PressSum::excess() const {
  return (most_ - std::max(mean_, kStatedMean)) /
         std::max(deviation_, most_stated_ * kStatedDeviation);
}

double PressSum::level() const {
  if (!learned_ || most_ < 0) return sum_;
  return std::max(0.0, sum_ + excess() - kReference);
}

PressSum::Excess PressSum::this_press() const {
  const double value = excess();
  for (const Excess& rise : rises_)
    if (rise.value >= 0.5 * value) return {rise.at, value};
  return {0, value};  // too short for a block
}

std::size_t PressSum::since() const {
  std::vector<Excess> all = presses_;
  if (!rises_.empty()) all.push_back(this_press());
  double mean = 0, sum = 0, most = 0;
  for (const Excess& e : all) mean += e.value / static_cast<double>(all.size());
  std::size_t at = all.empty() ? 0 : all.back().at;
  for (auto e = all.rbegin(); e != all.rend(); ++e) {
    sum += e->value - 0.5 * mean;
    if (sum > most && e->at > 0) most = sum, at = e->at;
  }
  return at;
}

}  // namespace hapsim
