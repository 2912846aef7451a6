// The cumulative sum of a change test, press by press.
#include <algorithm>
#include <cmath>

#include "watch/change_test.h"

namespace hapsim {
namespace {

// Of the cube root of a squared error over what is stated of it, two of its components free: the
// presses learned from may have met less of it than later ones.
constexpr double kStatedMean = 0.89, kStatedDeviation = 1.0 / 3;
constexpr std::size_t kTailSeen = 256;
constexpr double kMostErrors = 3;  // of what was learned, to the safe side

double mean_of(const std::vector<PressValue>& values) {
  double sum = 0;
  for (const PressValue& v : values) sum += v.value;
  return sum / static_cast<double>(values.size());
}

double squares_about(double mean, const std::vector<PressValue>& values) {
  double squares = 0;
  for (const PressValue& v : values) squares += (v.value - mean) * (v.value - mean);
  return squares;
}

// The t of change_limit; of few values at most that of normal ones, for their tail is not seen yet.
double tail_of(const std::vector<PressValue>& values, double mean, double deviation) {
  const auto above_one = [&](double t) {
    double sum = 0;
    for (const PressValue& v : values) sum += std::exp(t * ((v.value - mean) / deviation - 0.5));
    return sum > static_cast<double>(values.size());
  };
  double low = 0.1, high = values.size() < kTailSeen ? 1 : 3;
  if (!above_one(high)) return high;
  for (int i = 0; i < 20; ++i) {
    const double t = 0.5 * (low + high);
    (above_one(t) ? high : low) = t;
  }
  return low;
}

}  // namespace

// run = (e^(t b) - t b - 1) / (t k), b = h + 1.166, k = 1/2.
double change_limit(double run, double tail) {
  constexpr double k = 0.5;
  double low = 0, high = 100;
  for (int i = 0; i < 100; ++i) {
    const double b = 0.5 * (low + high), x = tail * b;
    (((std::exp(x) - x - 1) / (tail * k) < run) ? low : high) = b;
  }
  return std::max(low - 1.166, 0.5);
}

void PressSum::learn(std::vector<PressValue> values, double run) {
  restart();
  learned_ = !values.empty();
  values_ = std::move(values);
  run_ = run;
  if (learned_) set_usual();
}

void PressSum::set_usual() {
  const auto count = static_cast<double>(values_.size());
  seen_ = mean_of(values_);
  stated_usual_ = 0;
  for (const PressValue& v : values_) stated_usual_ = std::max(stated_usual_, v.stated);
  limit_ = change_limit(run_);
  deviation_ = kStatedDeviation;
  mean_ = seen_ + 2 * deviation_;
  if (values_.size() == 1) return;
  const double squares = squares_about(seen_, values_);
  double together = 0;
  for (std::size_t i = 1; i < values_.size(); ++i)
    together += (values_[i].value - seen_) * (values_[i - 1].value - seen_);
  const double rho = squares > 0 ? std::clamp(together / squares, 0.0, 0.9) : 0;
  // A sum of values that go together scatters like one of independent ones that much wider.
  const double independent = std::max(count * (1 - rho) / (1 + rho), 2.0);
  deviation_ = std::sqrt(squares / (count - 1) * (1 + rho) / (1 - rho));
  if (deviation_ > 0) limit_ = change_limit(run_, tail_of(values_, seen_, deviation_));
  // Both are known from so many presses only. An error of e standard deviations in the mean makes
  // alarms exp(2 h e) times as frequent, which over what chance may have shown comes to
  // exp(2 h^2 / n): h / n to the safe side, h / sqrt(n) standard errors, keeps what is stated on
  // the average, and as many of the variance do (by the cube root of chi squared, Wilson and
  // Hilferty).
  const double errors = std::min(kMostErrors, limit_ / std::sqrt(independent));
  mean_ = seen_ + errors * deviation_ / std::sqrt(count);
  const double freedom = 2 / (9 * (independent - 1));
  deviation_ /= std::pow(std::max(1 - freedom - errors * std::sqrt(freedom), 0.2), 1.5);
  deviation_ = std::max(deviation_, 1e-3);
}

// What would hide a slow change, were it learned, is not: the sum goes on from what it was.
void PressSum::learn_from_later(const PressValue& value) {
  if (values_.size() >= kMostLearned) return;
  later_.push_back(value);
  if (later_.size() < std::max<std::size_t>(values_.size(), 8) || sum_ > 0) return;
  const double before = mean_of(values_), now = mean_of(later_);
  const auto n = static_cast<double>(values_.size()), m = static_cast<double>(later_.size());
  const double variance =
      std::max((squares_about(before, values_) + squares_about(now, later_)) / (n + m - 1),
               deviation_ * deviation_ / 4);
  if (now - before > 2 * std::sqrt(variance * (1 / n + 1 / m))) {
    later_.clear();
    return;
  }
  values_.insert(values_.end(), later_.begin(), later_.end());
  later_.clear();
  set_usual();
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
  later_.clear();
}

PressValue PressSum::end_press() {
  // Of a press too short for a block, what there is.
  if (blocks_ == 0 && 2 * samples_ >= block_length_ && samples_ > 0)
    most_ = std::cbrt(squares_ / static_cast<double>(samples_));
  const PressValue value{most_, most_stated_};
  if (learned_ && most_ >= 0) {
    sum_ = level();
    if (sum_ == 0)
      presses_.clear();
    else
      presses_.push_back(this_press());
    learn_from_later(value);
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
  const double more = std::max(0.0, most_stated_ - stated_usual_);
  const double untried = std::min(1.0, more / std::max(stated_usual_, 1e-3));
  const double mean = mean_ + untried * std::max(0.0, kStatedMean - mean_);
  return (most_ - mean) / std::max(deviation_, more * kStatedDeviation);
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
  double size = all.empty() ? 0 : all.back().value, mean = 0, sum = 0, most = 0;
  for (const Excess& e : all) mean += e.value / static_cast<double>(all.size());
  size = std::max(size, mean);
  std::size_t at = all.empty() ? 0 : all.back().at;
  for (auto e = all.rbegin(); e != all.rend(); ++e) {
    sum += e->value - 0.5 * size;
    if (sum > most && e->at > 0) most = sum, at = e->at;
  }
  return at;
}

}  // namespace hapsim
