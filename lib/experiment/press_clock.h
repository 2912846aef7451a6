// Where the times of a table of markers lie among the rows of a recording.
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "base/vec3.h"
#include "experiment/dataset.h"
#include "recording/marker_table.h"

namespace hapsim {

// A time between two rows of one press (or at one, which both then are).
struct PressTime {
  int episode = -1;                   // -1: in no press
  std::size_t first = 0, second = 0;  // rows of the recording
  double share = 0;                   // of the way from the first to the second
};

// Presses are told by the table's column press, without it by the time alone. Both must outlive it.
class PressClock {
 public:
  // Error(kBadInput): the recording has no times, or they begin anew with each press where the
  // table does not say in which press a point was seen.
  PressClock(const MarkerTable& table, const Dataset& dataset);
  PressTime of_row(std::size_t row) const;       // of the table
  Vec3 displacement(const PressTime& at) const;  // of the tool [m]; zero in the air
  bool in_air(const PressTime& at) const;        // at one of the two rows

 private:
  PressTime find(int press, double t) const;
  double time(int row) const;

  const MarkerTable& table_;
  const Dataset& dataset_;
  std::map<int, std::vector<std::pair<int, int>>> rows_;  // row and episode, by press
};

}  // namespace hapsim
