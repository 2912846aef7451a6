#include "cli/spec_text.h"

#include "io/number.h"

namespace hapsim {
namespace {

constexpr double kUnbounded = 1e300;

std::string joined(const std::vector<std::string>& words, const char* between) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : between) + word;
  return text;
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

std::vector<Option> all_options(const ToolSpec& spec) {
  std::vector<Option> options = spec.options;
  const auto add = [&](const char* flag, const char* help) {
    Option option;
    option.flag = flag;
    option.kind = OptionKind::kSwitch;
    option.help = help;
    options.push_back(option);
  };
  Option output;
  output.flag = "--output";
  output.kind = OptionKind::kFile;
  output.value = "FILE";
  output.help = "Write the result to FILE, complete or not at all; - is standard output.";
  output.default_text = "-";
  output.writes = spec.writes;
  options.push_back(output);
  add("--quiet", "Print errors only.");
  add("--verbose", "Print more about what is done.");
  add("--help", "Print this help.");
  add("--man", "Print the manual page.");
  add("--version", "Print the version.");
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
  return word == option.flag || (word.size() == 2 && word + "," == short_flag(option.flag));
}

std::string bounds_text(const Option& option) {
  const bool below = option.minimum > -kUnbounded, above = option.maximum < kUnbounded;
  if (below && above)
    return "from " + format_number(option.minimum) + " to " + format_number(option.maximum);
  if (below) return "of at least " + format_number(option.minimum);
  if (above) return "of at most " + format_number(option.maximum);
  return "";
}

std::string full_help(const Option& option) {
  std::string text = option.help;
  const bool number = option.kind == OptionKind::kNumber || option.kind == OptionKind::kInteger;
  if (option.kind == OptionKind::kChoice)
    add_sentence(text, "One of: " + joined(option.choices, ", ") + ".");
  if (number && !bounds_text(option).empty())
    add_sentence(text, (option.kind == OptionKind::kInteger ? "A whole number " : "A number ") +
                           bounds_text(option) + ".");
  if (option.repeatable)
    add_sentence(text, option.kind == OptionKind::kFile
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
    if (option.required) text += " " + option.flag + " " + option.value;
  return text + (spec.input.empty() ? "" : " [INPUT]");
}

std::string input_text(const ToolSpec& spec) {
  std::string text = spec.input;
  add_sentence(text,
               spec.input_optional ? "- is standard input." : "Standard input when absent or -.");
  return text;
}

}  // namespace hapsim
