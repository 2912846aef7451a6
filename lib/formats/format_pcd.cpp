#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <sstream>
#include <vector>

#include "base/error.h"
#include "formats/format.h"
#include "formats/pcd.h"
#include "io/number.h"

namespace hapsim {
namespace {

struct Field {
  std::string name;
  std::size_t size = 4;
  char type = 'F';
  std::size_t count = 1;
  std::size_t offset = 0;  // in a point's bytes
  std::size_t column = 0;  // in an ASCII row
};

struct Header {
  std::vector<Field> fields;
  double points = -1, width = -1, height = 1;
  std::string data;
  std::size_t begin = 0;  // of the data
  long line = 1;          // of the first data row
  std::size_t stride = 0, columns = 0;
};

class Reader {
 public:
  Reader(const std::string& bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  Header header() {
    Header h;
    std::size_t at = 0;
    for (h.line = 1; h.data.empty(); ++h.line) {
      const std::size_t end = bytes_.find('\n', at);
      if (end == std::string::npos || end - at > 100000) {
        fail_input(name_, "its PCD header does not end", "copy or export it again");
      }
      line(bytes_.substr(at, end - at), h);
      at = end + 1;
    }
    h.begin = at;
    if (h.points < 0) h.points = h.width * h.height;
    for (Field& f : h.fields) {
      f.offset = h.stride;
      f.column = h.columns;
      h.stride += f.size * f.count;
      h.columns += f.count;
    }
    if (h.fields.empty() || !(h.points >= 0)) fail(h.line, "the header names no fields or points");
    return h;
  }

  [[noreturn]] void fail(long line, const std::string& wrong) const {
    fail_input(fmt::format("{}:{}", name_, line), wrong, "copy or export it again");
  }

 private:
  void line(const std::string& text, Header& h) {
    std::istringstream words(text);
    std::string key, word;
    if (!(words >> key) || key[0] == '#') return;
    std::size_t k = 0;
    for (; words >> word; ++k) {
      if (key == "DATA") {
        h.data = word;
        return;
      }
      if (key == "FIELDS") {
        h.fields.emplace_back().name = word;
        continue;
      }
      double value = 0;
      const bool whole =
          parse_number(word, value) && value >= 0 && value == std::floor(value) && value < 1e15;
      if (key == "POINTS" || key == "WIDTH" || key == "HEIGHT") {
        if (!whole) fail(h.line, "no number of points: " + shown(word));
        (key == "POINTS" ? h.points : key == "WIDTH" ? h.width : h.height) = value;
      } else if (key == "SIZE" || key == "TYPE" || key == "COUNT") {
        if (k >= h.fields.size()) fail(h.line, key + " names more fields than FIELDS");
        field(key, word, whole ? value : -1, h.line, h.fields[k]);
      }
    }
    if ((key == "SIZE" || key == "TYPE") && k != h.fields.size()) {
      fail(h.line, key + " names fewer fields than FIELDS");
    }
  }

  void field(const std::string& key, const std::string& word, double value, long line, Field& f) {
    if (key == "TYPE") {
      if (word != "F" && word != "I" && word != "U") fail(line, "unknown type " + shown(word));
      f.type = word[0];
    } else if (key == "SIZE") {
      if (value != 1 && value != 2 && value != 4 && value != 8) {
        fail(line, "unknown size " + shown(word));
      }
      f.size = static_cast<std::size_t>(value);
    } else {
      if (!(value >= 1 && value <= 100000)) fail(line, "no count: " + shown(word));
      f.count = static_cast<std::size_t>(value);
    }
  }

  const std::string& bytes_;
  const std::string& name_;
};

template <class T>
double as(const char* at) {
  T value;
  std::memcpy(&value, at, sizeof value);
  return static_cast<double>(value);
}

double number(const Field& f, const char* at) {
  switch (f.type == 'F' ? f.size : f.size + (f.type == 'I' ? 10 : 20)) {
    case 4:
      return as<float>(at);
    case 8:
      return as<double>(at);
    case 11:
      return as<std::int8_t>(at);
    case 12:
      return as<std::int16_t>(at);
    case 14:
      return as<std::int32_t>(at);
    case 18:
      return as<std::int64_t>(at);
    case 21:
      return as<std::uint8_t>(at);
    case 22:
      return as<std::uint16_t>(at);
    case 24:
      return as<std::uint32_t>(at);
    case 28:
      return as<std::uint64_t>(at);
    default:
      return NAN;
  }
}

// LZF: runs of up to 32 literal bytes, or copies of what was written up to 8 kB before.
std::string unpack_lzf(std::string_view from, std::size_t size, const std::string& name) {
  std::string to;
  const auto fail = [&name] {
    fail_input(name, "its packed points are damaged", "copy or export it again");
  };
  const auto byte = [&](std::size_t at) {
    if (at >= from.size()) fail();
    return static_cast<unsigned char>(from[at]);
  };
  for (std::size_t at = 0; at < from.size();) {
    const unsigned control = byte(at++);
    if (control < 32) {
      if (at + control + 1 > from.size()) fail();
      to.append(from.substr(at, control + 1));
      at += control + 1;
    } else {
      std::size_t length = control >> 5;
      if (length == 7) length += byte(at++);
      const std::size_t back = ((control & 31u) << 8) + byte(at++) + 1;
      if (back > to.size()) fail();
      for (std::size_t k = 0; k < length + 2; ++k) to.push_back(to[to.size() - back]);
    }
    if (to.size() > size) fail();
  }
  if (to.size() != size) fail();
  return to;
}

// The point data as rows of bytes, whatever the coding.
std::string rows_of(const Header& h, const std::string& bytes, const std::string& name) {
  const double needed = h.points * static_cast<double>(h.stride);
  const std::size_t left = bytes.size() - h.begin;
  const auto truncated = [&] {
    fail_input(name,
               fmt::format("the header claims {:.0f} points, which the file cannot hold", h.points),
               "the file is truncated; copy or export it again");
  };
  if (h.data == "binary") {
    if (needed > static_cast<double>(left)) truncated();
    return bytes.substr(h.begin, static_cast<std::size_t>(needed));
  }
  if (left < 8) truncated();
  const auto packed = static_cast<std::size_t>(as<std::uint32_t>(bytes.data() + h.begin));
  const auto size = static_cast<std::size_t>(as<std::uint32_t>(bytes.data() + h.begin + 4));
  // A copy of 264 bytes takes 3.
  if (packed > left - 8 || static_cast<double>(size) != needed ||
      needed > 90.0 * static_cast<double>(packed)) {
    truncated();
  }
  const std::string columns =
      unpack_lzf(std::string_view(bytes).substr(h.begin + 8, packed), size, name);
  // Field by field there, point by point here.
  std::string rows(size, '\0');
  const auto points = static_cast<std::size_t>(h.points);
  std::size_t at = 0;
  for (const Field& f : h.fields) {
    const std::size_t width = f.size * f.count;
    for (std::size_t i = 0; i < points; ++i, at += width) {
      std::memcpy(rows.data() + i * h.stride + f.offset, columns.data() + at, width);
    }
  }
  return rows;
}

}  // namespace

PointCloud read_pcd(const std::string& bytes, const std::string& name, std::size_t& lost) {
  Reader reader(bytes, name);
  const Header h = reader.header();
  std::vector<const Field*> used;
  for (const char* wanted : {"x", "y", "z", "normal_x", "normal_y", "normal_z"}) {
    for (const Field& f : h.fields) {
      if (f.name == wanted) used.push_back(&f);
    }
  }
  if (used.size() < 3 || used[2]->name != "z") reader.fail(h.line, "there are no fields x, y, z");
  if (used.size() != 6) used.resize(3);
  PointCloud cloud;
  lost = 0;
  const auto add = [&](const double* v) {
    const Vec3 p(v[0], v[1], v[2]);
    if (!p.allFinite()) {
      ++lost;
      return;
    }
    cloud.points.push_back(p);
    if (used.size() == 6) cloud.normals.emplace_back(v[3], v[4], v[5]);
  };
  double values[6] = {};
  if (h.data == "ascii") {
    std::istringstream lines(bytes.substr(h.begin));
    std::string text, word;
    double rows = 0;
    for (long line = h.line; rows < h.points && std::getline(lines, text); ++line, ++rows) {
      std::vector<double> row;
      std::istringstream words(text);
      while (words >> word) {
        double value = NAN;
        if (!parse_number(word, value) && word != "nan" && word != "-nan" && word != "NaN") {
          reader.fail(line, "no number: " + shown(word));
        }
        row.push_back(value);
      }
      if (row.size() != h.columns) {
        reader.fail(line,
                    fmt::format("{} numbers where the header names {}", row.size(), h.columns));
      }
      for (std::size_t k = 0; k < used.size(); ++k) values[k] = row[used[k]->column];
      add(values);
    }
    if (rows < h.points)
      reader.fail(h.line + static_cast<long>(rows), "points are missing at the end");
    return cloud;
  }
  if (h.data != "binary" && h.data != "binary_compressed") {
    reader.fail(h.line - 1, "unknown DATA " + shown(h.data));
  }
  const std::string rows = rows_of(h, bytes, name);
  for (std::size_t at = 0; h.stride > 0 && at + h.stride <= rows.size(); at += h.stride) {
    for (std::size_t k = 0; k < used.size(); ++k) {
      values[k] = number(*used[k], rows.data() + at + used[k]->offset);
    }
    add(values);
  }
  return cloud;
}

namespace {

Content sniff(const std::string& bytes) {
  const bool is_pcd = bytes.starts_with("# .PCD") || bytes.starts_with("VERSION .7") ||
                      bytes.starts_with("VERSION 0.7");
  return is_pcd ? Content::kPoints : Content::kNothing;
}

PointCloud read_points(const std::string& bytes, const std::string& name,
                       std::vector<std::string>& notes) {
  std::size_t lost = 0;
  PointCloud cloud = read_pcd(bytes, name, lost);
  if (lost > 0) notes.push_back(fmt::format("{} points without a place left out", lost));
  return cloud;
}

}  // namespace

const Format& pcd_format() {
  static const Format format{
      .name = "PCD", .extensions = {"pcd"}, .sniff = sniff, .read_points = read_points};
  return format;
}

}  // namespace hapsim
