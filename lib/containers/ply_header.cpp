#include <charconv>

#include "base/error.h"
#include "containers/ply_types.h"
#include "io/number.h"

namespace hapsim::ply {
namespace {

constexpr std::size_t kMostColumns = 1000;  // elements, and properties of one: more is garbage
constexpr const char* kGarbage = "the file is damaged; write it again";

class HeaderParser {
 public:
  HeaderParser(const std::string& bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  PlyFile parse(std::size_t& body, long& body_line) {
    if (next_line() != "ply") fail("the file does not begin with 'ply'", "a PLY file is needed");
    bool has_format = false;
    while (true) {
      const std::string_view line = next_line();
      const std::vector<std::string> words = split(line);
      if (words.empty()) continue;
      if (words[0] == "end_header") break;
      if (words[0] == "comment")
        file_.comments.emplace_back(line.size() > 8 ? line.substr(8) : "");
      else if (words[0] == "format")
        has_format = read_format(words);
      else if (words[0] == "element")
        read_element(words);
      else if (words[0] == "property")
        read_property(words);
      else if (words[0] != "obj_info")
        fail("unknown header line " + shown(line),
             "known are: format comment obj_info element property end_header");
    }
    if (!has_format) fail("the header has no format line", "add 'format ascii 1.0' or its like");
    body = at_;
    body_line = line_ + 1;
    return std::move(file_);
  }

 private:
  [[noreturn]] void fail(const std::string& wrong, const std::string& mend) const {
    fail_input(name_ + ":" + std::to_string(line_), wrong, mend);
  }

  std::string_view next_line() {
    const std::size_t end = bytes_.find('\n', at_);
    if (end == bytes_.npos)
      fail_input(name_, "the PLY header is truncated: there is no 'end_header'",
                 "copy or write the file again");
    std::string_view line(bytes_.data() + at_, end - at_);
    at_ = end + 1;
    ++line_;
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    return line;
  }

  static std::vector<std::string> split(std::string_view line) {
    std::vector<std::string> words;
    for (line = trim(line); !line.empty(); line = trim(line)) {
      const std::size_t length = std::min(line.find_first_of(" \t"), line.size());
      words.emplace_back(line.substr(0, length));
      line.remove_prefix(length);
    }
    return words;
  }

  bool read_format(const std::vector<std::string>& words) {
    if (words.size() != 3 || words[2] != "1.0") fail("the format is not version 1.0", "convert it");
    if (words[1] == "ascii")
      file_.format = PlyFormat::kAscii;
    else if (words[1] == "binary_little_endian")
      file_.format = PlyFormat::kBinaryLittle;
    else if (words[1] == "binary_big_endian")
      file_.format = PlyFormat::kBinaryBig;
    else
      fail("unknown format " + shown(words[1]),
           "known are: ascii binary_little_endian binary_big_endian");
    return true;
  }

  void read_element(const std::vector<std::string>& words) {
    PlyElement element;
    if (words.size() != 3) fail("an element line is 'element NAME COUNT'", "mend the line");
    element.name = words[1];
    const char* end = words[2].data() + words[2].size();
    const auto [stop, error] = std::from_chars(words[2].data(), end, element.count);
    if (stop != end || error != std::errc())
      fail("the count of element " + shown(element.name) + " is " + shown(words[2]),
           "it must be a whole number, 0 or more");
    if (file_.elements.size() >= kMostColumns) fail("there are too many elements", kGarbage);
    if (file_.find(element.name) != nullptr)
      fail("element " + shown(element.name) + " is declared twice", "remove one");
    file_.elements.push_back(std::move(element));
  }

  PlyType type(const std::string& word) const {
    const TypeInfo* found = find_type(word);
    if (found == nullptr)
      fail("unknown type " + shown(word),
           "known are: char uchar short ushort int uint float double (or int8 ... float64)");
    return found->type;
  }

  void read_property(const std::vector<std::string>& words) {
    if (file_.elements.empty()) fail("a property precedes every element", "reorder the header");
    PlyElement& element = file_.elements.back();
    PlyProperty property;
    property.is_list = words.size() == 5 && words[1] == "list";
    if (!property.is_list && words.size() != 3)
      fail("a property line is 'property TYPE NAME' or 'property list TYPE TYPE NAME'",
           "mend the line");
    if (property.is_list) {
      property.count_type = type(words[2]);
      if (!is_integer(property.count_type))
        fail("a list is counted by the type " + shown(words[2]), "use an integer type");
    }
    property.type = type(words[words.size() - 2]);
    property.name = words.back();
    if (element.properties.size() >= kMostColumns) fail("there are too many properties", kGarbage);
    if (element.find(property.name) != nullptr)
      fail("property " + shown(property.name) + " is declared twice", "remove one");
    element.properties.push_back(std::move(property));
  }

  const std::string& bytes_;
  const std::string& name_;
  PlyFile file_;
  std::size_t at_ = 0;
  long line_ = 0;
};

}  // namespace

PlyFile parse_header(const std::string& bytes, const std::string& name, std::size_t& body,
                     long& body_line) {
  return HeaderParser(bytes, name).parse(body, body_line);
}

}  // namespace hapsim::ply

namespace hapsim {

bool is_ply(const std::string& bytes) {
  return bytes.starts_with("ply\n") || bytes.starts_with("ply\r");
}

std::vector<std::string> ply_comments(const std::string& bytes) {
  if (!is_ply(bytes)) return {};
  std::size_t body = 0;
  long line = 0;
  return ply::parse_header(bytes, "", body, line).comments;
}

}  // namespace hapsim
