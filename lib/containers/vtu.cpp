#include "containers/vtu.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <string_view>

#include "base/error.h"
#include "io/number.h"

namespace hapsim {
namespace {

using Attributes = std::map<std::string, std::string, std::less<>>;

// -1: no digit of base64, -2: padding.
int base64_digit(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  if (c == '+') return 62;
  if (c == '/') return 63;
  return c == '=' ? -2 : -1;
}

// Four digits a time: VTK pads and begins anew between a header and its data. Ends at the first
// other character that is no blank.
std::string base64(std::string_view text) {
  std::string bytes;
  int quantum[4], have = 0;
  for (const char c : text) {
    if (c == ' ' || c == '\n' || c == '\r' || c == '\t') continue;
    const int digit = base64_digit(c);
    if (digit == -1) break;
    quantum[have++] = digit;
    if (have < 4) continue;
    have = 0;
    if (quantum[0] < 0 || quantum[1] < 0) break;
    const unsigned all = static_cast<unsigned>(quantum[0]) << 18 |
                         static_cast<unsigned>(quantum[1]) << 12 |
                         static_cast<unsigned>(std::max(quantum[2], 0)) << 6 |
                         static_cast<unsigned>(std::max(quantum[3], 0));
    bytes.push_back(static_cast<char>(all >> 16));
    if (quantum[2] >= 0) bytes.push_back(static_cast<char>(all >> 8));
    if (quantum[3] >= 0) bytes.push_back(static_cast<char>(all));
  }
  return bytes;
}

struct Type {
  std::size_t size;
  double (*read)(const char* bytes);
};

template <class T>
double read_as(const char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return static_cast<double>(value);
}

const Type* type_of(std::string_view name) {
  static const std::map<std::string_view, Type> types{
      {"Int8", {1, read_as<std::int8_t>}},   {"UInt8", {1, read_as<std::uint8_t>}},
      {"Int16", {2, read_as<std::int16_t>}}, {"UInt16", {2, read_as<std::uint16_t>}},
      {"Int32", {4, read_as<std::int32_t>}}, {"UInt32", {4, read_as<std::uint32_t>}},
      {"Int64", {8, read_as<std::int64_t>}}, {"UInt64", {8, read_as<std::uint64_t>}},
      {"Float32", {4, read_as<float>}},      {"Float64", {8, read_as<double>}}};
  const auto found = types.find(name);
  return found == types.end() ? nullptr : &found->second;
}

class VtuReader {
 public:
  VtuReader(const std::string& bytes, const std::string& name) : text_(bytes), name_(name) {}

  std::vector<VtuPiece> read() {
    find_appended();
    std::vector<VtuArray>* section = nullptr;
    while (next_tag()) {
      if (tag_ == "VTKFile") {
        read_head();
      } else if (tag_ == "Piece") {
        section = nullptr;  // one that was left open is of another piece
        VtuPiece& piece = pieces_.emplace_back();
        piece.points = count("NumberOfPoints");
        piece.cells = count("NumberOfCells");
      } else if (tag_ == "Points" || tag_ == "Cells" || tag_ == "PointData" || tag_ == "CellData") {
        section = section_of(tag_);
      } else if (tag_.starts_with("/")) {
        if (tag_ != "/DataArray") section = nullptr;
      } else if (tag_ == "DataArray" && section != nullptr) {
        read_array(*section);
      } else if (tag_ == "AppendedData") {
        break;
      }
    }
    if (!is_grid_) fail("this is no VTK unstructured grid");
    if (pieces_.empty()) fail("the file is truncated: there is no Piece");
    return std::move(pieces_);
  }

 private:
  [[noreturn]] void fail(const std::string& wrong) const {
    const auto line =
        1 + std::count(text_.begin(),
                       text_.begin() + static_cast<std::ptrdiff_t>(std::min(at_, end_)), '\n');
    fail_input(fmt::format("{}:{}", name_, line), wrong, "write the mesh again");
  }

  // Raw bytes may follow the tag: nothing behind it is looked at as XML.
  void find_appended() {
    end_ = text_.size();
    const std::size_t tag = text_.find("<AppendedData");
    if (tag == text_.npos) return;
    const std::size_t close = text_.find('>', tag);
    const std::size_t mark = close == text_.npos ? close : text_.find('_', close);
    if (mark == text_.npos) fail("the appended data do not begin with '_'");
    appended_raw_ = text_.substr(tag, close - tag).find("base64") == text_.npos;
    appended_ = text_.substr(mark + 1);
    end_ = close + 1;
  }

  // The next tag's name and attributes; comments and declarations are passed over.
  bool next_tag() {
    while (true) {
      at_ = text_.find('<', at_);
      if (at_ >= end_) return false;
      if (text_.substr(at_, 4) == "<!--") {
        at_ = text_.find("-->", at_);
        if (at_ >= end_) return false;
        continue;
      }
      std::size_t close = at_ + 1;
      for (char quote = '\0'; close < end_ && (quote != '\0' || text_[close] != '>'); ++close) {
        if (quote != '\0') {
          if (text_[close] == quote) quote = '\0';
        } else if (text_[close] == '"' || text_[close] == '\'') {
          quote = text_[close];
        }
      }
      if (close >= end_) fail("the file is truncated within a tag");
      parse_tag(text_.substr(at_ + 1, close - at_ - 1));
      at_ = close + 1;
      if (!tag_.starts_with("?") && !tag_.starts_with("!")) return true;
    }
  }

  void parse_tag(std::string_view inside) {
    constexpr const char* kBlank = " \t\r\n";
    empty_tag_ = inside.ends_with('/');
    if (empty_tag_) inside.remove_suffix(1);
    std::size_t i = std::min(inside.find_first_of(kBlank), inside.size());
    tag_ = inside.substr(0, i);
    attributes_.clear();
    while ((i = inside.find_first_not_of(kBlank, i)) < inside.size()) {
      const std::size_t equal = inside.find('=', i);
      if (equal == inside.npos) return;
      const std::size_t open = inside.find_first_of("\"'", equal);
      if (open == inside.npos) return;
      const std::size_t close = inside.find(inside[open], open + 1);
      if (close == inside.npos) return;
      attributes_[std::string(trim(inside.substr(i, equal - i)))] =
          inside.substr(open + 1, close - open - 1);
      i = close + 1;
    }
  }

  std::string attribute(const char* name, const char* otherwise) const {
    const auto found = attributes_.find(name);
    return found == attributes_.end() ? otherwise : found->second;
  }

  std::size_t count(const char* name, double otherwise = -1) const {
    double value = otherwise;
    const std::string text = attribute(name, "");
    if (!text.empty() && !parse_number(text, value)) value = -1;
    if (!(value >= 0 && value < 9e15) ||
        value != static_cast<double>(static_cast<std::size_t>(value)))
      fail(fmt::format("{} of {} is {}", name, tag_, text.empty() ? "missing" : shown(text)));
    return static_cast<std::size_t>(value);
  }

  void read_head() {
    is_grid_ = attribute("type", "") == "UnstructuredGrid";
    if (!is_grid_)
      fail("this is no VTK unstructured grid but " + shown(attribute("type", "nothing")));
    swap_ = (attribute("byte_order", "LittleEndian") == "BigEndian") !=
            (std::endian::native == std::endian::big);
    header_ = attribute("header_type", "UInt32") == "UInt64" ? 8 : 4;
    const std::string compressor = attribute("compressor", "");
    compressed_ = !compressor.empty();
    if (compressed_ && compressor != "vtkZLibDataCompressor")
      fail("arrays are compressed by " + shown(compressor) + "; zlib and plain are read");
  }

  std::vector<VtuArray>* section_of(std::string_view tag) {
    if (pieces_.empty()) fail(fmt::format("{} outside of a Piece", tag));
    VtuPiece& piece = pieces_.back();
    if (tag == "Points") return &piece.position;
    if (tag == "Cells") return &piece.cell;
    return tag == "PointData" ? &piece.point_data : &piece.cell_data;
  }

  void read_array(std::vector<VtuArray>& section) {
    const std::string type_name = attribute("type", ""), format = attribute("format", "ascii");
    VtuArray array;
    array.name = attribute("Name", "");
    array.components = std::max<std::size_t>(count("NumberOfComponents", 1), 1);
    const Type* type = type_of(type_name);
    const std::size_t begin = at_;
    std::string_view inside;
    if (!empty_tag_) {
      const std::size_t close = text_.find("</DataArray", begin);
      if (close >= end_) fail("the file is truncated within array " + shown(array.name));
      inside = text_.substr(begin, close - begin);
    }
    if (type == nullptr) return;  // strings and the like are none of a mesh's numbers
    if (format == "ascii")
      read_text(inside, array);
    else if (format == "binary")
      read_bytes(base64(inside), *type, array);
    else if (format == "appended")
      read_appended(*type, array);
    else
      fail("array " + shown(array.name) + " has the unknown format " + shown(format));
    section.push_back(std::move(array));
    at_ = begin + inside.size();
  }

  void read_text(std::string_view inside, VtuArray& array) {
    constexpr const char* kBlank = " \t\r\n";
    for (std::size_t i = 0; (i = inside.find_first_not_of(kBlank, i)) < inside.size();) {
      const std::size_t end = std::min(inside.find_first_of(kBlank, i), inside.size());
      double value;
      const std::string_view word = inside.substr(i, end - i);
      if (!parse_number(word, value)) {
        at_ += i;
        fail(shown(word) + " in array " + shown(array.name) + " is no finite number");
      }
      array.values.push_back(value);
      i = end;
    }
  }

  void read_appended(const Type& type, VtuArray& array) {
    const std::size_t offset = count("offset");
    if (offset >= appended_.size())
      fail("array " + shown(array.name) + " begins behind the end of the file; it is truncated");
    const std::string_view from = appended_.substr(offset);
    if (appended_raw_)
      read_bytes(from, type, array);
    else
      read_bytes(base64(from), type, array);
  }

  [[noreturn]] void fail_short(const VtuArray& array) const {
    fail("array " + shown(array.name) + " is shorter than it claims; the file is truncated");
  }

  std::size_t header(std::string_view& bytes, const VtuArray& array) const {
    if (bytes.size() < header_) fail_short(array);
    char raw[8] = {};
    std::memcpy(raw, bytes.data(), header_);
    if (swap_) std::reverse(raw, raw + header_);
    bytes.remove_prefix(header_);
    std::uint64_t value = 0;
    std::memcpy(&value, raw, header_);
    return value;
  }

  void read_bytes(std::string_view bytes, const Type& type, VtuArray& array) const {
    if (!compressed_) {
      const std::size_t size = header(bytes, array);
      if (size > bytes.size()) fail_short(array);
      return convert(bytes.substr(0, size), type, array);
    }
    const std::size_t blocks = header(bytes, array), full = header(bytes, array),
                      last = header(bytes, array);
    if (blocks > bytes.size() / header_) fail_short(array);
    std::vector<std::size_t> sizes;
    for (std::size_t b = 0; b < blocks; ++b) sizes.push_back(header(bytes, array));
    std::string plain;
    for (std::size_t b = 0; b < blocks; ++b) {
      if (sizes[b] > bytes.size()) fail_short(array);
      // zlib gains no more than a factor of about 1030.
      const std::size_t size = b + 1 == blocks && last > 0 ? last : full;
      if (size > 1100 * sizes[b] + 100)
        fail("array " + shown(array.name) + " claims more than its bytes can hold");
      const std::size_t old = plain.size();
      plain.resize(old + size);
      uLongf got = size;
      if (uncompress(reinterpret_cast<Bytef*>(plain.data() + old), &got,
                     reinterpret_cast<const Bytef*>(bytes.data()), sizes[b]) != Z_OK ||
          got != size)
        fail("array " + shown(array.name) + " cannot be uncompressed");
      bytes.remove_prefix(sizes[b]);
    }
    convert(plain, type, array);
  }

  void convert(std::string_view bytes, const Type& type, VtuArray& array) const {
    array.values.reserve(bytes.size() / type.size);
    char raw[8];
    for (std::size_t i = 0; i + type.size <= bytes.size(); i += type.size) {
      std::memcpy(raw, bytes.data() + i, type.size);
      if (swap_) std::reverse(raw, raw + type.size);
      array.values.push_back(type.read(raw));
    }
  }

  std::string_view text_;
  const std::string& name_;
  std::vector<VtuPiece> pieces_;
  std::size_t at_ = 0, end_ = 0, header_ = 4;
  std::string_view appended_;
  std::string_view tag_;
  Attributes attributes_;
  bool appended_raw_ = true, empty_tag_ = false, is_grid_ = false, swap_ = false,
       compressed_ = false;
};

}  // namespace

std::vector<VtuPiece> parse_vtu(const std::string& bytes, const std::string& name) {
  return VtuReader(bytes, name).read();
}

const VtuArray* find_array(const std::vector<VtuArray>& arrays, const std::string& name) {
  for (const VtuArray& array : arrays)
    if (array.name == name) return &array;
  return nullptr;
}

}  // namespace hapsim
