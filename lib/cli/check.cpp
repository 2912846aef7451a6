#include "cli/check.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>

#include "base/error.h"
#include "base/nearest.h"
#include "cli/spec_text.h"
#include "io/extension.h"
#include "io/number.h"
#include "io/quantity.h"
#include "io/require_output.h"

namespace hapsim {
namespace {

constexpr const char* kPrefix = "PREFIX";  // value of an option whose outputs begin alike
constexpr double kLargestInteger = 9007199254740992;  // 2^53: every integer up to it is a double

void check_number(const Option& option, const std::string& text) {
  const bool whole = option.kind() == OptionKind::kInteger;
  double value;
  if (!parse_number(text, value))
    fail_usage(option.name() + " is " + shown(text) + ", not a number",
               whole ? "give a whole number" : "give a number such as 0.5 or 1e-3");
  if (whole && (value != std::floor(value) || std::abs(value) > kLargestInteger))
    fail_usage(option.name() + " is " + shown(text), "give a whole number");
  if (value < option.minimum || value > option.maximum)
    fail_usage(option.name() + " is " + text, "give a number " + bounds_text(option));
}

void check_choice(const Option& option, const std::string& text) {
  if (std::find(option.choices.begin(), option.choices.end(), text) != option.choices.end()) return;
  std::string known;
  for (const std::string& choice : option.choices) known += (known.empty() ? "" : " ") + choice;
  const std::string near = nearest(text, option.choices);
  fail_usage(option.name() + " is " + shown(text),
             (near.empty() ? "" : "did you mean '" + near + "'? ") + "known are: " + known);
}

// Extensions by which people and programs know a format.
bool promises_format(const std::string& extension) {
  static const std::set<std::string> known{
      "asc", "bin",  "csv", "dat", "ele", "feb", "gz",   "htm", "html", "inp",  "json", "mat",
      "msh", "node", "obj", "ods", "off", "pcd", "pdf",  "ply", "png",  "pts",  "scn",  "stl",
      "svg", "tsv",  "txt", "vtk", "vtu", "xls", "xlsx", "xml", "xyz",  "yaml", "zip"};
  return known.count(extension) != 0;
}

// A name that promises another format than is written is refused; one that promises none is a name.
void check_extension(const Option& option, const std::string& text) {
  const std::string extension = extension_of(text);
  const auto& known = option.writes;
  if (extension.empty() || std::find(known.begin(), known.end(), extension) != known.end()) return;
  if (!promises_format(extension)) return;
  std::string list;
  for (std::size_t i = 0; i < known.size(); ++i)
    list += (i == 0 ? "." : i + 1 == known.size() ? " or ." : ", .") + known[i];
  fail_usage(option.name() + " is " + shown(text) + ", and this is not written as ." + extension,
             "end the name in " + list);
}

// Standard output, and what takes many outputs one after the other: a device, a pipe.
bool is_no_file(const std::string& name) {
  std::error_code absent;
  const auto status = std::filesystem::status(name, absent);
  return name == "-" ||
         (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status));
}

}  // namespace

void check_value(const Option& option, const std::string& text) {
  if (text.empty())
    fail_usage("a value of " + option.name() + " is empty", "give a value " + option.value);
  if (is_number(option)) check_number(option, text);
  if (option.kind() == OptionKind::kChoice) check_choice(option, text);
  if (option.kind() == OptionKind::kFile && !option.writes.empty()) check_extension(option, text);
}

std::string in_si(const Option& option, const std::string& text) {
  const std::vector<Quantity> quantities = quantities_of(option);
  double value;
  if (quantities.empty() || text.empty() || parse_number(text, value)) return text;
  if (is_number(option)) return format_number(parse_quantity(text, quantities[0], option.name()));
  return list_in_si(text, quantities, option.name());
}

void check_outputs(const ToolSpec& spec, const Arguments& arguments) {
  std::map<std::filesystem::path, std::string> flag_of;
  for (const Option& option : all_options(spec)) {
    if (option.kind() != OptionKind::kFile) continue;
    if (option.writes.empty() && option.value != kPrefix) continue;
    for (const std::string& name : arguments.list(option.flag)) {
      require_output(option.value == kPrefix ? name + "0" : name);
      if (option.value == kPrefix || is_no_file(name)) continue;
      std::error_code no_path;  // then nothing lies there yet
      std::filesystem::path path = std::filesystem::absolute(name, no_path);
      if (!no_path) path = std::filesystem::weakly_canonical(path, no_path);
      if (no_path) path = name;
      const auto [other, fresh] = flag_of.try_emplace(path, option.name());
      if (!fresh)
        fail_usage((other->second == option.name()
                        ? option.name() + " twice writes "
                        : option.name() + " and " + other->second + " both write ") +
                       shown(name),
                   "the second would replace the first: give each a name of its own");
    }
  }
}

}  // namespace hapsim
