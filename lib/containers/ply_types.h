// What the reader and the writer of PLY share.
#pragma once

#include <cstdint>
#include <limits>

#include "containers/ply.h"

namespace hapsim::ply {

struct TypeInfo {
  PlyType type;
  const char* name;
  const char* synonym;
  std::size_t size;  // bytes
  double lowest;     // of integers
  double highest;
};

// Null when the type is unknown.
const TypeInfo* find_type(const std::string& name);
const TypeInfo& info(PlyType type);
inline bool is_integer(PlyType type) {
  return type != PlyType::kFloat32 && type != PlyType::kFloat64;
}

// Calls f with a zero of the C++ type that `type` means.
template <class F>
auto with_type(PlyType type, F&& f) {
  switch (type) {
    case PlyType::kInt8:
      return f(std::int8_t{});
    case PlyType::kUint8:
      return f(std::uint8_t{});
    case PlyType::kInt16:
      return f(std::int16_t{});
    case PlyType::kUint16:
      return f(std::uint16_t{});
    case PlyType::kInt32:
      return f(std::int32_t{});
    case PlyType::kUint32:
      return f(std::uint32_t{});
    case PlyType::kFloat32:
      return f(float{});
    default:
      return f(double{});
  }
}

// The header; `body` is set to the first byte after it and `body_line` to its line.
PlyFile parse_header(const std::string& bytes, const std::string& name, std::size_t& body,
                     long& body_line);

}  // namespace hapsim::ply
