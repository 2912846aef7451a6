// PLY files, ASCII and binary of both byte orders: any elements and properties.
#pragma once

#include <string>
#include <vector>

#include "io/stream.h"

namespace hapsim {

enum class PlyType { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat32, kFloat64 };

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::kFloat64;
  bool is_list = false;
  PlyType count_type = PlyType::kUint8;
  std::vector<double> values;       // scalars: one an item; lists: all items' entries in a row
  std::vector<std::size_t> offset;  // lists: item i is values[offset[i] .. offset[i+1])
};

struct PlyElement {
  std::string name;
  std::size_t count = 0;
  std::vector<PlyProperty> properties;
  const PlyProperty* find(const std::string& property) const;  // null when absent
};

enum class PlyFormat { kAscii, kBinaryLittle, kBinaryBig };

struct PlyFile {
  PlyFormat format = PlyFormat::kBinaryLittle;
  std::vector<std::string> comments;
  std::vector<PlyElement> elements;
  const PlyElement* find(const std::string& element) const;
};

bool is_ply(const std::string& bytes);
// The texts of the comments in the header; none of bytes that are no PLY.
std::vector<std::string> ply_comments(const std::string& bytes);
// Parses bytes that begin with "ply". Error(kBadInput) with name and line (header, ASCII) or byte
// offset (binary): truncated, count that the file cannot hold, unknown type, NaN coordinate.
PlyFile parse_ply(const std::string& bytes, const std::string& name);
void write_ply(std::ostream& out, const PlyFile& file);

}  // namespace hapsim
