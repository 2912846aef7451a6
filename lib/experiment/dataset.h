// A recording as the model sees it: presses at contact positions.
#pragma once

#include <cstddef>
#include <vector>

#include "effects/effect.h"
#include "recording/recording.h"

namespace hapsim {

// Consecutive rows that share a memory: one press, or several at one position when the recording
// says `recovery: none`.
struct Episode {
  int position = 0;
  std::vector<int> rows;  // of the recording
  PressView view;         // normal, height, direction, past_depth are filled in by on_body()
};

// Which body was pressed (from 0, in the caller's list) with which tool.
struct Setup {
  int body = 0;
  double tool_radius = 0;  // of the disc (Recording::disc_radius()) [m]
  bool operator==(const Setup&) const = default;
};

struct Dataset {
  Recording recording;
  std::vector<Vec3> positions;  // distinct contact points [m], each in the frame of its body
  std::vector<Episode> episodes;
  std::vector<Setup> setups;  // distinct, in the order of the recording
  std::vector<int> setup_of;  // by position
  std::vector<int> label;     // of the body's tetrahedra there, by position; empty: all 0
  // Relative error of a position's stiffness beyond that of all (Allowance::floor), by position;
  // empty: none.
  std::vector<double> doubt;
  // Of how a ball's force grows with its contact: relative, at the largest force, by position;
  // empty: none (GainBlock::curve).
  std::vector<double> curve_doubt;
  double floor_at(std::size_t position, double floor) const;  // of both together
  std::size_t rows() const { return recording.rows(); }
  int axes() const { return measured_axes(recording.f); }  // of the force that were measured
  std::size_t bodies() const;                              // distinct ones
  std::size_t tools() const;                               // distinct radii
};

// Contact points of one setup within kSamePlace are one position. A press that never touches has
// none of its own where there are others. `setup_of_row`: by row of the
// recording; empty: all rows of one body, with the recording's tool. Error(kBadInput) when a press
// moves its contact point by more than that.
Dataset make_dataset(Recording recording, const std::vector<Setup>& setup_of_row = {});
// The earliest time of a recording [s]; 0 without times.
double session_start(const Recording& recording);
// What effects may know of a row, at the end of the press that it is of; the one place where a
// column of a recording comes to effects. Times are counted from `press_start` and `session_start`.
void add_sample(PressView& press, const Recording& recording, std::size_t row, double press_start,
                double session_start);
// How the tool stands on the body at a position.
struct ToolStand {
  Vec3 normal = Vec3::UnitZ();  // outward
  double height = 0;            // [m] between plates (mesh/between_plates.h); 0: not between plates
};
// With that by position, and what follows from it: each press's direction and the deepest press
// before it at its place (none with `recovery: full`).
Dataset on_body(Dataset dataset, const std::vector<ToolStand>& stands);

// The temperature to count from is the metadata `temp_ref`, else the mean.
DataSummary summarise(const Dataset& dataset, double modulus);

}  // namespace hapsim
