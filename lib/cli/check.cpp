#include "cli/check.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "base/error.h"
#include "base/nearest.h"
#include "cli/spec_text.h"
#include "io/extension.h"
#include "io/number.h"

namespace hapsim {
namespace {

constexpr double kLargestInteger = 9007199254740992;  // 2^53: every integer up to it is a double

void check_number(const Option& option, const std::string& text) {
  const bool whole = option.kind == OptionKind::kInteger;
  double value;
  if (!parse_number(text, value))
    fail_usage(option.flag + " is " + shown(text) + ", not a number",
               whole ? "give a whole number" : "give a number such as 0.5 or 1e-3");
  if (whole && (value != std::floor(value) || std::abs(value) > kLargestInteger))
    fail_usage(option.flag + " is " + shown(text), "give a whole number");
  if (value < option.minimum || value > option.maximum)
    fail_usage(option.flag + " is " + text, "give a number " + bounds_text(option));
}

void check_choice(const Option& option, const std::string& text) {
  if (std::find(option.choices.begin(), option.choices.end(), text) != option.choices.end()) return;
  std::string known;
  for (const std::string& choice : option.choices) known += (known.empty() ? "" : " ") + choice;
  const std::string near = nearest(text, option.choices);
  fail_usage(option.flag + " is " + shown(text),
             (near.empty() ? "" : "did you mean '" + near + "'? ") + "known are: " + known);
}

// Extensions by which people and programs know a format.
bool promises_format(const std::string& extension) {
  static const std::set<std::string> known{
      "asc",  "bin", "ele", "feb", "gz",  "htm",  "html", "inp", "json", "mat", "msh",
      "node", "obj", "ods", "off", "pcd", "pdf",  "ply",  "png", "pts",  "scn", "stl",
      "svg",  "tsv", "vtk", "vtu", "xls", "xlsx", "xml",  "xyz", "yaml", "zip"};
  return known.count(extension) != 0;
}

// What a file is to be written as stands in its name, or nowhere.
void check_extension(const Option& option, const std::string& text) {
  const std::string extension = extension_of(text);
  const auto& known = option.writes;
  if (extension.empty() || std::find(known.begin(), known.end(), extension) != known.end()) return;
  if (known.front() == "csv" && !promises_format(extension)) return;
  std::string list;
  for (std::size_t i = 0; i < known.size(); ++i)
    list += (i == 0 ? "." : i + 1 == known.size() ? " or ." : ", .") + known[i];
  fail_usage(option.flag + " is " + shown(text) + ", and this is not written as ." + extension,
             "end the name in " + list);
}

}  // namespace

void check_value(const Option& option, const std::string& text) {
  if (text.empty())
    fail_usage("a value of " + option.flag + " is empty", "give a value " + option.value);
  switch (option.kind) {
    case OptionKind::kNumber:
    case OptionKind::kInteger:
      return check_number(option, text);
    case OptionKind::kChoice:
      return check_choice(option, text);
    case OptionKind::kFile:
      if (!option.writes.empty()) check_extension(option, text);
      return;
    default:
      return;
  }
}

}  // namespace hapsim
