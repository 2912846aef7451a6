#include "recording/thinning.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/median.h"
#include "recording/force_noise.h"

namespace hapsim {
namespace {

constexpr double kOnePlace = 1e-4;  // contact points nearer than this are one [m]

// `to` becomes the mean of itself and `from`, which counts as `share` of both. Exact where they are
// equal: a reading at a sensor's end stays one.
void average(double& to, double from, double share) {
  to += share * (from - to);
}
void average(Vec3& to, const Vec3& from, double share) {
  to += share * (from - to);
}

// Calls visit with the columns that are averaged; the others keep the first row's entry.
template <class Visit>
void each_mean(Recording& r, const Visit& visit) {
  if (!r.t.empty()) visit(r.t);
  visit(r.u);
  if (!r.f.empty()) visit(r.f);
  for (const OptionalColumn& column : kOptionalColumns)
    if (!(r.*column.values).empty()) visit(r.*column.values);
}

// Variance of the noise of rows, from fourth differences of each run [N^2, a component]. Runs of
// unequal rows at their ends are as good: those are few, and the median does not see them.
template <class Runs>
double difference_variance(const std::vector<Vec3>& f, const Runs& runs) {
  constexpr double kMiddle = 0.6745;  // median(|x|) of a normal deviate over its deviation
  const double gain = std::sqrt(1.0 + 16 + 36 + 16 + 1);
  double sum = 0;
  for (int k = 0; k < 3; ++k) {
    std::vector<double> sizes;
    for (const auto& run : runs)
      for (std::size_t i = run.begin; i + 4 < run.end; ++i)
        sizes.push_back(
            std::abs(f[i][k] - 4 * f[i + 1][k] + 6 * f[i + 2][k] - 4 * f[i + 3][k] + f[i + 4][k]));
    const double sigma = upper_median(std::move(sizes)) / (kMiddle * gain);
    sum += sigma * sigma;
  }
  return sum / measured_axes(f);
}

double ratio(double part, double whole) {
  return whole > 0 ? part / whole : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

std::string thinning_words(const Thinning& t) {
  if (!t.thinned()) return "";
  std::string words =
      fmt::format("{} rows are fitted as {} means of {}", t.recorded, t.kept, t.block);
  if (t.span > 0) words += fmt::format(", over {:.3g} s each: what is faster is not seen", t.span);
  // Not rounded up to all of it.
  const auto kept = [](double share) { return std::floor(1e4 * share) / 100; };
  if (!std::isnan(t.displacement))
    words += fmt::format("; they keep {:.4g} % of what the rows tell of displacements",
                         kept(t.displacement));
  if (!std::isnan(t.rate)) words += fmt::format(", {:.4g} % of rates", kept(t.rate));
  if (t.noise_after > 0)
    words += fmt::format("; noise {:.3g} N a row, {:.3g} N a mean", t.noise_before, t.noise_after);
  return words + " (--most-rows 0 fits all)";
}

bool Thinner::go_together(const Recording& r, std::size_t a, std::size_t b) const {
  return r.press[a] == r.press[b] && r.in_air(a) == r.in_air(b) &&
         (r.position[a] - r.position[b]).norm() <= kOnePlace;
}

std::vector<Thinner::Run> Thinner::runs(const Recording& r) const {
  std::vector<Run> runs;
  for (std::size_t row = 0; row < r.rows(); ++row) {
    if (runs.empty() || !go_together(r, runs.back().begin, row)) runs.push_back({row, row});
    runs.back().end = row + 1;
  }
  return runs;
}

void Thinner::count_information(const Recording& r, std::size_t row) {
  displacement_ += r.u[row].squaredNorm();
  if (r.t.empty()) return;
  const double dt = r.t[row] - last_t_;
  if (recorded_ > 0 && r.press[row] == last_press_ && dt > 0)
    rate_ += (r.u[row] - last_u_).squaredNorm() / dt;
  last_u_ = r.u[row];
  last_t_ = r.t[row];
  last_press_ = r.press[row];
}

void Thinner::added(Recording& r) {
  const std::size_t row = r.rows() - 1;
  count_information(r, row);
  ++recorded_;
  count_.push_back(1);
  if (!r.t.empty()) {
    first_.push_back(r.t[row]);
    last_.push_back(r.t[row]);
  }
  if (block_ > 1 && row > 0 && count_[row - 1] < block_ && go_together(r, row - 1, row)) {
    const double share = 1.0 / (count_[row - 1] + 1);
    each_mean(r, [&](auto& column) { average(column[row - 1], column[row], share); });
    each_column(r, [](auto& column) {
      if (!column.empty()) column.pop_back();
    });
    ++count_[row - 1];
    count_.pop_back();
    if (r.t.empty()) return;
    last_[row - 1] = last_[row];
    first_.pop_back();
    last_.pop_back();
    return;
  }
  if (most_ > 0 && r.rows() > most_) halve(r);
}

void Thinner::look_at_noise(const Recording& r) {
  if (r.f.empty()) return;
  now_ = difference_variance(r.f, runs(r));
  seen_ = std::max(seen_, now_);
}

// Row k becomes part of row to[k], which is at most k and of its run.
void Thinner::merge(Recording& r, const std::vector<std::size_t>& to) {
  if (to.empty()) return;
  const std::size_t rows = to.back() + 1;
  const auto is_first = [&](std::size_t k) { return k == 0 || to[k] != to[k - 1]; };
  std::vector<double> share(to.size());  // of a row in the mean of it and those before it
  std::vector<int> count(rows, 0);
  for (std::size_t k = 0; k < to.size(); ++k) {
    count[to[k]] += count_[k];
    share[k] = static_cast<double>(count_[k]) / count[to[k]];
  }
  each_mean(r, [&](auto& column) {
    for (std::size_t k = 0; k < to.size(); ++k) {
      if (!is_first(k)) continue;
      auto mean = column[k];
      for (std::size_t i = k + 1; i < to.size() && to[i] == to[k]; ++i)
        average(mean, column[i], share[i]);
      column[to[k]] = mean;
    }
    column.resize(rows);
  });
  each_column(r, [&](auto& column) {
    if (column.size() != to.size()) return;  // absent, or a mean already
    for (std::size_t k = 0; k < to.size(); ++k)
      if (is_first(k) && to[k] != k) column[to[k]] = std::move(column[k]);
    column.resize(rows);
  });
  if (!first_.empty()) {
    for (std::size_t k = 0; k < to.size(); ++k) {
      if (is_first(k)) first_[to[k]] = first_[k];
      last_[to[k]] = last_[k];
    }
    first_.resize(rows);
    last_.resize(rows);
  }
  count_ = std::move(count);
}

void Thinner::halve(Recording& r) {
  // Of many short presses nothing is left to be told from fewer rows: as many again are taken.
  constexpr std::size_t kLeastOfRun = 20;
  const std::vector<Run> all = runs(r);
  if (r.rows() < 2 * kLeastOfRun * all.size()) {
    most_ = 2 * r.rows();
    return;
  }
  look_at_noise(r);
  std::vector<std::size_t> to;
  to.reserve(r.rows());
  std::size_t next = 0;
  for (const Run& run : all) {
    for (std::size_t row = run.begin; row < run.end; ++row)
      to.push_back(next + (row - run.begin) / 2);
    next = to.back() + 1;
  }
  merge(r, to);
  block_ *= 2;
}

// What is left at the end of a run is worth less than the others: less than half of it is given to
// the one before.
void Thinner::end_runs(Recording& r) {
  std::vector<std::size_t> to;
  std::size_t next = 0;
  for (const Run& run : runs(r)) {
    for (std::size_t row = run.begin; row < run.end; ++row) {
      const bool little = row > run.begin && row + 1 == run.end && 2 * count_[row] < block_;
      to.push_back(little ? next - 1 : next++);
    }
  }
  merge(r, to);
}

Thinning Thinner::end(Recording& r) {
  Thinning t{recorded_, r.rows(), block_};
  if (block_ == 1) return t;
  end_runs(r);
  look_at_noise(r);
  t.kept = r.rows();
  double displacement = 0, rate = 0;
  std::vector<double> spans;
  for (std::size_t row = 0; row < r.rows(); ++row) {
    displacement += count_[row] * r.u[row].squaredNorm();
    if (r.t.empty()) continue;
    spans.push_back(last_[row] - first_[row]);
    if (row == 0 || r.press[row] != r.press[row - 1] || r.t[row] <= r.t[row - 1]) continue;
    rate += (r.u[row] - r.u[row - 1]).squaredNorm() / (r.t[row] - r.t[row - 1]);
  }
  t.span = median(std::move(spans));
  t.displacement = ratio(displacement, displacement_);
  t.rate = ratio(rate, rate_);
  t.noise_before = declared_ > 0 ? declared_ : r.force_noise().value_or(0);
  if (t.noise_before <= 0 || r.f.empty()) return t;
  // Declared to a few per cent: that much more than what is seen is no noise that wanders.
  constexpr double kAsDeclared = 1.05;
  const double variance = t.noise_before * t.noise_before;
  const double slow = std::max(0.0, variance - kAsDeclared * seen_);
  t.noise_after = std::sqrt(std::min(variance, slow + std::max(now_, variance / block_)));
  r.metadata.set("force_noise", fmt::format("{:.4g}", t.noise_after));
  r.metadata.set("force_noise_from", fmt::format("the declared {:.4g} N of a row, and the scatter "
                                                 "of means of {}",
                                                 t.noise_before, block_));
  return t;
}

}  // namespace hapsim
