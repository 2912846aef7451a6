#include "io/metadata.h"

#include <algorithm>

#include "base/error.h"
#include "io/number.h"

namespace hapsim {
namespace {

// A line break inside a value would end the comment it is written in.
std::string on_one_line(std::string text) {
  for (char& c : text)
    if (c == '\n' || c == '\r') c = ' ';
  return text;
}

}  // namespace

std::optional<std::string> Metadata::find(const std::string& key) const {
  if (key.empty()) return {};
  for (auto line = lines_.rbegin(); line != lines_.rend(); ++line)
    if (line->key == key) return line->value;
  return {};
}

std::optional<double> Metadata::number(const std::string& key, const std::string& where) const {
  const auto text = find(key);
  if (!text) return {};
  double value = 0;
  if (!parse_number(*text, value))
    fail_input(where, "metadata '" + key + "' is " + shown(*text) + ", not a number",
               "write it as '# " + key + ": 0.5'");
  return value;
}

void Metadata::set(const std::string& key, const std::string& value) {
  const auto same = [&](const Line& line) { return line.key == key; };
  const auto first = std::find_if(lines_.begin(), lines_.end(), same);
  if (first == lines_.end()) return append(key, value);
  first->value = on_one_line(value);
  lines_.erase(std::remove_if(first + 1, lines_.end(), same), lines_.end());
}

void Metadata::append(const std::string& key, const std::string& value) {
  lines_.push_back({key, on_one_line(value)});
}

void Metadata::remove(const std::string& key) {
  std::erase_if(lines_, [&](const Line& line) { return line.key == key; });
}

void Metadata::add_comment(const std::string& text) {
  lines_.push_back({"", on_one_line(text)});
}

void Metadata::add_line(std::string_view text) {
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  const auto in_key = [&](char c) {
    return is_letter(c) || (c >= '0' && c <= '9') || c == '_' || c == '-' || c == '.';
  };
  std::string_view body = text;
  if (!body.empty() && body.front() == ' ') body.remove_prefix(1);
  const std::string_view trimmed = trim(body);
  std::size_t colon = 0;
  while (colon < trimmed.size() && in_key(trimmed[colon])) ++colon;
  const bool is_pair = colon > 0 && colon < trimmed.size() && trimmed[colon] == ':' &&
                       is_letter(trimmed[0]) &&
                       (colon + 1 == trimmed.size() || trimmed[colon + 1] == ' ');
  if (is_pair)
    append(std::string(trimmed.substr(0, colon)), std::string(trim(trimmed.substr(colon + 1))));
  else
    add_comment(std::string(body));
}

}  // namespace hapsim
