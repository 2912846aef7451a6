#include "fusion/fusion.h"

#include <algorithm>
#include <cmath>

namespace hapsim {
namespace {

constexpr double kChiSquare3 = 7.814727903;  // 95 % point of three degrees of freedom
constexpr double kWalkFloor = 0.1;    // of the walk at rest: in fast motion it does not freeze
constexpr double kShareSpread = 0.3;  // to the next band of ways
constexpr double kScaleSpread = 0.6;  // the same, of the variances' scale
constexpr double kShareMemory = 40;   // observations
constexpr double kLargestNis = 10;    // one outlier does not blow all variances up

// What holds at a rate holds at others nearly as much.
double near(std::size_t class_of_rate, std::size_t other, double spread) {
  return std::pow(spread, class_of_rate > other ? class_of_rate - other : other - class_of_rate);
}

}  // namespace

double FusionReport::mean_nis() const {
  return judged > 0 ? nis / (3 * static_cast<double>(judged)) : 1;
}

double FusionReport::correlation() const {
  return nis > 0 ? std::clamp(lag_product / nis, 0.0, 0.99) : 0;
}

std::array<double, 2> FusionReport::band() const {
  // Wilson and Hilferty's cube root of chi-square (Proc. Nat. Acad. Sci. 17, 1931).
  const double together = correlation() * correlation();
  const double n = 3 * static_cast<double>(std::max(judged, 1L)) * (1 - together) / (1 + together);
  const double a = 2 / (9 * n);
  const auto point = [&](double z) { return std::pow(1 - a + z * std::sqrt(a), 3); };
  return {point(-1.959964), point(1.959964)};
}

Fusion::Fusion(const FusionParameters& parameters, std::size_t history)
    : parameters_(parameters),
      taught_(parameters.taught),
      filter_{Filter(history), Filter(history), Filter(history)},
      ring_(history) {
  scale_.fill(1);
  for (std::size_t c = 0; c < kWayBands; ++c)
    agreed_[c] = parameters.share.way[c] * parameters.share_known;
  added_.fill(parameters.share_known);
  begin(0, parameters.taught.place);
}

// Up to 1 mm/s, 2 mm/s, 4 mm/s, ...
std::size_t Fusion::rate_class(double rate) noexcept {
  const int k = rate > 1e-3 ? std::ilogb(rate / 1e-3) + 1 : 0;
  return static_cast<std::size_t>(std::clamp(k, 0, 7));
}

Fusion::Filter::Vector Fusion::features(int axis, double force) const noexcept {
  return {1, 0,
          force * std::abs(force) / parameters_.axis[static_cast<std::size_t>(axis)].force_scale,
          0};
}

void Fusion::begin(double t, const Vec3& contact) noexcept {
  for (std::size_t a = 0; a < 3; ++a) {
    Filter& filter = filter_[a];
    Filter::Vector x = Filter::Vector::Zero();
    Filter::Matrix P = Filter::Matrix::Zero();
    P(1, 1) = P(2, 2) = std::pow(parameters_.axis[a].gain_spread, 2);
    if (known_) {
      x.segment<2>(1) = filter.x().segment<2>(1);
      P.block<2, 2>(1, 1) = filter.P().block<2, 2>(1, 1);
    }
    filter.restart(t, x, P);
  }
  known_ = true;
  taught_.begin();
  taught_here_ = parameters_.taught.taught() && parameters_.taught.holds_at(contact);
  first_ = 0;
  next_ = 0;
  ring_[next_++] = {};
  ring_[0].t = t;
  newest_t_ = t;
  newest_way_ = 0;
  any_slow_ = false;
  u_.setZero();
  pending_.setZero();
  last_.setZero();
}

Vec3 Fusion::step(double t, const Vec3& u, const Vec3& source) noexcept {
  const Sample& before = sample(next_ - 1);
  const double dt = std::max(t - before.t, 0.0);
  Vec3 fast = source;
  if (taught_here_) fast += taught_.step(dt, u);
  const double rate = dt > 0 ? (u - u_).norm() / dt : before.rate;
  for (int a = 0; a < 3; ++a) {
    const AxisFusion& p = parameters_.axis[static_cast<std::size_t>(a)];
    const double fall = std::max(1 - rate / p.walk_rate, kWalkFloor);
    const double walk = p.offset_walk * fall, drift = p.drift_walk * fall;
    const double df = fast[a] - before.fast[a];
    const double gain = p.gain_walk * p.gain_walk * std::abs(df) / p.force_scale;
    Filter::Matrix move = Filter::Matrix::Identity();
    move(0, 0) = std::exp(-dt / p.offset_time);
    move(0, 1) = df;
    move(0, 3) = dt;
    move(3, 3) = std::exp(-dt / p.drift_time);
    filter_[static_cast<std::size_t>(a)].predict(t, move,
                                                 {walk * walk * dt, gain, 0, drift * drift * dt});
  }
  if (next_ - first_ == ring_.size()) ++first_;
  Sample& now = ring_[next_++ % ring_.size()];
  now.t = t;
  now.fast = fast;
  now.rate = rate;
  now.way = before.way + (u - u_).norm();
  now.ahead = t > newest_t_ ? std::max(rate, (now.way - newest_way_) / (t - newest_t_)) : rate;
  now.moved = any_slow_ ? std::max(now.way - newest_way_, 0.0) : -1;
  now.age = any_slow_ ? t - newest_t_ : 0;
  const double share = parameters_.weighs ? share_now(now) : 1;
  share_ += parameters_.blend > 0 ? (1 - std::exp(-dt / parameters_.blend)) * (share - share_)
                                  : share - share_;
  now.added = added();
  now.given = estimate();
  // What is held back may be right.
  now.variance = variance() + std::pow(1 - share_, 2) * now.added.cwiseAbs2();
  u_ = u;
  pending_ *= parameters_.blend > 0 ? std::exp(-dt / parameters_.blend) : 0;
  return now.given + pending_;
}

double Fusion::share_now(const Sample& now) const noexcept {
  CorrectionShares shares = parameters_.share;
  for (std::size_t c = 0; c < kWayBands; ++c)
    shares.way[c] = std::clamp(agreed_[c] / added_[c], 0.0, 1.0);
  return shares.of_way(now.moved) * shares.of_age(now.moved, now.age);
}

Vec3 Fusion::added() const noexcept {
  const Vec3& fast = sample(next_ - 1).fast;
  Vec3 f;
  for (int a = 0; a < 3; ++a)
    f[a] = features(a, fast[a]).dot(filter_[static_cast<std::size_t>(a)].x());
  return f;
}

Vec3 Fusion::estimate() const noexcept {
  return sample(next_ - 1).fast + share_ * added();
}

Vec3 Fusion::variance() const noexcept {
  const Vec3& fast = sample(next_ - 1).fast;
  Vec3 v;
  for (int a = 0; a < 3; ++a) {
    const Filter::Vector h = features(a, fast[a]);
    v[a] = std::max(h.dot(filter_[static_cast<std::size_t>(a)].P() * h), 0.0);
  }
  return v;
}

Vec3 Fusion::deviation() const noexcept {
  const Sample& now = sample(next_ - 1);
  return (scale_[rate_class(now.ahead)] * now.variance).cwiseSqrt();
}

bool Fusion::observe(double t, const Vec3& slow) noexcept {
  if (next_ == first_ || !slow.allFinite() || !(t >= sample(first_).t) || t > sample(next_ - 1).t) {
    ++report_.refused;
    return false;
  }
  // The fast source at that time, between two samples.
  std::size_t k = next_ - 1;
  while (k > first_ && sample(k - 1).t >= t) --k;
  const Sample& after = sample(k);
  const Sample& before = k > first_ ? sample(k - 1) : after;
  const double share = after.t > before.t ? (t - before.t) / (after.t - before.t) : 1;
  const Vec3 fast = before.fast + share * (after.fast - before.fast);
  const Vec3 was = estimate();
  Vec3 deviance;
  double agreed = 0, had_added = 0, agreed_newtons = 0, had_added_newtons = 0;
  Vec3 normalised = Vec3::Zero();
  for (int a = 0; a < 3; ++a) {
    const AxisFusion& p = parameters_.axis[static_cast<std::size_t>(a)];
    const double noise = p.noise + p.noise_rise * after.rate;
    const double r = noise * noise + std::pow(after.fast[a] - before.fast[a], 2) / 12;
    if (!filter_[static_cast<std::size_t>(a)]
             .observe(t, features(a, fast[a]), slow[a] - fast[a], r)
             .taken) {
      ++report_.refused;
      return false;  // of the first component, so of all
    }
    const double given = before.given[a] + share * (after.given[a] - before.given[a]);
    const double S = before.variance[a] + share * (after.variance[a] - before.variance[a]) + r;
    normalised[a] = (slow[a] - given) / std::sqrt(S);
    const double put = before.added[a] + share * (after.added[a] - before.added[a]);
    agreed += put * (slow[a] - fast[a]) / S;
    had_added += put * put / S;
    agreed_newtons += put * (slow[a] - fast[a]);
    had_added_newtons += put * put;
    deviance[a] = std::log(S) + normalised[a] * normalised[a];
  }
  if (t > newest_t_) {
    any_slow_ = true;
    newest_t_ = t;
    newest_way_ = before.way + share * (after.way - before.way);
  }
  worth_.add(after.moved, after.age, agreed_newtons, had_added_newtons);
  const std::size_t band = way_band(after.moved);
  const double of_age = parameters_.share.of_age(after.moved, after.age);
  agreed *= of_age;
  had_added *= of_age * of_age;
  for (std::size_t c = 0; c < agreed_.size(); ++c) {
    // What is known before any slow force is of its own kind.
    if ((c == 0) != (band == 0)) continue;
    const double weight = near(c, band, kShareSpread);
    agreed_[c] +=
        weight *
        (agreed - (agreed_[c] - parameters_.share.way[c] * parameters_.share_known) / kShareMemory);
    added_[c] += weight * (had_added - (added_[c] - parameters_.share_known) / kShareMemory);
  }
  const std::size_t at_ahead = rate_class(after.ahead);
  normalised /= std::sqrt(scale_[at_ahead]);
  const double nis = normalised.squaredNorm();
  ++report_.observations;
  report_.deviance += deviance;
  if (after.way > 0) {
    ++report_.judged;
    // What was learned elsewhere is worth one observation here.
    const double step = std::max(kScaleStep, 1 / (1 + static_cast<double>(report_.judged)));
    for (std::size_t c = 0; c < scale_.size(); ++c)
      scale_[c] *=
          std::exp(step * near(c, at_ahead, kScaleSpread) * (std::min(nis / 3, kLargestNis) - 1));
    report_.nis += nis;
    report_.within += nis < kChiSquare3 ? 1 : 0;
    report_.lag_product += normalised.dot(last_);
    last_ = normalised;
  }
  if (parameters_.blend > 0) pending_ += was - estimate();
  return true;
}

}  // namespace hapsim
