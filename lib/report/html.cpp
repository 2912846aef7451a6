#include "report/html.h"

namespace hapsim {
namespace {

// Length of the UTF-8 sequence at the front of `text`, 0 when it is not one. Overlong forms are let
// through: they cannot make an ASCII character in a browser.
std::size_t utf8_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(0);
  const std::size_t length = first < 0x80 ? 1 : first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
  if ((first >= 0x80 && first < 0xc2) || first > 0xf4 || length > text.size()) return 0;
  for (std::size_t i = 1; i < length; ++i)
    if ((byte(i) & 0xc0) != 0x80) return 0;
  return length;
}

}  // namespace

std::string escape_html(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    const char c = text[0];
    if (length == 0)
      result += "\xef\xbf\xbd";
    else if (length > 1)
      result += text.substr(0, length);
    else if (c == '&')
      result += "&amp;";
    else if (c == '<')
      result += "&lt;";
    else if (c == '>')
      result += "&gt;";
    else if (c == '"')
      result += "&quot;";
    else if (c == '\'')
      result += "&#39;";
    else
      result += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? ' ' : c;
    text.remove_prefix(length == 0 ? 1 : length);
  }
  return result;
}

std::string script_string(std::string_view text) {
  std::string result = "\"";
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    const char c = text[0];
    if (length == 0)
      result += "\\ufffd";
    else if (length > 1)
      result += text.substr(0, length);
    else if (c == '"' || c == '\\')
      result += std::string("\\") + c;
    else if (c == '<')
      result += "\\u003c";
    else
      result += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    text.remove_prefix(length == 0 ? 1 : length);
  }
  return result + "\"";
}

}  // namespace hapsim
