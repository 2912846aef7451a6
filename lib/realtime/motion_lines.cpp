#include "realtime/motion_lines.h"

#include <algorithm>
#include <charconv>
#include <climits>
#include <cmath>

#include "base/error.h"
#include "io/number.h"

namespace hapsim {
namespace {

constexpr std::array<const char*, 13> kNames{"press", "t",       "x",    "y",  "z",  "ux", "uy",
                                             "uz",    "contact", "temp", "fx", "fy", "fz"};

void append(std::string& buffer, double value) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, value).ptr;
  buffer.append(text, end);
}

}  // namespace

MotionLines::MotionLines(CsvReader csv, std::string name, bool forces)
    : csv_(std::move(csv)), name_(std::move(name)) {
  const auto& header = csv_.header();
  std::array<bool, kColumns> present{};
  for (const std::string& column : header) {
    const auto known = forces ? kNames.end() : kNames.begin() + kFx;
    const auto found = std::find(kNames.begin(), known, column);
    meaning_.push_back(found == known ? kColumns : static_cast<int>(found - kNames.begin()));
    if (found != known) present[static_cast<std::size_t>(meaning_.back())] = true;
    if (column == "tool_id") id_column_ = static_cast<int>(meaning_.size()) - 1;
  }
  known_ = present[kUx] || present[kUy] || present[kUz] || present[kPress];
  warm_ = present[kTemp];
  for (std::size_t k = 0; k < kColumns; ++k) {
    const bool force = k >= kFx;
    const bool needed = force ? forces : known_ ? k != kContact && k != kTemp : k >= kT && k <= kZ;
    if (needed && !present[k])
      fail_missing_column(name_, kNames[k], header, {kNames.begin(), kNames.end()});
  }
}

void MotionLines::require_contact_points(const std::string& columns) const {
  if (!known_) fail_input(name_, "there are no contact points", "give " + columns);
}

std::size_t MotionLines::tool_of(std::string_view id) {
  const auto found = std::find(ids_.begin(), ids_.end(), id);
  if (found != ids_.end()) return static_cast<std::size_t>(found - ids_.begin());
  if (ids_.size() == most_tools_)
    fail_input(csv_.where(), "tool_id " + shown(id) + " is one tool more than there may be",
               most_tools_ == 1 ? "send the lines of one tool; hs-simulate --live takes several"
                                : "send the lines of up to four");
  ids_.emplace_back(id);
  checks_.push_back(check_);  // as within() has made it
  presses_.push_back(0);
  return ids_.size() - 1;
}

bool MotionLines::next(MotionLine& line) {
  if (!csv_.next(fields_)) return false;
  value_[kContact] = 1;
  for (std::size_t c = 0; c < fields_.size(); ++c) {
    const auto k = static_cast<std::size_t>(meaning_[c]);
    if (k == kColumns || parse_number(fields_[c], value_[k])) continue;
    fail_input(csv_.where(), std::string(kNames[k]) + " is " + shown(fields_[c]),
               "write a finite number");
  }
  line.has_contact_point = known_;
  if (id_column_ >= 0) tool_ = tool_of(fields_[static_cast<std::size_t>(id_column_)]);
  line.t = value_[kT];
  line.point = {value_[kX], value_[kY], value_[kZ]};
  line.u = {value_[kUx], value_[kUy], value_[kUz]};
  line.in_air = value_[kContact] == 0;
  if (warm_) line.temperature = value_[kTemp];
  if (known_) {
    if (std::abs(value_[kPress]) > INT_MAX || value_[kPress] != std::floor(value_[kPress]))
      fail_input(csv_.where(), "press is " + format_number(value_[kPress]) + ", not an integer",
                 "number the contact episodes 1, 2, 3");
    line.press = static_cast<int>(value_[kPress]);
  }
  if (id_column_ >= 0) {
    presses_[tool_] = !line.in_air && !line.u.isZero() ? 1 : 0;
    alone_ = std::count(presses_.begin(), presses_.end(), 1) <= 1;
  }
  MotionCheck& check = id_column_ < 0 ? check_ : checks_[tool_];
  check.check(line, [this] { return csv_.where(); });
  return true;
}

void MotionLines::write_force(std::string& buffer, const MotionLine& line,
                              const Vec3& force) const {
  write_force_line(buffer, line, force);
  buffer.pop_back();
  buffer += ',';
  append(buffer, line.beyond);
  if (warm_) {
    buffer += ',';
    append(buffer, line.temperature);
  }
  if (uncertain_) {
    buffer += ',';
    append(buffer, line.uncertainty);
  }
  buffer += '\n';
}

std::vector<std::string> MotionLines::force_columns() const {
  std::vector<std::string> columns = kForceColumns;
  columns.emplace_back("beyond");
  if (warm_) columns.emplace_back("temp");
  if (uncertain_) columns.emplace_back("uncertainty");
  return columns;
}

void write_force_line(std::string& buffer, const MotionLine& line, const Vec3& force) {
  buffer.clear();
  append(buffer, line.press);
  buffer += ',';
  append(buffer, line.t);
  for (const Vec3* v : {&line.point, &line.u, &force})
    for (int k = 0; k < 3; ++k) {
      buffer += ',';
      append(buffer, (*v)[k] == 0 ? 0.0 : (*v)[k]);  // no minus zero
    }
  buffer += line.in_air ? ",0\n" : ",1\n";
}

void MotionLines::write_hand_force(std::string& buffer, const MotionLine& line, const Vec3& force,
                                   int safety, const Vec3& asked) const {
  write_force(buffer, line, force);
  buffer.pop_back();
  buffer += ',' + std::to_string(safety);
  append_columns(buffer, asked);
  buffer += '\n';
}

void append_columns(std::string& row, const Vec3& v) {
  for (int k = 0; k < 3; ++k) row += ',' + format_number(v[k] == 0 ? 0.0 : v[k]);
}

}  // namespace hapsim
