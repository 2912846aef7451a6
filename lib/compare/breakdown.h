// The residual split by what the tool was doing: where, how deep, how fast, how long, which way.
#pragma once

#include <string>
#include <vector>

#include "compare/residuals.h"

namespace hapsim {

// How the rows of a recording fall into bins by one quantity.
struct Grouping {
  enum class Kind {
    kRows,       // whole force vectors of the rows in a bin
    kComponents  // bin 0: along the position's normal, bin 1: across it, of every row in contact
  };
  struct Range {
    std::string label;            // "1 to 2 mm", "below 1 mm", "unloading"
    double lower = 0, upper = 0;  // [SI]; NaN where the bin is not a range
  };
  std::string name;   // "depth": in machine readable output
  std::string title;  // "By depth"
  Kind kind = Kind::kRows;
  std::vector<Range> bins;
  std::vector<int> bin;  // of each row, -1: none (kRows)
};

// Name of the grouping by temperature, which is an effect's name too.
inline constexpr const char* kByTemperature = "temperature";

// All groupings the recording allows: position, depth, rate, contact-time, session-time, direction
// (components), press-direction, cycle (first or later press of a place), temperature, phase
// (loading, hold, unloading, not pressed). Depth bins hold about equally many rows, bounds rounded;
// bins of rate and time have bounds 1, 2, 5, 10, ...
std::vector<Grouping> make_groupings(const RowFacts& facts);

// How measured and simulated force agree within one bin.
struct BinError {
  std::size_t rows = 0;
  int presses = 0;
  double rmse = 0;        // [N] per component
  double gain = 1;        // g of measured = g simulated, through zero; NaN without simulated force,
                          // or with less of it than noise
  double gain_error = 0;  // its standard error, clustered by press, at least that of the noise
  double freedom = 0;     // effective number of presses less one: degrees of freedom of gain_error
  double weight = 0;      // sum of squared simulated force [N^2]; 0 where the gain is NaN
  Vec3 bias = Vec3::Zero();  // mean residual [N]

  // Simulated over measured force, less one: 0.18 is "too stiff by 18 %".
  double too_stiff() const { return 1 / gain - 1; }
};

struct Breakdown {
  Grouping grouping;
  std::vector<BinError> errors;  // as grouping.bins
};

// Errors of each bin. The standard error of a gain is the cluster sandwich
// sqrt(C/(C-1) sum_c (sum_i s_i.(m_i - g s_i))^2) / sum s.s over the C presses (Liang & Zeger
// 1986); a bin with a single press has only the noise's, noise / sqrt(sum s.s). O(rows).
std::vector<BinError> bin_errors(const Grouping& grouping, const RowFacts& facts,
                                 const std::vector<Vec3>& measured,
                                 const std::vector<Vec3>& simulated, double noise);

std::vector<Breakdown> break_down(const RowFacts& facts, const std::vector<Vec3>& measured,
                                  const std::vector<Vec3>& simulated, double noise);

// Calls part(bin, measured, simulated, components) for each bin a row belongs to; of kComponents
// the vectors are the parts along and across the normal.
template <class Function>
void for_each_part(const Grouping& grouping, const RowFacts& facts, std::size_t row,
                   const Vec3& measured, const Vec3& simulated, const Function& part) {
  if (grouping.kind == Grouping::Kind::kRows) {
    if (grouping.bin[row] >= 0) part(grouping.bin[row], measured, simulated, 3);
    return;
  }
  if (facts.phase[row] == Phase::kAir) return;
  const Vec3& n = facts.normal[facts.position[row]];
  const Vec3 m = n * n.dot(measured), s = n * n.dot(simulated);
  part(0, m, s, 1);
  part(1, Vec3(measured - m), Vec3(simulated - s), 2);
}

}  // namespace hapsim
