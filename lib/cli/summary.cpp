#include "cli/summary.h"

#include <cstdio>
#include <cstring>

#include "cli/wrap.h"

namespace hapsim {
namespace {

constexpr const char* kNext = "Next:  ";
constexpr std::size_t kIndent = 2, kLabel = 9;  // columns before and of an item's label

struct MarkLook {
  const char* sign;
  const char* colour;  // of a terminal
};
MarkLook look_of(Summary::Mark mark) {
  switch (mark) {
    case Summary::Mark::kGood:
      return {"✓", "\033[1;32m"};
    case Summary::Mark::kBad:
      return {"✗", "\033[1;31m"};
    default:
      return {"?", "\033[1;33m"};
  }
}

// Text with `right` at the end of the line, or of the next one where there is no room.
void add_line(std::vector<std::string>& lines, std::string text, const std::string& right) {
  const std::size_t width = columns(right);
  if (right.empty()) {
    lines.push_back(std::move(text));
    return;
  }
  if (columns(text) + 2 + width > kTextWidth) {
    lines.push_back(std::move(text));
    text.clear();
  }
  text += std::string(kTextWidth - columns(text) - width, ' ') + right;
  lines.push_back(std::move(text));
}

void add_paragraph(std::vector<std::string>& lines, const std::string& text, std::size_t indent) {
  std::string rest = std::string(indent, ' ') + wrapped(text, indent, indent);
  for (std::size_t end; (end = rest.find('\n')) != rest.npos; rest.erase(0, end + 1))
    lines.push_back(rest.substr(0, end));
}

}  // namespace

std::vector<std::string> summary_lines(const Summary& s) {
  std::vector<std::string> lines;
  add_line(lines, look_of(s.mark).sign + (" " + s.verdict), s.size);
  if (!s.items.empty()) lines.emplace_back();
  for (const SummaryItem& item : s.items) {
    const std::size_t pad = item.label.size() < kLabel ? kLabel - item.label.size() : 1;
    add_line(lines, std::string(kIndent, ' ') + item.label + std::string(pad, ' ') + item.name,
             item.chance);
    for (const std::string& fact : item.facts) add_paragraph(lines, fact, kIndent + kLabel);
  }
  if (!s.notes.empty()) lines.emplace_back();
  for (const std::string& note : s.notes) add_paragraph(lines, note, kIndent);
  if (!s.next.empty()) {
    lines.emplace_back();
    lines.push_back(kNext + s.next);
  }
  if (!s.details.empty()) lines.push_back(s.details);
  return lines;
}

void say_next(const Arguments& arguments, const std::string& command) {
  if (arguments.quiet() || command.empty()) return;
  clear_progress_line();
  std::fprintf(stderr, "%s%s\n", kNext, command.c_str());
}

void say_summary(const Arguments& arguments, const Summary& summary) {
  if (arguments.quiet()) return;
  clear_progress_line();
  std::vector<std::string> lines = summary_lines(summary);
  if (colourful()) {
    const MarkLook look = look_of(summary.mark);
    const std::size_t end = std::strlen(look.sign) + 1 + summary.verdict.size();
    lines.front() =
        look.colour + lines.front().substr(0, end) + "\033[0m" + lines.front().substr(end);
  }
  for (const std::string& line : lines) std::fprintf(stderr, "%s\n", line.c_str());
}

}  // namespace hapsim
