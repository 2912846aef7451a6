#include "cli/spec_text.h"

#include <algorithm>

#include "io/number.h"
#include "io/quantity.h"

namespace hapsim {
namespace {

constexpr double kUnbounded = 1e300;

std::string joined(const std::vector<std::string>& words, const char* between) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : between) + word;
  return text;
}

// "A length from 0 to 1 m, as 0.004 or 4mm".
std::string quantity_text(const Option& option) {
  const QuantityWords& words = words_of(quantities_of(option).front());
  if (option.kind() == OptionKind::kPose) return "In m and rad, or with units, as 4mm and 30deg";
  if (!is_number(option))
    return std::string("In ") + words.unit + ", or with a unit, as " + words.example;
  const std::string bounds = bounds_text(option);
  return std::string("A ") + words.name + " " +
         (bounds.empty() ? std::string("in ") + words.unit : bounds) + ", as " + words.example;
}

void add_sentence(std::string& text, const std::string& sentence) {
  if (sentence.empty()) return;
  if (!text.empty()) {
    const char last = text.back();
    text += last == '.' || last == '?' || last == ':' ? " " : ". ";
  }
  text += sentence;
}

}  // namespace

const std::array<std::pair<const char*, const char*>, 6> kExitCodes{{
    {"0", "done"},
    {"1", "done, and the check that was asked for says no"},
    {"2", "wrong usage: flags unknown, contradictory or naming what is not there"},
    {"3", "bad input: a file holds what cannot be used or lacks what is asked"},
    {"4", "no convergence, or another numerical failure"},
    {"5", "reading or writing failed"},
}};

bool is_number(const Option& option) {
  return option.kind() == OptionKind::kNumber || option.kind() == OptionKind::kInteger ||
         (quantities_of(option).size() == 1 && option.kind() != OptionKind::kLengths &&
          option.kind() != OptionKind::kTimes);
}

std::vector<Quantity> quantities_of(const Option& option) {
  switch (option.kind()) {
    case OptionKind::kLength:
    case OptionKind::kLengths:
      return {Quantity::kLength};
    case OptionKind::kTime:
    case OptionKind::kTimes:
      return {Quantity::kTime};
    case OptionKind::kForce:
      return {Quantity::kForce};
    case OptionKind::kPressure:
      return {Quantity::kPressure};
    case OptionKind::kPose:
      return {Quantity::kLength, Quantity::kLength, Quantity::kLength, Quantity::kAngle};
    default:
      return {};
  }
}

std::vector<Option> all_options(const ToolSpec& spec) {
  constexpr const char *kOutput = "Output", *kGeneral = "General";
  std::vector<std::string> groups;
  for (const Option& option : spec.options)
    if (std::find(groups.begin(), groups.end(), option.group) == groups.end())
      groups.push_back(option.group);
  const bool grouped = groups.size() > 1 || (groups.size() == 1 && !groups[0].empty());
  const bool has_output = std::find(groups.begin(), groups.end(), kOutput) != groups.end();
  std::erase(groups, kGeneral);
  if (grouped) groups.emplace_back(kGeneral);
  const std::string general = grouped ? kGeneral : "";

  std::vector<Option> options = spec.options;
  options.push_back(
      {.flag = flag::output,
       .value = "FILE",
       .help = "Write the result to FILE, complete or not at all; - is standard output.",
       .group = has_output ? kOutput : general,
       .writes = spec.writes,
       .default_text = "-"});
  for (const auto& [one, help] :
       {std::pair{flag::quiet, "Print errors only."},
        std::pair{flag::verbose, "Print more about what is done."},
        std::pair{flag::help, "Print this help; -h prints a screen of it."},
        std::pair{flag::man, "Print the manual page."},
        std::pair{flag::version, "Print the version; with -v the BLAS in use, too."}})
    options.push_back({.flag = one, .help = help, .group = general});
  const auto place = [&groups](const Option& option) {
    return std::find(groups.begin(), groups.end(), option.group);
  };
  std::stable_sort(options.begin(), options.end(),
                   [&](const Option& a, const Option& b) { return place(a) < place(b); });
  return options;
}

std::string short_flag(const std::string& flag) {
  if (flag == "--output") return "-o,";
  if (flag == "--quiet") return "-q,";
  if (flag == "--verbose") return "-v,";
  if (flag == "--help") return "-h,";
  if (flag == "--version") return "-V,";
  return "";
}

bool is_flag(const std::string& word, const Option& option) {
  return word == option.name() || (word.size() == 2 && word + "," == short_flag(option.name()));
}

std::string bounds_text(const Option& option) {
  const std::vector<Quantity> quantities = quantities_of(option);
  const std::string unit =
      quantities.empty() ? "" : std::string(" ") + words_of(quantities.front()).unit;
  const bool below = option.minimum > -kUnbounded, above = option.maximum < kUnbounded;
  if (below && above)
    return "from " + format_number(option.minimum) + " to " + format_number(option.maximum) + unit;
  if (below) return "of at least " + format_number(option.minimum) + unit;
  if (above) return "of at most " + format_number(option.maximum) + unit;
  return "";
}

std::string full_help(const Option& option) {
  std::string text = option.help;
  if (option.kind() == OptionKind::kChoice)
    add_sentence(text, "One of: " + joined(option.choices, ", ") + ".");
  if (!quantities_of(option).empty())
    add_sentence(text, quantity_text(option) + ".");
  else if (is_number(option) && !bounds_text(option).empty())
    add_sentence(text, (option.kind() == OptionKind::kInteger ? "A whole number " : "A number ") +
                           bounds_text(option) + ".");
  if (option.repeatable)
    add_sentence(text, option.kind() == OptionKind::kFile
                           ? "May be repeated."
                           : "May be repeated, or given a list separated by commas.");
  if (!option.writes.empty())
    add_sentence(text, "Extensions: " + joined(option.writes, ", ") + ".");
  if (option.required) add_sentence(text, "Required.");
  if (!option.default_text.empty()) add_sentence(text, "Default: " + option.default_text + ".");
  return text;
}

std::string synopsis(const ToolSpec& spec) {
  std::string text = "[OPTIONS]";
  for (const Option& option : spec.options)
    if (option.required) text += " " + option.name() + " " + option.value;
  return text + (spec.input.empty() ? "" : " [INPUT]");
}

std::string input_text(const ToolSpec& spec) {
  std::string text = spec.input;
  add_sentence(text,
               spec.input_optional ? "- is standard input." : "Standard input when absent or -.");
  return text;
}

}  // namespace hapsim
