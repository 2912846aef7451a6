#include <fmt/format.h>

#include <cassert>
#include <cmath>
#include <ostream>

#include "containers/byte_order.h"
#include "containers/ply_types.h"
#include "io/number.h"

namespace hapsim {
namespace {

using ply::is_integer;

constexpr std::size_t kBlock = 1 << 20;  // bytes gathered before they are written

class BodyWriter {
 public:
  BodyWriter(std::ostream& out, PlyFormat format) : out_(out), format_(format) {}

  void write(const PlyElement& element) {
    for (std::size_t item = 0; item < element.count; ++item) {
      for (const PlyProperty& p : element.properties) {
        if (!p.is_list) {
          put(p.type, p.values[item]);
          continue;
        }
        put(p.count_type, static_cast<double>(p.offset[item + 1] - p.offset[item]));
        for (std::size_t k = p.offset[item]; k < p.offset[item + 1]; ++k) put(p.type, p.values[k]);
      }
      if (format_ == PlyFormat::kAscii) text_.back() = '\n';
      if (text_.size() >= kBlock) flush();
    }
    flush();
  }

 private:
  void put(PlyType type, double value) {
    assert(!is_integer(type) ||
           (value >= ply::info(type).lowest && value <= ply::info(type).highest));
    if (format_ == PlyFormat::kAscii) {
      text_ += type == PlyType::kFloat32 ? fmt::format("{}", static_cast<float>(value))
                                         : format_number(value);
      text_ += ' ';
      return;
    }
    ply::with_type(type, [&](auto zero) {
      auto binary = static_cast<decltype(zero)>(value);
      if (format_ == PlyFormat::kBinaryBig) swap_bytes(binary);
      char bytes[sizeof binary];
      std::memcpy(bytes, &binary, sizeof binary);
      text_.append(bytes, sizeof binary);
    });
  }

  void flush() {
    out_.write(text_.data(), static_cast<std::streamsize>(text_.size()));
    text_.clear();
  }

  std::ostream& out_;
  PlyFormat format_;
  std::string text_;
};

void write_header(std::ostream& out, const PlyFile& file) {
  constexpr const char* kFormats[] = {"ascii", "binary_little_endian", "binary_big_endian"};
  out << "ply\nformat " << kFormats[static_cast<int>(file.format)] << " 1.0\n";
  for (std::string comment : file.comments) {
    for (char& c : comment)
      if (c == '\n' || c == '\r') c = ' ';
    out << "comment " << comment << '\n';
  }
  for (const PlyElement& element : file.elements) {
    out << "element " << element.name << ' ' << element.count << '\n';
    for (const PlyProperty& p : element.properties) {
      out << "property ";
      if (p.is_list) out << "list " << ply::info(p.count_type).name << ' ';
      out << ply::info(p.type).name << ' ' << p.name << '\n';
    }
  }
  out << "end_header\n";
}

}  // namespace

void write_ply(std::ostream& out, const PlyFile& file) {
  write_header(out, file);
  BodyWriter writer(out, file.format);
  for (const PlyElement& element : file.elements) {
    for ([[maybe_unused]] const PlyProperty& p : element.properties)
      assert(p.is_list ? p.offset.size() == element.count + 1 : p.values.size() == element.count);
    writer.write(element);
  }
}

}  // namespace hapsim
