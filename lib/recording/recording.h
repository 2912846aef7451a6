// A recording of presses, measured or simulated: the one data format of hapsim.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/vec3.h"
#include "io/metadata.h"
#include "io/stream.h"

namespace hapsim {

// One press (contact episode): its rows in order of time.
struct Press {
  int id = 0;
  std::vector<int> rows;
};

// Columns press,t,x,y,z,ux,uy,uz,fx,fy,fz[,temp][,contact]; one entry a row, SI units.
struct Recording {
  std::string name;  // of the source, for error messages
  Metadata metadata;
  std::vector<long> line;  // in the source
  std::vector<int> press;
  std::vector<double> t;       // [s]; empty: quasi-static (no t column)
  std::vector<Vec3> position;  // contact point on the undeformed surface [m]
  std::vector<Vec3> u;         // displacement of the tool tip from there [m]
  std::vector<Vec3> f;         // force of the body on the tool [N]; empty: a motion without forces
  std::vector<double> temp;    // [degC]; empty: not measured
  std::vector<char> contact;   // 0: the tool is in the air, force 0 expected; empty: always 1
  std::vector<std::string> extra_header;        // unknown columns, carried through
  std::vector<std::vector<std::string>> extra;  // extra[c][row]

  std::size_t rows() const { return press.size(); }
  bool in_air(std::size_t row) const { return !contact.empty() && contact[row] == 0; }
  double tool_radius() const;  // metadata `tool_radius`; Error when missing
  // Of the disc for which a body's stiffness is solved [m]: metadata `contact_radius`
  // (experiment/contact_radius.h), else that of the tool.
  double disc_radius() const;
  bool has_ball() const;                      // metadata `tool: sphere`, of tool_radius
  std::optional<double> force_noise() const;  // metadata `force_noise` [N], per component
  std::vector<Press> presses() const;         // in order of first appearance
};

// Further measured columns, each of which may be absent: reading, writing, joining and cutting know
// them by this list alone.
struct OptionalColumn {
  const char* name;
  std::vector<double> Recording::*values;
};
inline constexpr OptionalColumn kOptionalColumns[] = {{"temp", &Recording::temp}};

// Calls visit(column) with every vector of one entry a row; columns that are absent are empty.
template <class Visit>
void each_column(Recording& r, const Visit& visit) {
  visit(r.line);
  visit(r.press);
  visit(r.t);
  visit(r.position);
  visit(r.u);
  visit(r.f);
  visit(r.contact);
  for (const OptionalColumn& column : kOptionalColumns) visit(r.*column.values);
  for (std::vector<std::string>& column : r.extra) visit(column);
}

// How many components of the forces were measured: a load cell of one axis leaves zeros in every
// row of the others, which say nothing of noise or error. At least 1.
int measured_axes(const std::vector<Vec3>& forces);

// Reads by column name. With `need_forces` false the force columns may be absent (a motion).
// Error(kBadInput): missing column (with the nearest present one), NaN or text (line), time that
// runs backwards inside a press (line), values whose size says that the unit is wrong (|x| > 10 m,
// |u| > 1 m: "are these millimetres?"), no data rows.
Recording read_recording(Input& input, bool need_forces = true);

// Writes all columns, `extra` last. Deterministic bytes. Numbers shortest that read back.
void write_recording(std::ostream& out, const Recording& recording);

}  // namespace hapsim
