#include "cli/help.h"

#include "cli/spec_text.h"

namespace hapsim {
namespace {

constexpr std::size_t kWidth = 80;
constexpr std::size_t kTerm = 26;  // column in which explanations begin

// Columns that UTF-8 text takes.
std::size_t columns(const std::string& text) {
  std::size_t n = 0;
  for (const char c : text) n += (static_cast<unsigned char>(c) & 0xc0) != 0x80;
  return n;
}

// `text` in lines of at most kWidth, the first one continued from column `at`.
std::string wrapped(const std::string& text, std::size_t indent, std::size_t at) {
  std::string result;
  bool line_begins = true;
  for (std::size_t start = 0; start < text.size();) {
    const std::size_t end = std::min(text.find_first_of(" \n", start), text.size());
    const std::string word = text.substr(start, end - start);
    start = end + 1;
    if (word.empty()) continue;
    if (!line_begins && at + 1 + columns(word) > kWidth) {
      result += '\n' + std::string(indent, ' ');
      at = indent;
      line_begins = true;
    }
    result += (line_begins ? "" : " ") + word;
    at += columns(word) + (line_begins ? 0 : 1);
    line_begins = false;
  }
  return result + '\n';
}

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

}  // namespace

std::string help_text(const ToolSpec& spec) {
  std::string text = paragraph(spec.name + ": " + spec.summary, 0);
  text += "\nUsage: " + spec.name + " " +
          wrapped(synopsis(spec), 8 + spec.name.size(), 8 + spec.name.size());
  for (const std::string& p : spec.description) text += "\n" + paragraph(p, 0);
  if (!spec.input.empty()) text += "\nInput:\n" + paragraph(input_text(spec), 2);
  std::string group = "-";
  for (const Option& option : all_options(spec)) {
    if (option.group != group) {
      group = option.group;
      text += group.empty() ? "\nOptions:\n" : "\nOptions, " + group + ":\n";
    }
    std::string term = short_flag(option.name());
    term += (term.empty() ? "" : " ") + option.name();
    if (!option.value.empty()) term += " " + option.value;
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

}  // namespace hapsim
