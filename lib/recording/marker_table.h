// Marked points of a body's surface as a camera sees them: the table beside a recording.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/vec3.h"
#include "io/metadata.h"
#include "io/stream.h"

namespace hapsim {

// Columns point,t,x,y,z,ux,uy,uz[,press], one row a point and time; `point` names it. Lengths and
// times in SI units, or with the unit in the header (ux_mm, "t [ms]").
struct MarkerTable {
  std::string name;  // of the source, for error messages
  Metadata metadata;
  std::vector<std::string> points;  // names, in order of first appearance
  std::vector<Vec3> rest;           // by point: where it lies on the unpressed body [m]
  // By row; empty of a table of points alone, press also where there is no such column.
  std::vector<long> line;  // in the source
  std::vector<int> point;  // index into points
  std::vector<int> press;
  std::vector<double> t;  // [s]
  std::vector<Vec3> u;    // displacement from the rest position [m]

  std::size_t rows() const { return u.size(); }
  // Metadata `marker_noise`: standard deviation of a component [m]. Error(kBadInput) where it is
  // none.
  std::optional<double> noise() const;
};

// With `need_motion` false t,ux,uy,uz may be absent, all four together: points to be simulated.
// Error(kBadInput): a missing column, a cell that is no number, an unknown unit, lengths whose size
// says that the unit is wrong, a point whose rest position changes (line), no rows.
MarkerTable read_markers(Input& input, bool need_motion);

// SI units; press where there is one. Deterministic bytes.
void write_markers(std::ostream& out, const MarkerTable& table);

// Gaussian noise of this standard deviation [m] on every component, declared.
void add_marker_noise(MarkerTable& table, double noise, std::uint64_t seed);

}  // namespace hapsim
