#include "containers/stl.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <ostream>

#include "base/error.h"
#include "io/number.h"
#include "io/wrapped.h"

namespace hapsim {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr std::size_t kHeader = 84;  // 80 bytes of text, then the number of triangles
constexpr std::size_t kFacet = 50;   // normal, three corners (float32), two bytes

void check_finite(const std::string& where, const Vec3& point, std::size_t triangle) {
  if (point.allFinite()) return;
  fail_input(where,
             "a corner of triangle " + std::to_string(triangle) + " (counted from 0) is not finite",
             "remove the triangle");
}

std::uint32_t claimed_triangles(const std::string& bytes) {
  std::uint32_t n = 0;
  std::memcpy(&n, bytes.data() + 80, sizeof n);
  return n;
}

TriangleSoup parse_binary(const std::string& bytes, const std::string& name) {
  const std::size_t n = claimed_triangles(bytes);
  if (n != (bytes.size() - kHeader) / kFacet || (bytes.size() - kHeader) % kFacet != 0)
    fail_input(name,
               "the file claims " + std::to_string(n) + " triangles (" +
                   std::to_string(kHeader + n * kFacet) + " bytes) and has " +
                   std::to_string(bytes.size()) + " bytes",
               "it is truncated or no STL; copy or write it again");
  TriangleSoup soup(n);
  for (std::size_t i = 0; i < n; ++i) {
    float corners[9];
    std::memcpy(corners, bytes.data() + kHeader + i * kFacet + 12, sizeof corners);
    for (std::size_t k = 0; k < 3; ++k) {
      soup[i][k] = Vec3(corners[3 * k], corners[3 * k + 1], corners[3 * k + 2]);
      check_finite(name, soup[i][k], i);
    }
  }
  return soup;
}

class AsciiParser {
 public:
  AsciiParser(const std::string& bytes, const std::string& name) : rest_(bytes), name_(name) {}

  TriangleSoup parse() {
    TriangleSoup soup;
    while (skip_blanks(), !rest_.empty()) {
      expect("solid");
      skip_line();  // the solid's name
      std::string_view next;
      while (is(next = word(), "facet")) read_facet(soup);
      if (!is(next, "endsolid")) fail("'facet' or 'endsolid'", next);
      skip_line();
    }
    return soup;
  }

 private:
  std::string where() const { return name_ + ":" + std::to_string(line_); }

  [[noreturn]] void fail(const std::string& expected, std::string_view found) const {
    if (found.empty())
      fail_input(where(), "the file is truncated: " + expected + " should follow",
                 "copy or write it again");
    fail_input(where(), shown(found) + " stands where " + expected + " should",
               "write the file again");
  }

  void read_facet(TriangleSoup& soup) {
    expect("normal");
    for (int k = 0; k < 3; ++k) word();  // computed again from the corners; some writers put nan
    expect("outer");
    expect("loop");
    std::array<Vec3, 3> corners;
    for (Vec3& corner : corners) {
      expect("vertex");
      for (int k = 0; k < 3; ++k) corner[k] = coordinate();
    }
    expect("endloop");
    expect("endfacet");
    soup.push_back(corners);
  }

  double coordinate() {
    const std::string_view text = word();
    double value;
    if (!parse_number(text, value)) fail("a finite coordinate", text);
    return value;
  }

  void expect(const char* keyword) {
    const std::string_view found = word();
    if (!is(found, keyword)) fail("'" + std::string(keyword) + "'", found);
  }

  static bool is(std::string_view found, std::string_view keyword) {
    if (found.size() != keyword.size()) return false;
    for (std::size_t i = 0; i < found.size(); ++i)
      if ((found[i] | 0x20) != keyword[i]) return false;  // upper case is met too
    return true;
  }

  std::string_view word() {
    skip_blanks();
    std::size_t length = 0;
    while (length < rest_.size() && !is_blank(rest_[length])) ++length;
    const std::string_view found = rest_.substr(0, length);
    rest_.remove_prefix(length);
    return found;
  }

  void skip_line() { rest_.remove_prefix(std::min(rest_.find('\n'), rest_.size())); }

  void skip_blanks() {
    for (; !rest_.empty() && is_blank(rest_[0]); rest_.remove_prefix(1))
      if (rest_[0] == '\n') ++line_;
  }

  static bool is_blank(char c) { return c == ' ' || c == '\n' || c == '\r' || c == '\t'; }

  std::string_view rest_;
  const std::string& name_;
  long line_ = 1;
};

Vec3 normal_of(const std::array<Vec3, 3>& corners) {
  const Vec3 edge = corners[1] - corners[0], other = corners[2] - corners[0];
  const Vec3 area(edge.y() * other.z() - edge.z() * other.y(),
                  edge.z() * other.x() - edge.x() * other.z(),
                  edge.x() * other.y() - edge.y() * other.x());
  const double length = area.norm();
  return length > 0 ? Vec3(area / length) : Vec3(Vec3::Zero());
}

bool has_claimed_size(const std::string& bytes) {
  return bytes.size() >= kHeader &&
         bytes.size() == kHeader + std::size_t{claimed_triangles(bytes)} * kFacet;
}

// A binary header may begin with "solid" too: its size tells.
bool is_binary(const std::string& bytes) {
  if (has_claimed_size(bytes)) return true;
  const std::string_view text = bytes;
  const std::size_t first = std::min(text.find_first_not_of(" \t\r\n"), text.size());
  const std::string_view head = text.substr(first, 512);
  const bool says_solid = head.substr(0, 5) == "solid" || head.substr(0, 5) == "SOLID";
  return !says_solid || head.find('\0') != head.npos;
}

}  // namespace

TriangleSoup parse_stl(const std::string& bytes, const std::string& name) {
  if (bytes.empty()) fail_input(name, "the file is empty", "an STL file is needed");
  const bool binary = is_binary(bytes);
  if (binary && !has_claimed_size(bytes)) refuse_wrapped(name, bytes);
  if (binary && bytes.size() < kHeader)
    fail_input(name, "this is no STL file: it neither begins with 'solid' nor has 84 bytes",
               "an STL file is needed");
  TriangleSoup soup = binary ? parse_binary(bytes, name) : AsciiParser(bytes, name).parse();
  if (soup.empty()) fail_input(name, "there is no triangle", "export the surface again");
  return soup;
}

void write_stl_binary(std::ostream& out, const TriangleSoup& soup) {
  if (soup.size() > UINT32_MAX)
    fail_input("", "STL cannot hold more than 4294967295 triangles", "write PLY");
  std::string bytes = "binary STL by hapsim";
  bytes.resize(80, ' ');
  const auto put = [&bytes](auto value) {
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    bytes.append(raw, sizeof value);
  };
  bytes.reserve(kHeader + soup.size() * kFacet);
  put(static_cast<std::uint32_t>(soup.size()));
  for (const auto& corners : soup) {
    for (const Vec3& v : {normal_of(corners), corners[0], corners[1], corners[2]})
      for (int k = 0; k < 3; ++k) put(static_cast<float>(v[k]));
    put(std::uint16_t{0});
  }
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

void write_stl_ascii(std::ostream& out, const TriangleSoup& soup) {
  const auto three = [](const Vec3& v) {
    return format_number(v.x()) + ' ' + format_number(v.y()) + ' ' + format_number(v.z());
  };
  out << "solid hapsim\n";
  for (const auto& corners : soup) {
    out << "facet normal " << three(normal_of(corners)) << "\nouter loop\n";
    for (const Vec3& corner : corners) out << "vertex " << three(corner) << '\n';
    out << "endloop\nendfacet\n";
  }
  out << "endsolid hapsim\n";
}

}  // namespace hapsim
