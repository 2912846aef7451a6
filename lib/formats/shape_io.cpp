#include <cstdint>
#include <cstring>
#include <string>

#include "formats/ply.h"
#include "formats/surface_io.h"
#include "mesh/surface.h"

namespace hapsim {
namespace {

// Binary STL says how many triangles of 50 bytes follow its 84.
bool is_stl(const std::string& bytes) {
  if (bytes.starts_with("solid")) return true;
  if (bytes.size() < 84) return false;
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + 80, sizeof count);
  // Text of just this length would have to spell its own length.
  return bytes.size() == 84 + 50 * static_cast<std::size_t>(count) ||
         std::memchr(bytes.data(), 0, bytes.size()) != nullptr;
}

bool has_faces(const std::string& bytes, const std::string& name) {
  const PlyFile file = parse_ply(bytes, name);
  const PlyElement* face = file.find("face");
  return face != nullptr && face->count > 0;
}

}  // namespace

Shape read_shape(Input& input) {
  const std::string bytes = input.read_all();
  const bool ply = bytes.starts_with("ply\n") || bytes.starts_with("ply\r");
  Shape shape;
  shape.has_triangles = ply ? has_faces(bytes, input.name()) : is_stl(bytes);
  Input again = Input::from_bytes(bytes, input.name());
  if (shape.has_triangles) {
    shape.surface = read_surface_as_given(again);
  } else {
    shape.cloud = read_points(again);
  }
  return shape;
}

}  // namespace hapsim
