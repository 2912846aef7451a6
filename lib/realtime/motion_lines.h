// Motion in and forces out, line by line as they come.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "io/csv.h"
#include "realtime/motion_source.h"

namespace hapsim {

// Reads press,t,x,y,z,ux,uy,uz[,contact] (a recording's columns, contact points known) or t,x,y,z
// alone (positions of the tool's tip), each with temp or without; in any order, others are passed
// over. Lines of several tools, by a column tool_id, where they are allowed.
class MotionLines : public MotionSource {
 public:
  // Reads up to the header. Error(kBadInput): a column is missing (nearest named).
  // `forces`: each line has a measured one, fx,fy,fz.
  explicit MotionLines(Input& input, bool forces = false)
      : MotionLines(CsvReader(input), input.name(), forces) {}
  MotionLines(CsvReader csv, std::string name, bool forces);  // its header has been read
  bool has_contact_point() const override { return known_; }
  // Error(kBadInput) naming the `columns` to give, where the columns are those of the tool's tip.
  void require_contact_points(const std::string& columns) const;
  // Otherwise next() refuses a second one.
  void allow_tools() { most_tools_ = 4; }
  bool has_tools() const { return id_column_ >= 0; }
  // Of the last line: its tool, numbered as they first came from 0, and whether no other presses.
  std::size_t tool() const { return tool_; }
  bool is_alone() const { return alone_; }
  const std::string& tool_id(std::size_t tool) const { return ids_[tool]; }
  const Metadata& metadata() const { return csv_.metadata(); }
  bool next(MotionLine& line) override;
  // Of what write_force() writes: kForceColumns, beyond, and temp where it is read.
  std::vector<std::string> force_columns() const;
  // From now on each force line ends in its uncertainty.
  void tell_uncertainty() { uncertain_ = true; }
  void write_force(std::string& buffer, const MotionLine& line, const Vec3& force) const override;
  // With ,safety,ax,ay,az at the end.
  void write_hand_force(std::string& buffer, const MotionLine& line, const Vec3& force, int safety,
                        const Vec3& asked) const override;
  long line() const { return csv_.line(); }
  Vec3 force() const { return {value_[kFx], value_[kFy], value_[kFz]}; }  // of the last line [N]

 private:
  enum Column { kPress, kT, kX, kY, kZ, kUx, kUy, kUz, kContact, kTemp, kFx, kFy, kFz, kColumns };
  CsvReader csv_;
  std::string name_;          // of the input
  std::vector<int> meaning_;  // column of the file -> Column, kColumns: passed over
  std::array<double, kColumns> value_{};
  std::vector<std::string_view> fields_;
  bool uncertain_ = false;
  bool known_ = false, warm_ = false;  // contact points, temperatures
  std::size_t tool_of(std::string_view id);
  int id_column_ = -1;
  std::size_t most_tools_ = 1, tool_ = 0;
  bool alone_ = true;
  std::vector<std::string> ids_;  // of the tools, as they first came
  std::vector<MotionCheck> checks_;
  std::vector<char> presses_;
};

// One line press,t,x,y,z,ux,uy,uz,fx,fy,fz,contact of a force, with its newline, in place: numbers
// shortest that read back. `buffer` keeps its memory from line to line.
inline const std::vector<std::string> kForceColumns{"press", "t",  "x",  "y",  "z",  "ux",
                                                    "uy",    "uz", "fx", "fy", "fz", "contact"};
void write_force_line(std::string& buffer, const MotionLine& line, const Vec3& force);
// Appends ",x,y,z" to a row, as format_number() has them; zero has no sign.
void append_columns(std::string& row, const Vec3& v);

}  // namespace hapsim
