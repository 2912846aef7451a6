#include "tables/fold.h"

#include <array>
#include <cctype>

namespace hapsim {
namespace {

struct Plain {
  char32_t code;
  const char* text;
};

// Letters and signs that are another text in plain form.
constexpr std::array kPlain{
    Plain{U'ä', "ae"},     Plain{U'ö', "oe"},     Plain{U'ü', "ue"},     Plain{U'Ä', "Ae"},
    Plain{U'Ö', "Oe"},     Plain{U'Ü', "Ue"},     Plain{U'ß', "ss"},     Plain{U'µ', "u"},
    Plain{U'μ', "u"},      Plain{U'Δ', "d"},      Plain{U'æ', "ae"},     Plain{U'œ', "oe"},
    Plain{U'Œ', "Oe"},     Plain{U'ø', "oe"},     Plain{U'Ø', "Oe"},     Plain{U'²', "2"},
    Plain{U'³', "3"},      Plain{U'·', "."},      Plain{U'⋅', "."},      Plain{U'・', " "},
    Plain{U'′', "'"},      Plain{U'’', "'"},      Plain{U'‘', "'"},      Plain{U'−', "-"},
    Plain{U'–', "-"},      Plain{U'—', "-"},      Plain{U'‐', "-"},      Plain{U'【', "["},
    Plain{U'】', "]"},     Plain{U'〔', "["},     Plain{U'〕', "]"},     Plain{U'、', ","},
    Plain{U'\u00a0', " "}, Plain{U'\u202f', " "}, Plain{U'\u2009', " "}, Plain{U'\u2007', " "},
    Plain{U'\u3000', " "}, Plain{U'㎜', "mm"},    Plain{U'㎝', "cm"},    Plain{U'㎛', "um"},
    Plain{U'㎚', "nm"},    Plain{U'㎏', "kg"},    Plain{U'㎎', "mg"},    Plain{U'㎳', "ms"},
    Plain{U'㎲', "us"},    Plain{U'㎱', "ns"},    Plain{U'㎩', "Pa"},    Plain{U'㎪', "kPa"},
    Plain{U'㎫', "MPa"},   Plain{U'㎐', "Hz"},    Plain{U'℃', "degC"},   Plain{U'°', "deg"},
    Plain{U'º', "deg"},    Plain{U'℉', "degF"}};

// Letters with a mark, each behind the letter that it is without.
struct Marked {
  char letter;
  const char32_t* marked;
};
constexpr std::array kMarked{
    Marked{'a', U"àáâãåāăą"}, Marked{'A', U"ÀÁÂÃÅĀĂĄ"}, Marked{'c', U"çćč"},
    Marked{'C', U"ÇĆČ"},      Marked{'e', U"èéêëēěę"},  Marked{'E', U"ÈÉÊËĒĚĘ"},
    Marked{'i', U"ìíîïī"},    Marked{'I', U"ÌÍÎÏĪ"},    Marked{'n', U"ñńň"},
    Marked{'N', U"ÑŃŇ"},      Marked{'o', U"òóôõō"},    Marked{'O', U"ÒÓÔÕŌ"},
    Marked{'s', U"śš"},       Marked{'S', U"ŚŠ"},       Marked{'u', U"ùúûūů"},
    Marked{'U', U"ÙÚÛŪŮ"},    Marked{'y', U"ýÿ"},       Marked{'Y', U"ÝŸ"},
    Marked{'z', U"źżž"},      Marked{'Z', U"ŹŻŽ"}};

// Of U+FF61 to U+FF9D.
constexpr std::u32string_view kKatakana =
    U"。「」、・ヲァィゥェォャュョッーアイウエオカキクケコサシスセソタチツテトナニヌネノハヒフヘホ"
    U"マミムメモヤユヨラリルレロワン";

void append_utf8(std::string& out, char32_t code) {
  if (code < 0x80) {
    out += static_cast<char>(code);
    return;
  }
  const int more = code < 0x800 ? 1 : code < 0x10000 ? 2 : 3;
  constexpr std::array<unsigned, 4> kLead{0, 0xC0, 0xE0, 0xF0};
  out += static_cast<char>(kLead[static_cast<std::size_t>(more)] | (code >> (6 * more)));
  for (int k = more - 1; k >= 0; --k) out += static_cast<char>(0x80 | ((code >> (6 * k)) & 0x3F));
}

// The next letter of `text` from `at`, which is moved past it.
char32_t next_code(std::string_view text, std::size_t& at) {
  const auto first = static_cast<unsigned char>(text[at++]);
  if (first < 0x80) return first;
  const int more = first >= 0xF0 ? 3 : first >= 0xE0 ? 2 : first >= 0xC0 ? 1 : 0;
  char32_t code = first & (0x3F >> more);
  for (int k = 0; k < more && at < text.size(); ++k)
    code = code << 6 | (static_cast<unsigned char>(text[at++]) & 0x3F);
  return code;
}

bool is_letter(char32_t code) {
  return (code >= 0x370 && code < 0x530) || (code >= 0x3040 && code < 0x3100) ||
         (code >= 0x3400 && code < 0xA000) || (code >= 0xAC00 && code < 0xD7A4) || code == U'々';
}

void append_plain(std::string& out, char32_t code) {
  if (code >= 0xFF01 && code <= 0xFF5E) code -= 0xFEE0;  // full width
  if (code < 0x80) {
    out += static_cast<char>(code);
    return;
  }
  if (code >= 0xFF61 && code < 0xFF61 + kKatakana.size()) code = kKatakana[code - 0xFF61];
  for (const Plain& p : kPlain)
    if (code == p.code) {
      out += p.text;
      return;
    }
  for (const Marked& m : kMarked)
    if (std::u32string_view(m.marked).find(code) != std::u32string_view::npos) {
      out += m.letter;
      return;
    }
  if (is_letter(code)) append_utf8(out, code);
}

}  // namespace

std::string plain(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    const char32_t code = next_code(text, i);
    if (code == 0x308 && !out.empty() &&
        std::string_view("aouAOU").find(out.back()) != std::string_view::npos) {
      out += 'e';  // an umlaut in two pieces
    } else if (code >= 0x300 && code < 0x370) {
      continue;
    } else if ((code == 0xFF9E || code == 0xFF9F) && out.size() >= 3) {
      // A half-width voicing mark belongs to the letter before it.
      std::size_t last = out.size() - 3;
      const char32_t voiced = next_code(out, last) + (code == 0xFF9E ? 1 : 2);
      out.resize(out.size() - 3);
      append_utf8(out, voiced);
    } else {
      append_plain(out, code);
    }
  }
  return out;
}

std::string fold(std::string_view text) {
  std::string out = plain(text);
  for (char& c : out)
    if (static_cast<unsigned char>(c) < 0x80)
      c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

}  // namespace hapsim
