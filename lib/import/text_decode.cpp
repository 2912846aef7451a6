#include "import/text_decode.h"

#include <array>
#include <cctype>
#include <utility>

#include "base/error.h"

namespace hapsim {
namespace {

void append_utf8(std::string& out, unsigned code) {
  if (code < 0x80) {
    out += static_cast<char>(code);
  } else if (code < 0x800) {
    out += static_cast<char>(0xC0 | (code >> 6));
    out += static_cast<char>(0x80 | (code & 0x3F));
  } else {
    out += static_cast<char>(0xE0 | (code >> 12));
    out += static_cast<char>(0x80 | ((code >> 6) & 0x3F));
    out += static_cast<char>(0x80 | (code & 0x3F));
  }
}

std::string from_utf16(const std::string& bytes, bool big_endian) {
  std::string out;
  for (std::size_t i = 2; i + 1 < bytes.size(); i += 2) {
    const auto first = static_cast<unsigned char>(bytes[i]);
    const auto second = static_cast<unsigned char>(bytes[i + 1]);
    append_utf8(out, big_endian ? (first << 8 | second) : (second << 8 | first));
  }
  return out;
}

bool is_utf8(const std::string& bytes) {
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const auto c = static_cast<unsigned char>(bytes[i]);
    if (c < 0x80) continue;
    const std::size_t more = c >= 0xF0 ? 3 : c >= 0xE0 ? 2 : c >= 0xC2 ? 1 : 0;
    if (more == 0 || i + more >= bytes.size()) return false;
    for (std::size_t k = 1; k <= more; ++k)
      if ((static_cast<unsigned char>(bytes[i + k]) & 0xC0) != 0x80) return false;
    i += more;
  }
  return true;
}

// The letters above 0x7F that matter here stand at their Unicode place.
std::string from_windows1252(const std::string& bytes) {
  std::string out;
  for (const char c : bytes) append_utf8(out, static_cast<unsigned char>(c));
  return out;
}

void unify_line_ends(std::string& text) {
  std::size_t to = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\r') {
      if (i + 1 < text.size() && text[i + 1] == '\n') continue;
      text[to++] = '\n';
    } else {
      text[to++] = text[i];
    }
  }
  text.resize(to);
}

}  // namespace

std::string decode_text(std::string bytes, const std::string& name) {
  const auto starts = [&bytes](std::string_view mark) {
    return bytes.compare(0, mark.size(), mark) == 0;
  };
  if (starts("PK\x03\x04"))
    fail_input(name, "this looks like a spreadsheet or zip file", "export the sheet as CSV");
  if (starts("MATLAB 5.0"))
    fail_input(name, "this is a MATLAB file", "export it as CSV; share/examples/import shows how");
  if (starts("\x1f\x8b"))
    fail_input(name, "this is compressed by gzip", "unpack it: gzip -dc FILE | hs-import");
  if (starts("\xff\xfe") || starts("\xfe\xff"))
    bytes = from_utf16(bytes, starts("\xfe\xff"));
  else if (starts("\xef\xbb\xbf"))
    bytes.erase(0, 3);
  if (!is_utf8(bytes)) bytes = from_windows1252(bytes);
  if (bytes.find('\0') != bytes.npos)
    fail_input(name, "this looks like a binary file", "a table as text is needed");
  unify_line_ends(bytes);
  return bytes;
}

std::string fold(std::string_view text) {
  static constexpr std::array<std::pair<const char*, const char*>, 10> kLetters{{{"ä", "ae"},
                                                                                 {"ö", "oe"},
                                                                                 {"ü", "ue"},
                                                                                 {"Ä", "ae"},
                                                                                 {"Ö", "oe"},
                                                                                 {"Ü", "ue"},
                                                                                 {"ß", "ss"},
                                                                                 {"µ", "u"},
                                                                                 {"μ", "u"},
                                                                                 {"Δ", "d"}}};
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto c = static_cast<unsigned char>(text[i]);
    if (c < 0x80) {
      out += static_cast<char>(std::tolower(c));
      continue;
    }
    for (const auto& [letter, plain] : kLetters)
      if (text.substr(i, 2) == letter) out += plain;
    while (i + 1 < text.size() && (static_cast<unsigned char>(text[i + 1]) & 0xC0) == 0x80) ++i;
  }
  return out;
}

}  // namespace hapsim
