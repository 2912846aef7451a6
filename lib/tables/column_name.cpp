#include "tables/column_name.h"

#include <algorithm>
#include <cctype>
#include <initializer_list>

#include "io/number.h"
#include "tables/fold.h"
#include "tables/header_words.h"

namespace hapsim {
namespace {

// Spaces where camelCase begins a word.
std::string separate_words(std::string_view name) {
  std::string out;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const auto c = static_cast<unsigned char>(name[i]);
    const auto before = static_cast<unsigned char>(i ? name[i - 1] : ' ');
    if (std::isupper(c) && std::islower(before)) out += ' ';
    out += name[i];
  }
  return out;
}

// Letters and digits; other scripts than Latin are words of their own.
std::vector<std::string> words_of(std::string_view text) {
  std::vector<std::string> words;
  std::string word;
  bool latin = true;
  for (const char c : fold(separate_words(text)) + " ") {
    const auto byte = static_cast<unsigned char>(c);
    const bool part = byte >= 0x80 || std::isalnum(byte);
    if (!word.empty() && (!part || latin != (byte < 0x80))) {
      words.push_back(word);
      word.clear();
    }
    latin = byte < 0x80;
    if (part) word += c;
  }
  return words;
}

// What looks like a unit: one short word with a letter that no other word of headers is.
bool looks_like_unit(std::string_view bracketed) {
  const std::vector<std::string> words = words_of(fold(bracketed));
  if (words.size() != 1 || words[0].size() > 10) return false;
  return std::none_of(words[0].begin(), words[0].end(),
                      [](unsigned char c) { return std::isdigit(c); }) &&
         !is_word(words[0], Word::kQualifier) && !is_known_word(words[0]);
}

// Takes "[mm]", "(N)", "/ N", ", N", " in mm" off the end or the middle of a name.
UnitName take_unit(std::string& name, std::string& unknown) {
  for (const char* brackets : {"[]", "()", "{}", "<>"}) {
    const std::size_t open = name.rfind(brackets[0]);
    const std::size_t close = open == name.npos ? name.npos : name.find(brackets[1], open);
    if (close == name.npos) continue;
    const std::string_view text = std::string_view(name).substr(open, close - open + 1);
    UnitName unit = parse_unit(text);
    if (unit.kind == UnitKind::kNone) {
      if (unknown.empty() && looks_like_unit(text))
        unknown = std::string(trim(text.substr(1, text.size() - 2)));
      continue;
    }
    name.erase(open, close - open + 1);
    return unit;
  }
  for (const std::string_view mark : {" in ", " en ", "/", ",", ":", ";"}) {
    const std::size_t at = name.rfind(mark);
    if (at == name.npos || at == 0) continue;
    UnitName unit = parse_unit(std::string_view(name).substr(at + mark.size()));
    if (unit.kind == UnitKind::kNone) continue;
    name.erase(at);
    return unit;
  }
  return {};
}

// "x_mm", "force_mN", "t s": the last word is a unit when a name is left before it. Single letters
// that mean something else more often ("c", "g", "v") are none.
UnitName take_last_word(std::string& name) {
  const std::size_t at = name.find_last_of("_ -.");
  if (at == name.npos || at == 0) return {};
  const std::string last = name.substr(at + 1);
  UnitName unit = parse_unit(last);
  if (unit.kind == UnitKind::kNone ||
      (last.size() == 1 && std::string("smnSMN").find(last) == last.npos))
    return {};
  name.erase(at);
  return unit;
}

// "distancemm", "forceN", "时间s": a word of the table and a unit of its quantity.
UnitName take_glued(std::string& name) {
  struct Kind {
    UnitKind unit;
    std::initializer_list<Word> words;
  };
  static const Kind kKinds[] = {{UnitKind::kTime, {Word::kTime}},
                                {UnitKind::kForce, {Word::kForce}},
                                {UnitKind::kLength, {Word::kDepth, Word::kTravel, Word::kGap}}};
  for (std::size_t length = 1; length <= 3 && length < name.size(); ++length) {
    const std::size_t cut = name.size() - length;
    if ((static_cast<unsigned char>(name[cut]) & 0xC0) == 0x80) continue;
    const UnitName unit = parse_unit(std::string_view(name).substr(cut));
    if (unit.kind == UnitKind::kNone || unit.kind == UnitKind::kOther) continue;
    std::string word;
    for (const std::string& part : words_of(std::string_view(name).substr(0, cut))) word += part;
    std::string whole;
    for (const std::string& part : words_of(name)) whole += part;
    for (const Kind& kind : kKinds)
      for (const Word quantity : kind.words)
        if (kind.unit == unit.kind && is_pattern(word, quantity) && !is_pattern(whole, quantity)) {
          name.resize(cut);
          return unit;
        }
  }
  return {};
}

}  // namespace

std::string ColumnName::joined() const {
  std::string all;
  for (const std::string& word : words) all += word;
  return all;
}

ColumnName take_apart(std::string_view text) {
  ColumnName name;
  std::string rest(trim(plain(text)));
  while (!rest.empty() && std::string_view(": '").find(rest.back()) != std::string_view::npos)
    rest.pop_back();  // a prime tells equal names apart
  name.unit = take_unit(rest, name.unknown);
  if (name.unit.kind == UnitKind::kNone) name.unit = take_last_word(rest);
  if (name.unit.kind == UnitKind::kNone) name.unit = take_glued(rest);
  if (name.unit.kind != UnitKind::kNone) name.unknown.clear();
  // Nobody presses with meganewtons: it is mN in capitals, or not known.
  if (name.unit.kind == UnitKind::kForce && name.unit.factor == 1e6) {
    name.unknown = name.unit.name;
    name.unit = {};
  }
  name.words = words_of(rest);
  return name;
}

std::vector<Component> components(const std::vector<std::string>& words) {
  std::vector<Component> found;
  // A single letter says what is meant, the other words only which one: "contact_fx" gives
  // f:contact.
  const auto coded = [](const std::vector<std::string>& parts) {
    std::string letter, rest;
    for (const std::string& part : parts)
      (part.size() == 1 && letter.empty() ? letter : rest) += part;
    return letter.empty() || rest.empty() ? letter + rest : letter + ":" + rest;
  };
  const auto join_without = [&](std::size_t skip) {
    std::vector<std::string> parts = words;
    parts.erase(parts.begin() + static_cast<std::ptrdiff_t>(skip));
    return coded(parts);
  };
  const auto join_short = [&](std::size_t which) {
    std::vector<std::string> parts = words;
    parts[which].pop_back();
    return coded(parts);
  };
  const auto letter = [](char c) { return c >= 'x' && c <= 'z' ? c - 'x' : -1; };
  if (words.empty()) return found;
  for (std::size_t i = words.size(); i-- > 0;)
    if (words[i].size() == 1 && letter(words[i][0]) >= 0)
      found.push_back({join_without(i), letter(words[i][0]), 'x'});
  const std::string& last = words.back();
  if (last.size() == 1 && words.size() > 1 && last[0] >= '1' && last[0] <= '3')
    found.push_back({join_without(words.size() - 1), last[0] - '1', '1'});
  if (last.size() == 1 && words.size() > 1 && last[0] >= '0' && last[0] <= '2')
    found.push_back({join_without(words.size() - 1), last[0] - '0', '0'});
  if (last.size() >= 2 && letter(last.back()) >= 0)
    found.push_back({join_short(words.size() - 1), letter(last.back()), 'x'});
  if (last.size() >= 2 && last.back() >= '1' && last.back() <= '3')
    found.push_back({join_short(words.size() - 1), last.back() - '1', '1'});
  const std::string& head = words.front();
  if (words.size() > 1 && head.size() == 2 && letter(head[1]) >= 0)
    found.push_back({join_short(0), letter(head[1]), 'x'});
  return found;
}

}  // namespace hapsim
