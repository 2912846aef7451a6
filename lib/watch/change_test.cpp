#include "watch/change_test.h"

#include <algorithm>
#include <cmath>

namespace hapsim {

ChangeTest::ChangeTest(const ChangeTestOptions& options)
    : options_(options),
      block_length_(
          std::max<std::size_t>(1, static_cast<std::size_t>(options.block * options.rate + 0.5))),
      sums_{PressSum(block_length_), PressSum(block_length_)} {}

double ChangeTest::size(const Vec3& force) const {
  return std::sqrt(noise_ * noise_ + share_ * share_ * force.squaredNorm() / 3);
}

double ChangeTest::usual_square(double force, double uncertainty) const {
  return 3 * noise_ * noise_ + (beside_ + uncertainty) * force;
}

bool ChangeTest::add(const TestedSample& s) {
  ++count_;
  const double force = s.model.squaredNorm(), residual = (s.measured - s.model).squaredNorm(),
               uncertainty = s.uncertainty * s.uncertainty;
  const bool fresh = count_ == 1 || s.press != press_;
  press_ = s.press;
  if (!learned_) {
    usual_.push_back({force, residual, uncertainty, s.press, s.touches});
    in_contact_ += s.touches ? 1 : 0;
    if (static_cast<double>(in_contact_) >= options_.learning * options_.rate) learn();
    return false;
  }
  if (fresh)
    for (PressSum& sum : sums_) sum.end_press();
  PressSum& sum = sums_[s.touches ? 1 : 0];
  const double usual = usual_square(force, uncertainty);
  if (!sum.add(residual / usual, uncertainty * force / usual, count_) || !sum.above()) return false;
  since_ = sum.since();
  return true;
}

void ChangeTest::restart() {
  for (PressSum& sum : sums_) sum.restart();
  since_ = count_;
}

void ChangeTest::learn_anew() {
  restart();
  learned_ = false;
  usual_.clear();
  in_contact_ = 0;
}

// Squared residuals straight in the squared force: noise^2 and share^2, neither negative.
void ChangeTest::learn() {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0, stated = 0;
  for (const Usual& u : usual_) {
    n += 1;
    x += u.force;
    y += u.residual;
    xx += u.force * u.force;
    xy += u.force * u.residual;
    stated += u.uncertainty * u.force;
  }
  const double spread = xx - x * x / n;
  double slope = spread > 0 ? (xy - x * y / n) / spread : 0;
  double base = (y - slope * x) / n;
  if (slope < 0) slope = 0, base = y / n;
  if (base <= 0) base = 1e-4 * y / n + 1e-300, slope = x > 0 ? y / x : 0;
  noise_ = std::sqrt(base / 3);
  share_ = std::sqrt(slope);
  stated = x > 0 ? stated / x : 0;
  beside_ = std::max(0.0, slope - stated);
  // What the presses have shown, each in the air and in contact.
  std::array<std::vector<PressValue>, 2> values;
  std::array<PressSum, 2> sums{PressSum(block_length_), PressSum(block_length_)};
  double presses = 1;
  const auto end_press = [&] {
    for (std::size_t k = 0; k < 2; ++k)
      if (const PressValue v = sums[k].end_press(); v.value >= 0) values[k].push_back(v);
  };
  for (std::size_t i = 0; i < usual_.size(); ++i) {
    const Usual& u = usual_[i];
    if (i > 0 && u.press != usual_[i - 1].press) end_press(), presses += 1;
    const double usual = usual_square(u.force, u.uncertainty);
    sums[u.touches ? 1 : 0].add(u.residual / usual, u.uncertainty * u.force / usual, i);
  }
  end_press();
  const double hours = n / options_.rate / 3600;
  const double run = 2 * presses / hours / std::max(options_.false_alarms, 1e-9);
  for (std::size_t k = 0; k < 2; ++k) sums_[k].learn(values[k], run);
  learned_ = true;
  usual_.clear();
  usual_.shrink_to_fit();
  restart();
}

}  // namespace hapsim
