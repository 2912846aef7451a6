// What a tool has found, for people and for programs: one grammar for all tools.
#pragma once

#include <limits>
#include <string>
#include <vector>

namespace hapsim {

struct SummaryItem {
  std::string label;               // "MISSING"
  std::string name;                // "friction"; "": the first fact stands beside the label
  std::string chance;              // at the right: "false alarm p < 0.001"
  std::vector<std::string> facts;  // a paragraph each
};

// A number that the sentences tell, as it is: not finite where nothing is known.
struct SummaryValue {
  std::string name;  // "error", "elastic.E", "elastic.E[2]" of region 2
  double value = std::numeric_limits<double>::quiet_NaN();
  std::string unit;  // of SI, "1" of a ratio or count
  double std_error = std::numeric_limits<double>::quiet_NaN();
};

struct Summary {
  enum class Mark { kGood, kBad, kOpen };
  Mark mark = Mark::kGood;
  std::string verdict;  // "a.csv: something is missing"
  std::string size;     // at the right: "error 0.073 N = 7 x noise"
  std::vector<SummaryItem> items;
  std::vector<std::string> notes;    // a paragraph each
  std::string next;                  // a command, in one line so that it can be copied; "" for none
  std::string details;               // where everything else stands
  std::vector<SummaryValue> values;  // for programs alone
};

// The verdict first; nothing but the command is wider than kTextWidth.
std::vector<std::string> summary_lines(const Summary& summary);

// The same as JSON text (two spaces of indent, a newline at the end), with the numbers as numbers
// and null where one is not known: share/schemas/summary.schema.json.
std::string summary_json(const Summary& summary, const std::string& tool);

}  // namespace hapsim
