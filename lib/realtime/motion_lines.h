// Motion in and forces out, line by line as they come.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "base/vec3.h"
#include "io/csv.h"

namespace hapsim {

struct MotionLine {
  bool has_contact_point = true;  // else `point` is the tool's tip and `u` is zero
  int press = 1;
  double t = 0;               // [s]
  Vec3 point = Vec3::Zero();  // [m]
  Vec3 u = Vec3::Zero();      // [m]
  bool in_air = false;
};

// Reads press,t,x,y,z,ux,uy,uz[,contact] (a recording's columns, contact points known) or t,x,y,z
// alone (positions of the tool's tip); in any order, others are passed over.
class MotionLines {
 public:
  // Reads up to the header. Error(kBadInput): a column is missing (nearest named).
  explicit MotionLines(Input& input);
  bool has_contact_point() const { return known_; }
  const Metadata& metadata() const { return csv_.metadata(); }
  // The next line, false at the end; returns as soon as it is there. Error(kBadInput) with the
  // line: what is no number, time that runs backwards within a press, sizes that mean another unit,
  // a contact point that moves within a press.
  bool next(MotionLine& line);
  long line() const { return csv_.line(); }

 private:
  void check(const MotionLine& line);

  enum Column { kPress, kT, kX, kY, kZ, kUx, kUy, kUz, kContact, kColumns };
  CsvReader csv_;
  std::vector<int> meaning_;  // column of the file -> Column, kColumns: passed over
  std::array<double, kColumns> value_{};
  std::vector<std::string_view> fields_;
  bool known_ = false, first_ = true;
  MotionLine last_;
};

// One line press,t,x,y,z,ux,uy,uz,fx,fy,fz,contact of a force, with its newline, in place: numbers
// shortest that read back. `buffer` keeps its memory from line to line.
inline const std::vector<std::string> kForceColumns{"press", "t",  "x",  "y",  "z",  "ux",
                                                    "uy",    "uz", "fx", "fy", "fz", "contact"};
void write_force_line(std::string& buffer, const MotionLine& line, const Vec3& force);

}  // namespace hapsim
