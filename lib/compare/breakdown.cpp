#include "compare/breakdown.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace hapsim {
namespace {

// Sums of one bin, kept press by press: A = sum s.s and B = sum s.r of the current press.
struct Sums {
  int press = -1;
  int presses = 0;
  double A = 0, B = 0;                                  // of the current press
  double sum_A = 0, sum_B = 0, AA = 0, AB = 0, BB = 0;  // over the presses
  double square = 0, components = 0, measured = 0;
  Vec3 residual = Vec3::Zero();
  std::size_t rows = 0;

  void close_press() {
    sum_A += A;
    sum_B += B;
    AA += A * A;
    AB += A * B;
    BB += B * B;
    A = B = 0;
  }
  void add(int of_press, const Vec3& m, const Vec3& s, int count) {
    if (of_press != press) {
      close_press();
      press = of_press;
      ++presses;
    }
    const Vec3 r = m - s;
    A += s.squaredNorm();
    B += s.dot(r);
    square += r.squaredNorm();
    measured += m.squaredNorm();
    residual += r;
    components += count;
    ++rows;
  }
};

BinError finish(Sums sums, double noise) {
  sums.close_press();
  BinError e;
  e.rows = sums.rows;
  e.presses = sums.presses;
  e.weight = sums.sum_A;
  if (sums.rows > 0) {
    e.rmse = std::sqrt(sums.square / sums.components);
    e.bias = sums.residual / static_cast<double>(sums.rows);
  }
  // Next to no simulated force: what there is of it is rounding, or drowned in noise.
  const double signal = sums.sum_A;
  if (!(signal > 1e-12 * sums.measured) || noise * noise >= signal) {
    e.weight = 0;
    e.gain = e.gain_error = std::numeric_limits<double>::quiet_NaN();
    return e;
  }
  const double a = sums.sum_B / sums.sum_A;
  e.gain = 1 + a;
  e.gain_error = noise / std::sqrt(sums.sum_A);
  e.freedom = sums.sum_A * sums.sum_A / sums.AA - 1;
  if (sums.presses > 1) {
    const double C = sums.presses;
    const double between = std::max(0.0, sums.BB - 2 * a * sums.AB + a * a * sums.AA);
    e.gain_error = std::max(e.gain_error, std::sqrt(C / (C - 1) * between) / sums.sum_A);
  }
  return e;
}

}  // namespace

std::vector<BinError> bin_errors(const Grouping& grouping, const RowFacts& facts,
                                 const std::vector<Vec3>& measured,
                                 const std::vector<Vec3>& simulated, double noise) {
  // Rows of a press need not follow each other in the file; the sums need them to.
  std::vector<std::size_t> order(measured.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return facts.press[a] < facts.press[b]; });
  std::vector<Sums> sums(grouping.bins.size());
  const int axes = measured_axes(measured);
  for (const std::size_t row : order)
    for_each_part(grouping, facts, row, measured[row], simulated[row],
                  [&](int bin, const Vec3& m, const Vec3& s, int components) {
                    sums[bin].add(facts.press[row], m, s, std::min(components, axes));
                  });
  std::vector<BinError> result;
  for (const Sums& bin : sums) result.push_back(finish(bin, noise));
  return result;
}

std::vector<Breakdown> break_down(const RowFacts& facts, const std::vector<Vec3>& measured,
                                  const std::vector<Vec3>& simulated, double noise) {
  std::vector<Breakdown> result;
  for (Grouping& grouping : make_groupings(facts)) {
    std::vector<BinError> errors = bin_errors(grouping, facts, measured, simulated, noise);
    result.push_back({std::move(grouping), std::move(errors)});
  }
  return result;
}

}  // namespace hapsim
