#include "cli/summary.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "cli/tool.h"
#include "cli/wrap.h"

namespace hapsim {
namespace {

constexpr const char* kNext = "Next:  ";
constexpr std::size_t kIndent = 2, kLabel = 9;  // columns before and of an item's label

const char* sign_of(Summary::Mark mark) {
  return mark == Summary::Mark::kGood ? "✓" : mark == Summary::Mark::kBad ? "✗" : "?";
}
const char* name_of(Summary::Mark mark) {
  return mark == Summary::Mark::kGood ? "good" : mark == Summary::Mark::kBad ? "bad" : "open";
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

// A paragraph, its first line behind `lead` of as many columns as the indent, or of none.
void add_paragraph(std::vector<std::string>& lines, const std::string& text, std::size_t indent,
                   const std::string& lead = "") {
  std::string rest =
      (lead.empty() ? std::string(indent, ' ') : lead) + wrapped(text, indent, indent);
  for (std::size_t end; (end = rest.find('\n')) != rest.npos; rest.erase(0, end + 1))
    lines.push_back(rest.substr(0, end));
}

void add_item(std::vector<std::string>& lines, const SummaryItem& item) {
  const std::size_t pad = item.label.size() < kLabel ? kLabel - item.label.size() : 1;
  const std::string lead = std::string(kIndent, ' ') + item.label + std::string(pad, ' ');
  const bool named = !item.name.empty() || item.facts.empty();
  if (named) add_line(lines, lead + item.name, item.chance);
  for (std::size_t k = 0; k < item.facts.size(); ++k)
    add_paragraph(lines, item.facts[k], kIndent + kLabel, named || k > 0 ? "" : lead);
}

nlohmann::ordered_json number(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json();
}

}  // namespace

std::vector<std::string> summary_lines(const Summary& s) {
  std::vector<std::string> lines;
  add_line(lines, sign_of(s.mark) + (" " + s.verdict), s.size);
  if (!s.items.empty()) lines.emplace_back();
  for (const SummaryItem& item : s.items) add_item(lines, item);
  if (!s.notes.empty()) lines.emplace_back();
  for (const std::string& note : s.notes) add_paragraph(lines, note, kIndent);
  if (!s.next.empty()) {
    lines.emplace_back();
    lines.push_back(kNext + s.next);
  }
  if (!s.details.empty()) lines.push_back(s.details);
  return lines;
}

std::string summary_json(const Summary& s, const std::string& tool) {
  using Json = nlohmann::ordered_json;
  Json json{
      {"tool", tool}, {"version", version()}, {"mark", name_of(s.mark)}, {"verdict", s.verdict}};
  json["values"] = Json::object();
  for (const SummaryValue& v : s.values) {
    Json& one = json["values"][v.name];
    one = {{"value", number(v.value)}, {"unit", v.unit}};
    if (std::isfinite(v.std_error)) one["std_error"] = v.std_error;
  }
  json["items"] = Json::array();
  for (const SummaryItem& item : s.items)
    json["items"].push_back({{"label", item.label}, {"name", item.name}, {"facts", item.facts}});
  json["notes"] = s.notes;
  json["next"] = s.next.empty() ? Json() : Json(s.next);
  // A name of a file need not be UTF-8.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace hapsim
