#include <bit>
#include <charconv>
#include <cmath>

#include "base/error.h"
#include "containers/byte_order.h"
#include "containers/ply_types.h"
#include "io/number.h"

namespace hapsim {
namespace {

static_assert(std::endian::native == std::endian::little);

// The body of an ASCII file: values separated by blanks and line ends.
class AsciiSource {
 public:
  AsciiSource(const std::string& bytes, std::size_t at, long line, const std::string& name)
      : at_(bytes.data() + at), end_(bytes.data() + bytes.size()), line_(line), name_(name) {}

  std::string where() const { return name_ + ":" + std::to_string(line_); }
  std::size_t bytes_left() const { return static_cast<std::size_t>(end_ - at_); }
  // A value takes at least a digit and a blank; the last one may lack the blank.
  static std::size_t least_size(PlyType) { return 2; }
  bool holds(std::size_t count, std::size_t size) const {
    return count <= (bytes_left() + 1) / size;
  }
  bool ready(PlyType) {
    skip_blanks();
    return !at_end();
  }

  double read(PlyType type) {
    const char* start = at_;
    while (at_ < end_ && !is_blank(*at_)) ++at_;
    const std::string_view word(start, static_cast<std::size_t>(at_ - start));
    double value;
    if (!parse_number(word, value)) {
      // Not finite: well-formed where it is no coordinate.
      const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
      if (stop != at_ || error == std::errc::invalid_argument || ply::is_integer(type))
        fail_input(where(), shown(word) + " is not a number", "write the file again");
      return error == std::errc() ? value : INFINITY;
    }
    const ply::TypeInfo& info = ply::info(type);
    if (ply::is_integer(type) &&
        (value < info.lowest || value > info.highest || value != std::floor(value)))
      fail_input(where(), shown(word) + " is no value of the type '" + info.name + "'",
                 "declare another type in the header");
    return value;
  }

  void skip_blanks() {
    for (; at_ < end_ && is_blank(*at_); ++at_)
      if (*at_ == '\n') ++line_;
  }
  bool at_end() const { return at_ == end_; }

 private:
  static bool is_blank(char c) { return c == ' ' || c == '\n' || c == '\r' || c == '\t'; }

  const char* at_;
  const char* end_;
  long line_;
  const std::string& name_;
};

// The body of a binary file.
class BinarySource {
 public:
  BinarySource(const std::string& bytes, std::size_t at, bool swap, const std::string& name)
      : bytes_(bytes), at_(at), swap_(swap), name_(name) {}

  std::string where() const { return name_ + ": byte " + std::to_string(at_); }
  std::size_t bytes_left() const { return bytes_.size() - at_; }
  static std::size_t least_size(PlyType type) { return ply::info(type).size; }
  bool holds(std::size_t count, std::size_t size) const { return count <= bytes_left() / size; }
  bool ready(PlyType type) const { return bytes_left() >= least_size(type); }

  double read(PlyType type) {
    return ply::with_type(type, [this](auto value) {
      std::memcpy(&value, bytes_.data() + at_, sizeof value);
      at_ += sizeof value;
      if (swap_) swap_bytes(value);
      return static_cast<double>(value);
    });
  }

  void skip_blanks() {
    while (at_ < bytes_.size() && std::strchr(" \r\n\t", bytes_[at_]) != nullptr &&
           bytes_[at_] != 0)
      ++at_;
  }
  bool at_end() const { return at_ == bytes_.size(); }

 private:
  const std::string& bytes_;
  std::size_t at_;
  bool swap_;
  const std::string& name_;
};

template <class Source>
class BodyReader {
 public:
  BodyReader(Source source, PlyFile& file) : source_(std::move(source)), file_(file) {}

  void read() {
    for (PlyElement& element : file_.elements) read_element(element);
    source_.skip_blanks();
    if (!source_.at_end())
      fail_input(source_.where(),
                 std::to_string(source_.bytes_left()) + " bytes follow the last element",
                 "the counts in the header are wrong; write the file again");
  }

 private:
  // Before memory is taken for `count` things of at least `size` bytes.
  void require(std::size_t count, std::size_t size, const std::string& what) {
    if (!source_.holds(count, size)) fail_truncated(count, what);
  }

  [[noreturn]] void fail_truncated(std::size_t count, const std::string& what) {
    fail_input(source_.where(),
               "the file is truncated: " + std::to_string(source_.bytes_left()) +
                   " bytes are left for " + std::to_string(count) + " " + what,
               "copy or write the file again");
  }

  void read_element(PlyElement& element) {
    std::size_t item_size = 0;
    for (const PlyProperty& p : element.properties)
      item_size += source_.least_size(p.is_list ? p.count_type : p.type);
    if (item_size == 0) {
      if (element.count > 0)
        fail_input(source_.where(), "element " + shown(element.name) + " has no property",
                   "remove it from the header");
      return;
    }
    require(element.count, item_size, "items of element " + shown(element.name));
    for (PlyProperty& p : element.properties) {
      if (!p.is_list) p.values.reserve(element.count);
      if (p.is_list) p.offset.reserve(element.count + 1);
      if (p.is_list) p.offset.push_back(0);
    }
    const bool is_vertex = element.name == "vertex";
    for (std::size_t item = 0; item < element.count; ++item)
      for (PlyProperty& p : element.properties) {
        if (p.is_list) {
          read_list(p);
          continue;
        }
        p.values.push_back(read_value(p.type, p.name));
        if (is_vertex && !std::isfinite(p.values.back())) check_coordinate(p, item);
      }
  }

  double read_value(PlyType type, const std::string& property) {
    if (!source_.ready(type)) fail_truncated(1, "value of property " + shown(property));
    return source_.read(type);
  }

  void read_list(PlyProperty& p) {
    const double count = read_value(p.count_type, p.name);
    if (count < 0)
      fail_input(source_.where(),
                 "a list " + shown(p.name) + " has " + format_number(count) + " entries",
                 "write the file again");
    const auto n = static_cast<std::size_t>(count);
    require(n, source_.least_size(p.type), "entries of a list " + shown(p.name));
    for (std::size_t k = 0; k < n; ++k) p.values.push_back(read_value(p.type, p.name));
    p.offset.push_back(p.values.size());
  }

  void check_coordinate(const PlyProperty& p, std::size_t item) {
    if (p.name != "x" && p.name != "y" && p.name != "z") return;
    fail_input(source_.where(),
               p.name + " of vertex " + std::to_string(item) + " (counted from 0) is " +
                   format_number(p.values.back()),
               "remove the vertex or give it a finite coordinate");
  }

  Source source_;
  PlyFile& file_;
};

}  // namespace

PlyFile parse_ply(const std::string& bytes, const std::string& name) {
  std::size_t body = 0;
  long line = 0;
  PlyFile file = ply::parse_header(bytes, name, body, line);
  if (file.format == PlyFormat::kAscii) {
    BodyReader(AsciiSource(bytes, body, line, name), file).read();
  } else {
    const bool swap = file.format == PlyFormat::kBinaryBig;
    BodyReader(BinarySource(bytes, body, swap, name), file).read();
  }
  return file;
}

}  // namespace hapsim
