// What a correction by late forces is worth, by the way and the time since the newest of them.
#pragma once

#include <array>
#include <cstddef>

namespace hapsim {

// Bands of the way that the tool has gone since the newest slow force that was there: none in this
// contact yet, then to 0.2 mm, 0.4 mm, 0.8 mm, ...; and of the time since: to 10 ms, 20 ms, ...
inline constexpr std::size_t kWayBands = 9, kAgeBands = 9;

std::size_t way_band(double moved) noexcept;  // [m]; negative: there was none
std::size_t age_band(double age) noexcept;    // [s]

// The share of a correction that is let in: one of its way times one of its age. Where there was no
// slow force yet the age counts for nothing.
struct CorrectionShares {
  std::array<double, kWayBands> way{0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5};
  std::array<double, kAgeBands> age{1, 1, 1, 1, 1, 1, 1, 1, 1};
  // Between the bands' middles straight in the logarithm.
  double of_way(double moved) const noexcept;
  double of_age(double moved, double since) const noexcept;
};

// Sums over observations of what was added times what was missing, and of what was added squared.
class CorrectionWorth {
 public:
  void add(double moved, double age, double agreed, double added) noexcept;  // [N^2]
  void add(const CorrectionWorth& other);
  // The shares by which the corrections agree best, in the mean square, with what was missing
  // (Bates and Granger, Operational Research Quarterly 20, 1969), in newtons: the filter's own
  // variances tell which motion it knows little of, and its worst forecasts would count least. A
  // band of ways that hardly any motion reached has what the one before it has, if that has any,
  // else that of `start`; one of ages what the one before it has.
  CorrectionShares shares(const CorrectionShares& start) const;

 private:
  struct Cell {
    double agreed = 0, added = 0;
    long count = 0;
  };
  std::array<std::array<Cell, kAgeBands>, kWayBands> cells_{};
};

}  // namespace hapsim
