#include "io/number.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstdlib>

namespace hapsim {

std::string_view trim(std::string_view text) {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

bool parse_number(std::string_view text, double& value) {
  text = trim(text);
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  double parsed = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, parsed);
  if (stop != end || error == std::errc::invalid_argument) return false;
  // from_chars refuses what underflows; strtod rounds it.
  if (error == std::errc::result_out_of_range)
    parsed = std::strtod(std::string(text).c_str(), nullptr);
  if (!std::isfinite(parsed)) return false;
  value = parsed;
  return true;
}

std::string format_number(double value) {
  if (std::isnan(value)) return "nan";  // without the sign that some operations leave on it
  return fmt::format("{}", value);
}

std::string shown(std::string_view text) {
  constexpr std::size_t kLimit = 40;
  std::string result = "'";
  for (const char c : text.substr(0, kLimit))
    result += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? '?' : c;
  return result + (text.size() > kLimit ? "...'" : "'");
}

}  // namespace hapsim
