#include "containers/text_scanner.h"

#include <fmt/format.h>

#include "base/error.h"
#include "io/number.h"

namespace hapsim {
namespace {

bool blank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == ',';
}

}  // namespace

void TextScanner::fail(const std::string& wrong) const {
  fail_input(where(), wrong, "write the mesh again");
}

void TextScanner::skip() {
  while (!rest_.empty()) {
    if (blank(rest_[0])) {
      line_ += rest_[0] == '\n';
      rest_.remove_prefix(1);
    } else if (comment_ != '\0' && rest_[0] == comment_) {
      rest_.remove_prefix(std::min(rest_.find('\n'), rest_.size()));
    } else {
      return;
    }
  }
}

bool TextScanner::done() {
  skip();
  return rest_.empty();
}

std::string_view TextScanner::word() {
  skip();
  std::size_t length = 0;
  while (length < rest_.size() && !blank(rest_[length])) ++length;
  const std::string_view found = rest_.substr(0, length);
  rest_.remove_prefix(length);
  return found;
}

std::string_view TextScanner::line() {
  const std::size_t end = std::min(rest_.find('\n'), rest_.size());
  std::string_view found = rest_.substr(0, end);
  rest_.remove_prefix(std::min(end + 1, rest_.size()));
  ++line_;
  while (!found.empty() && blank(found.back())) found.remove_suffix(1);
  while (!found.empty() && blank(found.front())) found.remove_prefix(1);
  return found;
}

std::string_view TextScanner::bytes(const char* what, std::size_t count) {
  if (count > rest_.size())
    fail(fmt::format("the file is truncated: {} bytes of {} should follow, {} are left", count,
                     what, rest_.size()));
  const std::string_view found = rest_.substr(0, count);
  rest_.remove_prefix(count);
  return found;
}

double TextScanner::number(const char* what) {
  const std::string_view text = word();
  double value = 0;
  if (text.empty()) fail(fmt::format("the file is truncated: {} should follow", what));
  if (!parse_number(text, value)) fail(fmt::format("{} stands where {} should", shown(text), what));
  return value;
}

long TextScanner::integer(const char* what, long low, long high) {
  const double value = number(what);
  if (!(value >= static_cast<double>(low) && value <= static_cast<double>(high)))
    fail(fmt::format("{}: {} is out of range ({} to {})", what, value, low, high));
  const long whole = static_cast<long>(value);
  if (static_cast<double>(whole) != value) fail(fmt::format("{}: {} is not whole", what, value));
  return whole;
}

std::size_t TextScanner::count(const char* what, std::size_t bytes) {
  const auto n = static_cast<std::size_t>(integer(what, 0, 2147483647));
  if (n > rest_.size() / bytes + 1)
    fail(fmt::format("the file claims {} as {} and is too short for them", n, what));
  return n;
}

}  // namespace hapsim
