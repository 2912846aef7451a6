#include "realtime/tool_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <climits>
#include <cmath>

#include "base/error.h"
#include "io/number.h"

namespace hapsim {
namespace {

constexpr std::array<const char*, 13> kToolColumns{
    "press", "t", "x", "y", "z", "ux", "uy", "uz", "thx", "thy", "thz", "contact", "temp"};
constexpr const char* kToolId = "tool_id";

bool is_turn(std::string_view name) {
  return name == "thx" || name == "thy" || name == "thz";
}

void append_value(std::string& buffer, double value) {
  char text[32];
  buffer.append(text, std::to_chars(text, text + sizeof text, value == 0 ? 0.0 : value).ptr);
}
void append_values(std::string& buffer, const Vec3& v) {
  for (int k = 0; k < 3; ++k) {
    buffer += ',';
    append_value(buffer, v[k]);
  }
}

}  // namespace

bool ToolLines::serves(const std::vector<std::string>& header) {
  return std::any_of(header.begin(), header.end(),
                     [](const std::string& name) { return name == kToolId || is_turn(name); });
}

ToolLines::ToolLines(CsvReader csv, std::string name, std::size_t tools)
    : csv_(std::move(csv)), name_(std::move(name)) {
  const auto& header = csv_.header();
  std::array<bool, kColumns> present{};
  for (std::size_t c = 0; c < header.size(); ++c) {
    const auto found = std::find(kToolColumns.begin(), kToolColumns.end(), header[c]);
    meaning_.push_back(static_cast<int>(found - kToolColumns.begin()));
    if (found != kToolColumns.end()) present[static_cast<std::size_t>(meaning_.back())] = true;
    if (header[c] == kToolId) id_column_ = static_cast<int>(c);
  }
  known_ = present[kUx] || present[kUy] || present[kUz] || present[kPress];
  warm_ = present[kTemp];
  turns_ = present[kThx] || present[kThy] || present[kThz];
  for (int k = 0; k < kColumns; ++k) {
    const bool needed = k >= kThx && k <= kThz                  ? turns_
                        : k == kContact || k == kTemp           ? false
                        : k == kPress || (k >= kUx && k <= kUz) ? known_
                                                                : true;
    if (needed && !present[k])
      fail_missing_column(name_, kToolColumns[k], header,
                          {kToolColumns.begin(), kToolColumns.end()});
  }
  if (id_column_ < 0) {
    if (tools > 1)
      fail_input(name_, fmt::format("there are {} tools, and no column {}", tools, kToolId),
                 "say of each line which tool it is of");
    counted_ = true;
    return;
  }
  if (tools == 0)
    if (const auto said = csv_.metadata().number("tools", name_)) {
      if (!(*said >= 1 && *said <= kMostTools && *said == std::floor(*said)))
        fail_input(name_, "tools is " + format_number(*said),
                   fmt::format("from 1 to {} tools press a body at once", kMostTools));
      tools = static_cast<std::size_t>(*said);
    }
  counted_ = tools > 0;
  tools_ = counted_ ? tools : kMostTools;
}

std::size_t ToolLines::tool_of(std::string_view id) {
  for (std::size_t k = 0; k < known_ids_; ++k)
    if (ids_[k] == id) return k;
  if (known_ids_ == tools_)
    fail_input(csv_.where(), fmt::format("{} is one tool more than {}", shown(id), tools_),
               fmt::format("up to {} press a body at once; say how many with --tools", kMostTools));
  ids_[known_ids_] = id;
  return known_ids_++;
}

bool ToolLines::read_row() {
  if (!csv_.next(fields_)) return false;
  value_[kContact] = 1;
  for (std::size_t c = 0; c < fields_.size(); ++c) {
    const int k = meaning_[c];
    if (k == kColumns || parse_number(fields_[c], value_[k])) continue;
    fail_input(csv_.where(), std::string(kToolColumns[k]) + " is " + shown(fields_[c]),
               "write a finite number");
  }
  row_.tool = id_column_ < 0 ? 0 : tool_of(fields_[static_cast<std::size_t>(id_column_)]);
  row_.t = value_[kT];
  if (warm_) row_.temperature = value_[kTemp];
  ToolPose& pose = row_.pose;
  pose.point = {value_[kX], value_[kY], value_[kZ]};
  pose.u = {value_[kUx], value_[kUy], value_[kUz]};
  pose.turn = {value_[kThx], value_[kThy], value_[kThz]};
  pose.in_air = value_[kContact] == 0;
  if (known_) {
    if (std::abs(value_[kPress]) > INT_MAX || value_[kPress] != std::floor(value_[kPress]))
      fail_input(csv_.where(), "press is " + format_number(value_[kPress]) + ", not an integer",
                 "number the contact episodes 1, 2, 3");
    pose.press = static_cast<int>(value_[kPress]);
  }
  return true;
}

bool ToolLines::joins(const ToolStep& step, std::size_t rows) const {
  return rows == 0 || (!step.present[row_.tool] && row_.t == step.t);
}

bool ToolLines::next(ToolStep& step) {
  step.present.fill(0);
  for (ToolPose& pose : step.pose) {  // of those of which nothing comes
    pose.in_air = true;
    pose.point.setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  step.rows = 0;
  while (!counted_ || step.rows < tools_) {
    if (!waiting_ && !read_row()) break;
    waiting_ = !joins(step, step.rows);
    if (waiting_) {
      if (counted_)
        fail_input(csv_.where(), fmt::format("a step has {} of {} tools", step.rows, tools_),
                   "give every time one line of each tool");
      break;
    }
    step.t = row_.t;
    if (warm_) step.temperature = row_.temperature;
    step.pose[row_.tool] = row_.pose;
    step.present[row_.tool] = 1;
    step.order[step.rows++] = row_.tool;
    check(row_.tool, step, [this] { return csv_.where(); });
    if (id_column_ < 0) break;
  }
  return step.rows > 0 && (!counted_ || step.rows == tools_);
}

std::vector<std::string> ToolLines::columns() const {
  std::vector<std::string> names{"press", "t"};
  const auto add = [&](bool present, std::initializer_list<const char*> more) {
    if (present) names.insert(names.end(), more.begin(), more.end());
  };
  add(id_column_ >= 0, {kToolId});
  add(true, {"x", "y", "z", "ux", "uy", "uz"});
  add(turns_, {"thx", "thy", "thz"});
  add(true, {"fx", "fy", "fz"});
  add(turns_, {"tqx", "tqy", "tqz"});
  add(true, {"contact", "beyond"});
  add(warm_, {"temp"});
  add(uncertain_, {"uncertainty"});
  add(hand_, {"safety", "ax", "ay", "az"});
  add(hand_ && turns_, {"atqx", "atqy", "atqz"});
  return names;
}

void ToolLines::write(std::string& buffer, const ToolStep& step,
                      std::span<const ToolFeel> feel) const {
  buffer.clear();
  for (std::size_t r = 0; r < step.rows; ++r) {
    const ToolFeel& f = feel[step.order[r]];
    append_value(buffer, f.press);
    buffer += ',';
    append_value(buffer, step.t);
    if (id_column_ >= 0) {
      buffer += ',';
      buffer += ids_[step.order[r]];
    }
    append_values(buffer, f.point);
    append_values(buffer, f.u);
    if (turns_) append_values(buffer, f.turn);
    append_values(buffer, f.force);
    if (turns_) append_values(buffer, f.torque);
    buffer += f.in_air ? ",0," : ",1,";
    append_value(buffer, f.beyond);
    if (warm_) {
      buffer += ',';
      append_value(buffer, step.temperature);
    }
    if (uncertain_) {
      buffer += ',';
      append_value(buffer, f.uncertainty);
    }
    if (hand_) {
      buffer += ',';
      append_value(buffer, f.safety);
      append_values(buffer, f.asked_force);
      if (turns_) append_values(buffer, f.asked_torque);
    }
    buffer += '\n';
  }
}

}  // namespace hapsim
