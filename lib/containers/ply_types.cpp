#include "containers/ply_types.h"

#include <algorithm>
#include <array>

namespace hapsim {
namespace ply {
namespace {

constexpr std::array kTypes{
    TypeInfo{PlyType::kInt8, "char", "int8", 1, -128, 127},
    TypeInfo{PlyType::kUint8, "uchar", "uint8", 1, 0, 255},
    TypeInfo{PlyType::kInt16, "short", "int16", 2, -32768, 32767},
    TypeInfo{PlyType::kUint16, "ushort", "uint16", 2, 0, 65535},
    TypeInfo{PlyType::kInt32, "int", "int32", 4, -2147483648.0, 2147483647.0},
    TypeInfo{PlyType::kUint32, "uint", "uint32", 4, 0, 4294967295.0},
    TypeInfo{PlyType::kFloat32, "float", "float32", 4, 0, 0},
    TypeInfo{PlyType::kFloat64, "double", "float64", 8, 0, 0},
};

}  // namespace

const TypeInfo* find_type(const std::string& name) {
  const auto found = std::find_if(kTypes.begin(), kTypes.end(), [&](const TypeInfo& t) {
    return name == t.name || name == t.synonym;
  });
  return found == kTypes.end() ? nullptr : &*found;
}

const TypeInfo& info(PlyType type) {
  return kTypes[static_cast<std::size_t>(type)];
}

}  // namespace ply

const PlyProperty* PlyElement::find(const std::string& property) const {
  for (const PlyProperty& p : properties)
    if (p.name == property) return &p;
  return nullptr;
}

const PlyElement* PlyFile::find(const std::string& element) const {
  for (const PlyElement& e : elements)
    if (e.name == element) return &e;
  return nullptr;
}

}  // namespace hapsim
