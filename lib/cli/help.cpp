#include "cli/help.h"

#include <algorithm>

#include "cli/spec_text.h"
#include "cli/tool_list.h"
#include "cli/wrap.h"

namespace hapsim {
namespace {

constexpr std::size_t kTerm = 26;  // column in which explanations begin

std::string paragraph(const std::string& text, std::size_t indent) {
  return std::string(indent, ' ') + wrapped(text, indent, indent);
}

std::string entry(const std::string& term, const std::string& text) {
  std::string line = "  " + term;
  if (columns(line) + 2 > kTerm)
    line += '\n' + std::string(kTerm, ' ');
  else
    line += std::string(kTerm - columns(line), ' ');
  return line + wrapped(text, kTerm, kTerm);
}

std::string usage(const ToolSpec& spec) {
  const std::size_t indent = 8 + spec.name.size();
  return "\nUsage: " + spec.name + " " + wrapped(synopsis(spec), indent, indent);
}

std::string term_of(const Option& option) {
  return option.name() + (option.value.empty() ? "" : " " + option.value);
}

// Up to a mark that ends a sentence or a part of it: a dot in a name, as of .inp, does not.
std::string first_sentence(const std::string& text) {
  for (std::size_t end = 0; (end = text.find_first_of(".;:", end)) != text.npos; ++end)
    if (end + 1 == text.size() || text[end + 1] == ' ') return text.substr(0, end) + ".";
  return text;
}

// Of those that are not required; each stays on one line.
std::string names_by_group(const ToolSpec& spec) {
  std::string text, group = "-", line;
  std::size_t at = 0;
  for (const Option& option : all_options(spec)) {
    if (option.required) continue;
    if (option.group != group) {
      group = option.group;
      line = "  " + (group.empty() ? "" : group + ": ");
      text += (text.empty() ? "" : "\n") + line;
      at = columns(line);
      line.clear();
    }
    const std::string term = short_flag(option.name()) + option.name();
    if (at + 1 + columns(term) > kTextWidth) {
      text += "\n    ";
      at = 4;
      line.clear();
    }
    text += (line.empty() ? "" : " ") + term;
    at += columns(term) + (line.empty() ? 0 : 1);
    line = term;
  }
  return text + "\n";
}

}  // namespace

std::string short_help_text(const ToolSpec& spec) {
  constexpr std::size_t kMostExamples = 3;
  std::string text = paragraph(spec.name + ": " + spec.summary, 0) + usage(spec) + "\n";
  if (!spec.input.empty()) text += entry("INPUT", input_text(spec));
  for (const Option& option : spec.options)
    if (option.required) text += entry(term_of(option), first_sentence(option.help));
  text += "\nOptions:\n" + names_by_group(spec);
  if (!spec.examples.empty()) text += "\nExamples:\n";
  for (std::size_t k = 0; k < std::min(kMostExamples, spec.examples.size()); ++k)
    text += "  " + spec.examples[k].command + "\n";
  return text + "\nWhat each option does: " + spec.name + " --help, or man " + spec.name + "\n";
}

std::string help_text(const ToolSpec& spec) {
  std::string text = paragraph(spec.name + ": " + spec.summary, 0);
  text += usage(spec);
  for (const std::string& p : spec.description) text += "\n" + paragraph(p, 0);
  if (!spec.input.empty()) text += "\nInput:\n" + paragraph(input_text(spec), 2);
  std::string group = "-";
  for (const Option& option : all_options(spec)) {
    if (option.group != group) {
      group = option.group;
      text += group.empty() ? "\nOptions:\n" : "\nOptions, " + group + ":\n";
    }
    std::string term = short_flag(option.name());
    term += (term.empty() ? "" : " ") + term_of(option);
    text += entry(term, full_help(option));
  }
  for (const auto& [title, rows] : spec.tables) {
    text += "\n" + paragraph(title + ":", 0);
    for (const auto& [column, meaning] : rows) text += entry(column, meaning);
  }
  if (!spec.examples.empty()) text += "\nExamples:\n";
  for (const Example& example : spec.examples) {
    text += "  " + example.command + "\n";  // never wrapped, so that it can be copied
    text += paragraph(example.explanation, 6);
  }
  text += "\nExit codes:\n";
  for (const auto& [code, meaning] : kExitCodes)
    text += "  " + std::string(code) + "  " + meaning + "\n";
  if (!spec.see_also.empty()) {
    std::string pages;
    for (const std::string& page : spec.see_also) pages += (pages.empty() ? "" : ", ") + page;
    text += "\nSee also:\n" + paragraph(pages, 2);
  }
  return text;
}

std::string about_text(const ToolSpec& spec) {
  std::string summary;
  for (const char c : spec.summary)
    summary += c == '"' || c == '\\' ? std::string{'\\', c} : std::string(1, c);
  return "{" + task_name(spec.task) + ", \"" + spec.name + "\", \"" + summary + "\"},\n";
}

}  // namespace hapsim
