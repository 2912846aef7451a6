#include "fuzz/mutant.h"

#include <algorithm>
#include <array>
#include <utility>

namespace hapsim::fuzz {
namespace {

using Span = std::pair<std::size_t, std::size_t>;  // where it begins, how long it is

// The run of characters around a random place that `inside` accepts.
template <typename Inside>
Span span_at(const std::string& text, Random& random, const Inside& inside) {
  const std::size_t at = random.integer(text.size());
  std::size_t begin = at, end = at;
  while (begin > 0 && inside(text[begin - 1])) --begin;
  while (end < text.size() && inside(text[end])) ++end;
  return {begin, end - begin};
}

Span line_at(const std::string& text, Random& random) {
  Span line = span_at(text, random, [](char c) { return c != '\n'; });
  if (line.first + line.second < text.size()) ++line.second;  // with its end
  return line;
}

void change_bytes(std::string& text, Random& random) {
  for (std::uint64_t n = 1 + random.integer(4); n > 0; --n)
    text[random.integer(text.size())] = static_cast<char>(random.integer(256));
}

void remove_bytes(std::string& text, Random& random) {
  text.erase(random.integer(text.size()), 1 + random.integer(8));
}

void repeat_bytes(std::string& text, Random& random) {
  const std::string piece = text.substr(random.integer(text.size()), 1 + random.integer(64));
  text.insert(random.integer(text.size()), piece);
}

void change_number(std::string& text, Random& random) {
  static constexpr std::array kNumbers{
      "0",    "-1",    "1e-320", "1e308",      "-1e30",      "nan",   "inf",
      "",     "1.5",   "0x10",   "2147483648", "4294967295", "1e9",   "99999999999999999999",
      "1e-9", "0.001", "7",      "1,5",        "-0",         "1e400", "-2147483649"};
  const auto part = [](char c) {
    return (c >= '0' && c <= '9') || c == '.' || c == '-' || c == 'e';
  };
  for (int tries = 0; tries < 20; ++tries) {
    const Span number = span_at(text, random, part);
    if (number.second == 0) continue;
    text.replace(number.first, number.second, kNumbers[random.integer(kNumbers.size())]);
    return;
  }
}

void change_cell(std::string& text, Random& random) {
  const auto part = [](char c) {
    return c != ',' && c != ' ' && c != '\n' && c != ';' && c != '\t';
  };
  const Span cell = span_at(text, random, part);
  const Span other = span_at(text, random, part);
  const std::string piece = random.coin() ? text.substr(other.first, other.second) : "";
  text.replace(cell.first, cell.second, piece);
}

void remove_line(std::string& text, Random& random) {
  const Span line = line_at(text, random);
  text.erase(line.first, line.second);
}

void copy_line(std::string& text, Random& random) {
  const Span line = line_at(text, random);
  const std::string piece = text.substr(line.first, line.second);
  if (random.coin()) text.erase(line.first, line.second);
  text.insert(text.empty() ? 0 : line_at(text, random).first, piece);
}

void cut(std::string& text, Random& random) {
  text.resize(random.integer(text.size()));
}

}  // namespace

std::string mutant(const std::string& good, Random& random) {
  static constexpr std::array kWays{change_bytes,  remove_bytes,  repeat_bytes,
                                    change_number, change_number, change_cell,
                                    remove_line,   copy_line,     cut};
  std::string bad = good;
  for (std::uint64_t n = 1 + random.integer(2); n > 0 && !bad.empty(); --n)
    kWays[random.integer(kWays.size())](bad, random);
  return bad;
}

}  // namespace hapsim::fuzz
