#include <cstdint>

#include "cli/help.h"
#include "cli/spec_text.h"

namespace hapsim {
namespace {

constexpr std::size_t kWidth = 78;  // leaves room for an escape at the beginning of a line

// Text for roff: backslashes, hyphens and what is not ASCII escaped.
std::string escaped(const std::string& text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto c = static_cast<unsigned char>(text[i]);
    if (c == '\\') {
      result += "\\e";
    } else if (c == '-') {
      result += "\\-";
    } else if (c == '\n') {
      result += ' ';
    } else if (c < 0x80) {
      result += text[i];
    } else {
      const int more = c >= 0xf0 ? 3 : c >= 0xe0 ? 2 : 1;
      std::uint32_t code = c & (0x3f >> more);
      for (int k = 0; k < more && i + 1 < text.size(); ++k)
        code = code << 6 | (static_cast<unsigned char>(text[++i]) & 0x3f);
      char hex[16];
      std::snprintf(hex, sizeof hex, "\\[u%04X]", static_cast<unsigned>(code));
      result += hex;
    }
  }
  return result;
}

// Text in lines of at most 80 bytes; a line that begins with a control character must not become a
// request.
std::string filled(const std::string& text) {
  std::string result, line;
  const auto end_line = [&] {
    if (!line.empty() && (line[0] == '.' || line[0] == '\'')) result += "\\&";
    result += line + "\n";
    line.clear();
  };
  const std::string body = escaped(text);
  for (std::size_t start = 0; start < body.size();) {
    const std::size_t end = std::min(body.find(' ', start), body.size());
    if (!line.empty() && line.size() + 1 + end - start > kWidth) end_line();
    if (end > start) line += (line.empty() ? "" : " ") + body.substr(start, end - start);
    start = end + 1;
  }
  end_line();
  return result;
}

std::string entry(const std::string& term, const std::string& text) {
  return ".TP\n" + term + "\n" + filled(text);
}

std::string bold(const std::string& text) {
  return "\\fB" + escaped(text) + "\\fR";
}
std::string italic(const std::string& text) {
  return "\\fI" + escaped(text) + "\\fR";
}

std::string upper(std::string text) {
  for (char& c : text)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  return text;
}

std::string option_term(const Option& option) {
  const std::string brief = short_flag(option.name());
  std::string term = brief.empty() ? "" : bold(brief.substr(0, 2)) + ", ";
  term += bold(option.name());
  return option.value.empty() ? term : term + " " + italic(option.value);
}

}  // namespace

std::string man_page(const ToolSpec& spec) {
  std::string page = ".TH " + upper(spec.name) + " 1 " + HAPSIM_DATE + " \"hapsim " + version() +
                     "\" \"hapsim manual\"\n";
  page += ".SH NAME\n" + escaped(spec.name) + " \\- " + escaped(spec.summary) + "\n";
  page += ".SH SYNOPSIS\n" + bold(spec.name) + " " + escaped(synopsis(spec)) + "\n";
  page += ".SH DESCRIPTION\n";
  bool first = true;
  const auto add_paragraph = [&](const std::string& text) {
    page += (first ? "" : ".PP\n") + filled(text);
    first = false;
  };
  if (spec.description.empty()) add_paragraph(spec.summary);
  for (const std::string& text : spec.description) add_paragraph(text);
  if (!spec.input.empty()) add_paragraph("Input: " + input_text(spec));
  page += ".SH OPTIONS\n";
  std::string group;
  for (const Option& option : all_options(spec)) {
    if (option.group != group) page += ".SS " + escaped(option.group) + "\n";
    group = option.group;
    page += entry(option_term(option), full_help(option));
  }
  if (!spec.tables.empty()) page += ".SH COLUMNS\n";
  for (const auto& [title, rows] : spec.tables) {
    page += ".SS " + escaped(title) + "\n";
    for (const auto& [column, meaning] : rows) page += entry(bold(column), meaning);
  }
  page += ".SH EXIT STATUS\n";
  for (const auto& [code, meaning] : kExitCodes) page += entry(bold(code), meaning);
  if (!spec.examples.empty()) page += ".SH EXAMPLES\n";
  for (const Example& example : spec.examples)
    page += entry(bold(example.command), example.explanation);
  if (!spec.see_also.empty()) {
    page += ".SH SEE ALSO\n";
    for (std::size_t i = 0; i < spec.see_also.size(); ++i) {
      const std::string& name = spec.see_also[i];
      const std::size_t bracket = std::min(name.find('('), name.size());
      page += ".BR " + escaped(name.substr(0, bracket)) + " " + escaped(name.substr(bracket)) +
              (i + 1 < spec.see_also.size() ? "," : "") + "\n";
    }
  }
  return page;
}

}  // namespace hapsim
