#include "containers/mesh_xml.h"

#include <fmt/format.h>

#include <cmath>

#include "base/error.h"
#include "io/number.h"

namespace hapsim {
namespace {

constexpr const char* kMend = "write the mesh again";
constexpr double kLargest = 2147483647;

}  // namespace

XmlFile::XmlFile(const std::string& bytes, const std::string& name) : bytes_(bytes), name_(name) {
  const pugi::xml_parse_result result =
      document_.load_buffer(bytes.data(), bytes.size(), pugi::parse_default, pugi::encoding_utf8);
  if (!result)
    fail_input(line_of(result.offset),
               std::string("the XML is not well formed: ") + result.description(), kMend);
}

std::string XmlFile::line_of(std::ptrdiff_t offset) const {
  const auto end = bytes_.begin() + std::clamp<std::ptrdiff_t>(
                                        offset, 0, static_cast<std::ptrdiff_t>(bytes_.size()));
  return fmt::format("{}:{}", name_, 1 + std::count(bytes_.begin(), end, '\n'));
}

std::string XmlFile::where(pugi::xml_node element) const {
  return line_of(element.offset_debug());
}

std::vector<double> XmlFile::numbers(pugi::xml_node element, std::string_view text,
                                     const char* what) const {
  std::vector<double> values;
  each_word(text, [&](std::string_view word) {
    if (!parse_number(word, values.emplace_back()))
      fail_input(where(element), fmt::format("{} is no {}", shown(word), what), kMend);
  });
  return values;
}

long XmlFile::integer(pugi::xml_node element, std::string_view text, const char* what,
                      long low) const {
  double value = 0;
  if (!parse_number(text, value) || value != std::floor(value) ||
      value < static_cast<double>(low) || value > kLargest)
    fail_input(where(element), fmt::format("{} is no {}", shown(text), what), kMend);
  return static_cast<long>(value);
}

std::vector<long> XmlFile::integers(pugi::xml_node element, std::string_view text, const char* what,
                                    long low) const {
  std::vector<long> values;
  each_word(text,
            [&](std::string_view word) { values.push_back(integer(element, word, what, low)); });
  return values;
}

std::string_view text_of(pugi::xml_node element) {
  return element.child_value();
}

std::string_view attribute(pugi::xml_node element, const char* name) {
  return element.attribute(name).value();
}

std::optional<int> number_of_region(std::string_view name) {
  constexpr std::string_view kPrefix = "region_";
  if (name.size() <= kPrefix.size()) return std::nullopt;
  for (std::size_t i = 0; i < kPrefix.size(); ++i)
    if ((name[i] | 0x20) != (kPrefix[i] | 0x20)) return std::nullopt;
  double number = 0;
  if (!parse_number(name.substr(kPrefix.size()), number) || !(number >= 0 && number < 1e6) ||
      number != std::floor(number))
    return std::nullopt;
  return static_cast<int>(number);
}

bool is_xml_of(const std::string& bytes, std::string_view element) {
  std::string_view rest = std::string_view(bytes).substr(0, 65536);
  if (rest.starts_with("\xEF\xBB\xBF")) rest.remove_prefix(3);
  while (true) {  // declarations and comments may stand before it
    const std::size_t at = rest.find_first_not_of(" \t\r\n");
    if (at == rest.npos || rest[at] != '<') return false;
    rest.remove_prefix(at + 1);
    if (!rest.starts_with('?') && !rest.starts_with('!')) break;
    const std::string_view close = rest.starts_with("!--") ? "-->" : ">";
    const std::size_t end = rest.find(close);
    if (end == rest.npos) return false;
    rest.remove_prefix(end + close.size());
  }
  if (!rest.starts_with(element)) return false;
  rest.remove_prefix(element.size());
  return !rest.empty() && std::string_view(" \t\r\n/>").find(rest[0]) != rest.npos;
}

}  // namespace hapsim
