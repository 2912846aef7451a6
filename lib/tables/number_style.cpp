#include "tables/number_style.h"

#include <algorithm>
#include <cctype>

#include "base/error.h"
#include "io/number.h"
#include "tables/fold.h"

namespace hapsim {
namespace {

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

// The marks of a number's body, "1.234,56" without sign and exponent.
struct Marks {
  bool number = false;
  char decimal = 0;       // the mark before the decimals; 0: there are none
  char thousands = 0;     // 0: none
  bool doubtful = false;  // `decimal` may as well stand between thousands: "1,234"
};

bool in_groups(std::string_view whole, char mark) {
  const std::size_t first = whole.find(mark);
  if (first == 0 || first > 3 || whole[0] == '0') return false;
  for (std::size_t i = first; i < whole.size(); i += 4) {
    if (whole[i] != mark || i + 4 > whole.size()) return false;
    for (std::size_t k = 1; k <= 3; ++k)
      if (!is_digit(whole[i + k])) return false;
  }
  return true;
}

Marks marks_of(std::string_view body) {
  Marks marks;
  if (body.empty() || std::none_of(body.begin(), body.end(), is_digit)) return marks;
  for (const char c : body)
    if (!is_digit(c) && std::string_view(",. '").find(c) == std::string_view::npos) return marks;
  const std::size_t last = body.find_last_of(".,");
  std::string_view whole = body;
  if (last != body.npos && std::count(body.begin(), body.end(), body[last]) == 1) {
    marks.decimal = body[last];
    whole = body.substr(0, last);
    const std::string_view decimals = body.substr(last + 1);
    if (!std::all_of(decimals.begin(), decimals.end(), is_digit)) return marks;
  }
  const std::size_t between = whole.find_first_not_of("0123456789");
  if (between != whole.npos) {
    marks.thousands = whole[between];
    if (!in_groups(whole, marks.thousands)) return marks;
  } else if (marks.decimal) {
    marks.doubtful = body.size() - last == 4 && last >= 1 && last <= 3 && body[0] != '0';
  }
  marks.number = true;
  return marks;
}

// Plain letters, without the sign in front and the exponent behind, which `around` gets.
std::string body_of(std::string_view cell, std::string* sign, std::string* exponent) {
  const bool ascii = std::all_of(cell.begin(), cell.end(),
                                 [](char c) { return static_cast<unsigned char>(c) < 0x80; });
  std::string text = ascii ? std::string(trim(cell)) : std::string(trim(plain(cell)));
  std::size_t begin = !text.empty() && (text[0] == '-' || text[0] == '+') ? 1 : 0;
  std::size_t end = std::min(text.find_first_of("eE"), text.size());
  if (end < text.size()) {
    std::size_t digits = end + 1;
    if (digits < text.size() && (text[digits] == '-' || text[digits] == '+')) ++digits;
    if (digits == text.size() ||
        !std::all_of(text.begin() + static_cast<std::ptrdiff_t>(digits), text.end(), is_digit))
      return "";
  }
  if (sign) *sign = begin && text[0] == '-' ? "-" : "";
  if (exponent) *exponent = text.substr(end);
  return text.substr(begin, end - begin);
}

}  // namespace

bool may_be_number(std::string_view cell, bool commas) {
  double value;
  if (parse_number(cell, value)) return true;
  if (!commas && cell.find(',') != cell.npos) return false;
  return marks_of(body_of(cell, nullptr, nullptr)).number;
}

bool may_be_moment(std::string_view cell) {
  cell = trim(cell);
  if (cell.size() < 5 || !is_digit(cell[0])) return false;
  std::size_t marks = 0;
  for (const char c : cell) {
    marks += std::string_view(":/-").find(c) != std::string_view::npos;
    if (!is_digit(c) && std::string_view(":/-., TZ").find(c) == std::string_view::npos)
      return false;
  }
  return marks >= 2 || (marks == 1 && cell.find(':') != cell.npos);
}

std::string plain_number(std::string_view cell, const NumberStyle& style) {
  double value;
  const bool point = style.decimal == '.' || cell.find_first_of(".,") == cell.npos;
  if (point && parse_number(cell, value)) return std::string(cell);
  std::string sign, exponent;
  const std::string body = body_of(cell, &sign, &exponent);
  const Marks marks = marks_of(body);
  const bool only_thousands = marks.doubtful && marks.decimal == style.thousands;
  if (!marks.number || (marks.decimal && marks.decimal != style.decimal && !only_thousands) ||
      (marks.thousands && marks.thousands != style.thousands))
    return std::string(cell);
  std::string out = sign;
  for (const char c : body) {
    if (is_digit(c)) out += c;
    if (c == style.decimal) out += '.';
  }
  return out + exponent;
}

void StyleFinder::add(std::string_view cell, long line) {
  if (cell.find_first_of(",.' \xC2\xE2") == cell.npos) return;
  const Marks marks = marks_of(body_of(cell, nullptr, nullptr));
  if (!marks.number) return;
  const auto note = [line](long& where) {
    if (where == 0) where = line;
  };
  if (marks.thousands == ',') note(thousands_comma_);
  if (marks.thousands == '.') note(thousands_point_);
  if (marks.thousands == ' ') note(thousands_space_);
  if (marks.thousands == '\'') note(thousands_mark_);
  if (marks.doubtful && marks.decimal == ',' && doubtful_comma_ == 0) doubtful_ = cell;
  if (marks.decimal == ',') note(marks.doubtful ? doubtful_comma_ : decimal_comma_);
  if (marks.decimal == '.') note(marks.doubtful ? doubtful_point_ : decimal_point_);
}

NumberStyle StyleFinder::find(const std::string& told, const std::string& name) const {
  const bool comma = told == "comma" || (told.empty() && (decimal_comma_ || thousands_point_));
  const bool point = told == "point" || (told.empty() && (decimal_point_ || thousands_comma_));
  const long comma_line = decimal_comma_ ? decimal_comma_ : thousands_point_;
  const long point_line = decimal_point_ ? decimal_point_ : thousands_comma_;
  if ((comma && point_line) || (point && comma_line))
    fail_input(name,
               comma_line && point_line
                   ? "decimal commas (line " + std::to_string(comma_line) +
                         ") and decimal points (line " + std::to_string(point_line) + ") are mixed"
                   : "line " + std::to_string(std::max(comma_line, point_line)) +
                         " has another decimal mark than --decimal says",
               "write all numbers with a point");
  const bool doubt = !comma && !point && doubtful_comma_;
  if (doubt)
    fail_input(name + ":" + std::to_string(doubtful_comma_),
               "the comma of '" + doubtful_ + "' may stand before decimals or between thousands",
               "say --decimal comma or --decimal point");
  NumberStyle style;
  style.decimal = comma ? ',' : '.';
  style.thousands = thousands_space_                                  ? ' '
                    : thousands_mark_                                 ? '\''
                    : comma && (thousands_point_ || doubtful_point_)  ? '.'
                    : !comma && (thousands_comma_ || doubtful_comma_) ? ','
                                                                      : '\0';
  return style;
}

}  // namespace hapsim
