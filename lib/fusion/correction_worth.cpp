#include "fusion/correction_worth.h"

#include <algorithm>
#include <cmath>

namespace hapsim {
namespace {

constexpr double kFirstWay = 2e-4;  // [m]
constexpr double kFirstAge = 0.01;  // [s]
constexpr long kLeast = 3;          // observations that tell what corrections are worth

// 0 up to `first`, 1 up to twice that, ...
int doubling(double x, double first) {
  return x > first ? std::ilogb(x / first) + 1 : 0;
}

template <std::size_t N>
double between(const std::array<double, N>& values, std::size_t begin, double x, double first) {
  const auto of = [&](double k) {
    return values[begin +
                  static_cast<std::size_t>(std::clamp(k, 0.0, static_cast<double>(N - 1 - begin)))];
  };
  const double at = x > 0 ? std::max(std::log2(x / first) + 0.5, 0.0) : 0, k = std::floor(at);
  return of(k) + (at - k) * (of(k + 1) - of(k));
}

}  // namespace

std::size_t way_band(double moved) noexcept {
  if (moved < 0) return 0;
  return std::min<std::size_t>(static_cast<std::size_t>(1 + doubling(moved, kFirstWay)),
                               kWayBands - 1);
}

std::size_t age_band(double age) noexcept {
  return std::min<std::size_t>(static_cast<std::size_t>(doubling(age, kFirstAge)), kAgeBands - 1);
}

double CorrectionShares::of_way(double moved) const noexcept {
  return moved < 0 ? way[0] : between(way, 1, moved, kFirstWay);
}

double CorrectionShares::of_age(double moved, double since) const noexcept {
  return moved < 0 ? 1 : between(age, 0, since, kFirstAge);
}

void CorrectionWorth::add(double moved, double age, double agreed, double added) noexcept {
  Cell& cell = cells_[way_band(moved)][age_band(age)];
  cell.agreed += agreed;
  cell.added += added;
  ++cell.count;
}

void CorrectionWorth::add(const CorrectionWorth& other) {
  for (std::size_t w = 0; w < kWayBands; ++w)
    for (std::size_t a = 0; a < kAgeBands; ++a) {
      cells_[w][a].agreed += other.cells_[w][a].agreed;
      cells_[w][a].added += other.cells_[w][a].added;
      cells_[w][a].count += other.cells_[w][a].count;
    }
}

CorrectionShares CorrectionWorth::shares(const CorrectionShares& start) const {
  CorrectionShares result = start;
  result.age.fill(1);
  // By turns: each is the other's least squares.
  for (int turn = 0; turn < 20; ++turn) {
    for (std::size_t w = 0; w < kWayBands; ++w) {
      double agreed = 0, added = 0;
      long count = 0;
      for (std::size_t a = 0; a < kAgeBands; ++a) {
        const double s = w == 0 ? 1 : result.age[a];
        agreed += s * cells_[w][a].agreed;
        added += s * s * cells_[w][a].added;
        count += cells_[w][a].count;
      }
      result.way[w] = count >= kLeast && added > 0 ? std::clamp(agreed / added, 0.0, 1.0)
                      : w > 1                      ? result.way[w - 1]
                                                   : start.way[w];
    }
    for (std::size_t a = 0; a < kAgeBands; ++a) {
      double agreed = 0, added = 0;
      long count = 0;
      for (std::size_t w = 1; w < kWayBands; ++w) {
        agreed += result.way[w] * cells_[w][a].agreed;
        added += result.way[w] * result.way[w] * cells_[w][a].added;
        count += cells_[w][a].count;
      }
      result.age[a] = count >= kLeast && added > 0 ? std::clamp(agreed / added, 0.0, 1.0)
                      : a > 0                      ? result.age[a - 1]
                                                   : 1;
    }
  }
  return result;
}

}  // namespace hapsim
