#include "tables/encoding.h"

#include <iconv.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <memory>
#include <optional>
#include <utility>

#include "base/error.h"
#include "base/nearest.h"
#include "tables/column_name.h"
#include "tables/header_words.h"

namespace hapsim {
namespace {

struct Encoding {
  const char* name;   // as hapsim tells it
  const char* iconv;  // as iconv knows it
};
// Windows' own variants hold what the standards hold.
constexpr std::array kEncodings{
    Encoding{"UTF-8", "UTF-8"},         Encoding{"UTF-16LE", "UTF-16LE"},
    Encoding{"UTF-16BE", "UTF-16BE"},   Encoding{"GB18030", "GB18030"},
    Encoding{"Big5", "BIG5"},           Encoding{"Shift-JIS", "CP932"},
    Encoding{"EUC-JP", "EUC-JP"},       Encoding{"EUC-KR", "CP949"},
    Encoding{"Windows-1250", "CP1250"}, Encoding{"Windows-1251", "CP1251"},
    Encoding{"Windows-1252", "CP1252"}};

std::string squeezed(const std::string& name) {
  std::string out;
  for (const char c : name)
    if (std::isalnum(static_cast<unsigned char>(c)))
      out += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

const Encoding& encoding_named(const std::string& name) {
  static constexpr std::array<std::pair<const char*, const char*>, 8> kAlso{
      {{"gbk", "GB18030"},
       {"gb2312", "GB18030"},
       {"sjis", "Shift-JIS"},
       {"cp932", "Shift-JIS"},
       {"cp1252", "Windows-1252"},
       {"latin1", "Windows-1252"},
       {"iso88591", "Windows-1252"},
       {"utf16", "UTF-16LE"}}};
  std::string wanted = squeezed(name);
  for (const auto& [also, meant] : kAlso)
    if (wanted == also) wanted = squeezed(meant);
  for (const Encoding& e : kEncodings)
    if (wanted == squeezed(e.name)) return e;
  std::string all;
  for (const Encoding& e : kEncodings) all += (all.empty() ? "" : ", ") + std::string(e.name);
  fail_usage("--encoding: '" + name + "' is not known", "use one of " + all);
}

// nullopt where the bytes are not of that encoding. Five letters have no place in Windows-1252 and
// are met all the same: they become spaces there.
std::optional<std::string> convert(const std::string& bytes, const Encoding& encoding) {
  const std::unique_ptr<void, int (*)(iconv_t)> state(iconv_open("UTF-8", encoding.iconv),
                                                      iconv_close);
  if (state.get() == reinterpret_cast<iconv_t>(-1)) return {};
  const bool forgiving = std::string(encoding.name).rfind("Windows", 0) == 0;
  std::string out(bytes.size() + bytes.size() / 2 + 16, '\0');
  std::string copy = bytes;
  char* in = copy.data();
  std::size_t left = copy.size(), used = 0;
  while (left > 0) {
    char* to = out.data() + used;
    std::size_t room = out.size() - used;
    const std::size_t done = iconv(state.get(), &in, &left, &to, &room);
    used = out.size() - room;
    if (done != static_cast<std::size_t>(-1)) break;
    if (errno == E2BIG) {
      out.resize(2 * out.size());
    } else if (errno == EILSEQ && forgiving) {
      *in = ' ';
    } else if (errno == EINVAL && left < 4) {
      break;  // the last letter is cut
    } else {
      return {};
    }
  }
  out.resize(used);
  return out;
}

const Encoding& named(const char* name) {
  return *std::find_if(kEncodings.begin(), kEncodings.end(),
                       [name](const Encoding& e) { return std::string(e.name) == name; });
}

// UTF-16 without a mark: digits and separators have a zero byte each, on the same side.
const Encoding* wide_without_mark(const std::string& bytes) {
  const std::size_t seen = std::min<std::size_t>(bytes.size(), 4096);
  if (seen < 8) return nullptr;
  std::array<std::size_t, 2> zeros{};
  for (std::size_t i = 0; i < seen; ++i) zeros[i % 2] += bytes[i] == '\0';
  if (5 * zeros[1] > seen && 50 * zeros[0] < seen) return &named("UTF-16LE");
  if (5 * zeros[0] > seen && 50 * zeros[1] < seen) return &named("UTF-16BE");
  return nullptr;
}

// Known words among the cells of the first lines that hold letters beyond ASCII.
int known_words(const std::string& text) {
  int known = 0;
  std::string cell;
  for (const char c : text.substr(0, 8192) + "\n") {
    if (std::string_view("\n\r\t,;|\"").find(c) == std::string_view::npos) {
      cell += c;
      continue;
    }
    const bool foreign = std::any_of(cell.begin(), cell.end(),
                                     [](char l) { return static_cast<unsigned char>(l) >= 0x80; });
    if (foreign && is_known_word(take_apart(cell).joined())) ++known;
    cell.clear();
  }
  return known;
}

// Letters of Chinese and Japanese come two bytes each, those of Europe alone among ASCII.
bool in_pairs(const std::string& bytes) {
  std::size_t runs = 0, single = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    if (static_cast<unsigned char>(bytes[i]) < 0x80) continue;
    const std::size_t begin = i;
    while (i < bytes.size() && static_cast<unsigned char>(bytes[i]) >= 0x80) ++i;
    ++runs;
    single += i - begin == 1;
  }
  return 2 * single < runs;
}

}  // namespace

const std::vector<std::string>& known_encodings() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const Encoding& e : kEncodings) all.emplace_back(e.name);
    return all;
  }();
  return names;
}

DecodedText decode(const std::string& bytes, const std::string& told, const std::string& name) {
  const auto starts = [&bytes](std::string_view mark) {
    return bytes.compare(0, mark.size(), mark) == 0;
  };
  const std::size_t mark = starts("\xff\xfe") || starts("\xfe\xff") ? 2
                           : starts("\xef\xbb\xbf")                 ? 3
                                                                    : 0;
  const Encoding* sure = !told.empty()            ? &encoding_named(told)
                         : starts("\xff\xfe")     ? &named("UTF-16LE")
                         : starts("\xfe\xff")     ? &named("UTF-16BE")
                         : starts("\xef\xbb\xbf") ? &named("UTF-8")
                                                  : nullptr;
  if (sure) {
    if (auto text = convert(bytes.substr(mark), *sure)) return {*text, sure->name, false};
    if (!told.empty() || mark == 2)
      fail_input(name, "the text is not " + std::string(sure->name),
                 "say another --encoding, or none");
  }
  if (const Encoding* wide = wide_without_mark(bytes))
    if (auto text = convert(bytes, *wide)) return {*text, wide->name, true};
  if (auto text = convert(bytes, named("UTF-8"))) return {*text, "UTF-8", false};
  DecodedText best;
  int most = -1;
  // The first of equals: by how the letters stand where no word is known.
  const bool pairs = in_pairs(bytes);
  for (const char* candidate :
       pairs ? std::array{"GB18030", "Shift-JIS", "Big5", "EUC-JP", "Windows-1252"}
             : std::array{"Windows-1252", "GB18030", "Shift-JIS", "Big5", "EUC-JP"}) {
    const auto text = convert(bytes, named(candidate));
    if (!text) continue;
    const int known = known_words(*text);
    if (known <= most) continue;
    most = known;
    best = {*text, candidate, true};
  }
  return best;
}

}  // namespace hapsim
