// Motions of several tools, or of one that turns, as CSV lines.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "io/csv.h"
#include "realtime/tool_source.h"

namespace hapsim {

// Reads the columns of MotionLines, with tool_id (any words; one tool without), and with thx, thy,
// thz, the tool's rotation vector [rad]: as it is, or, with contact points, since it touched. Lines
// of one time (and press), one a tool, are one step. Answers are those lines with what was felt:
// press, t, tool_id, x, y, z, ux, uy, uz, thx, thy, thz, fx, fy, fz, tqx, tqy, tqz (torque about
// the tip [N m]), contact, beyond, temp, those of turning, tool_id and temp where they were read.
class ToolLines : public ToolSource {
 public:
  // Whether this header asks for them.
  static bool serves(const std::vector<std::string>& header);

  // `tools`: how many there are; a step then ends with the last one's line. 0: the metadata
  // `tools`; and where that is not there either, a step ends where the next begins, so that each is
  // answered when the next one has come. Error(kBadInput): a column is missing, too many tools.
  ToolLines(CsvReader csv, std::string name, std::size_t tools);

  std::size_t tools() const override { return tools_; }
  bool has_contact_point() const override { return known_; }
  const Metadata& metadata() const { return csv_.metadata(); }
  std::vector<std::string> columns() const;
  // From now on each line ends in safety, ax, ay, az, of tools that turn also atqx, atqy, atqz: why
  // the force or torque is not what was asked for, and that.
  void tell_hand() { hand_ = true; }
  // And before these in the force's uncertainty.
  void tell_uncertainty() { uncertain_ = true; }
  bool next(ToolStep& step) override;
  void write(std::string& buffer, const ToolStep& step,
             std::span<const ToolFeel> feel) const override;

 private:
  enum Column {
    kPress,
    kT,
    kX,
    kY,
    kZ,
    kUx,
    kUy,
    kUz,
    kThx,
    kThy,
    kThz,
    kContact,
    kTemp,
    kColumns
  };
  struct Row {
    std::size_t tool = 0;
    double t = 0, temperature = 0;
    ToolPose pose;
  };
  bool read_row();  // into row_
  std::size_t tool_of(std::string_view id);
  bool joins(const ToolStep& step, std::size_t rows) const;

  CsvReader csv_;
  std::string name_;
  std::vector<int> meaning_;  // column of the file -> Column; kColumns: passed over
  int id_column_ = -1;
  std::array<double, kColumns> value_{};
  std::vector<std::string_view> fields_;
  std::array<std::string, kMostTools> ids_;  // of the tools, as they first came
  std::size_t known_ids_ = 0;
  std::size_t tools_ = 1;
  bool known_ = false, warm_ = false, turns_ = false, counted_ = false, hand_ = false;
  bool uncertain_ = false;
  Row row_;
  bool waiting_ = false;  // row_ is of the next step
};

}  // namespace hapsim
