// Files of XML that hold meshes: private to format_febio.cpp and format_sofa.cpp.
#pragma once

#include <algorithm>
#include <optional>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace hapsim {

class XmlFile {
 public:
  // Error(kBadInput) with the line when `bytes` are not well formed.
  XmlFile(const std::string& bytes, const std::string& name);

  pugi::xml_node root() const { return document_.document_element(); }
  // `name:line` of an element.
  std::string where(pugi::xml_node element) const;
  // Numbers between blanks, commas and semicolons; `what` names one in messages of `element`.
  std::vector<double> numbers(pugi::xml_node element, std::string_view text,
                              const char* what) const;
  // One whole number of at least `low`, and all of a text.
  long integer(pugi::xml_node element, std::string_view text, const char* what, long low) const;
  std::vector<long> integers(pugi::xml_node element, std::string_view text, const char* what,
                             long low) const;

 private:
  std::string line_of(std::ptrdiff_t offset) const;

  const std::string& bytes_;
  std::string name_;
  pugi::xml_document document_;
};

// Calls `take` with every word between blanks, commas and semicolons.
template <class Take>
void each_word(std::string_view text, const Take& take) {
  constexpr std::string_view kBetween = " \t\r\n,;";
  for (std::size_t at = text.find_first_not_of(kBetween); at != text.npos;) {
    const std::size_t end = std::min(text.find_first_of(kBetween, at), text.size());
    take(text.substr(at, end - at));
    at = text.find_first_not_of(kBetween, end);
  }
}

// The element's text, without what is inside other elements.
std::string_view text_of(pugi::xml_node element);
std::string_view attribute(pugi::xml_node element, const char* name);  // "" when there is none
// K of a part named region_K, in any case.
std::optional<int> number_of_region(std::string_view name);

// Whether the bytes are XML whose first element is `element`.
bool is_xml_of(const std::string& bytes, std::string_view element);

}  // namespace hapsim
