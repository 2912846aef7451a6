// What a tool has found, for people: one grammar for all tools.
#pragma once

#include <string>
#include <vector>

#include "cli/tool.h"

namespace hapsim {

struct SummaryItem {
  std::string label;               // "MISSING"
  std::string name;                // "friction"
  std::string chance;              // at the right: "false alarm p < 0.001"
  std::vector<std::string> facts;  // a paragraph each
};

struct Summary {
  enum class Mark { kGood, kBad, kOpen };
  Mark mark = Mark::kGood;
  std::string verdict;  // "a.csv: something is missing"
  std::string size;     // at the right: "error 0.073 N = 7 x noise"
  std::vector<SummaryItem> items;
  std::vector<std::string> notes;  // a paragraph each
  std::string next;                // a command, in one line so that it can be copied; "" for none
  std::string details;             // where everything else stands
};

// The verdict first; nothing but the command is wider than kTextWidth.
std::vector<std::string> summary_lines(const Summary& summary);

// The last line alone, of a tool that says the rest in sentences; nothing for "".
void say_next(const Arguments& arguments, const std::string& command);

// On standard error, unless --quiet; the verdict in colour on a terminal.
void say_summary(const Arguments& arguments, const Summary& summary);

}  // namespace hapsim
