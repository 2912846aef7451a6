#include "import/block.h"

#include <array>

#include "base/error.h"
#include "io/number.h"
#include "io/quantity.h"

namespace hapsim {

Vec3 parse_block(const std::string& text) {
  const std::string si = list_in_si(text, {Quantity::kLength}, "--block");
  Vec3 size;
  std::size_t from = 0;
  for (Eigen::Index i = 0; i < 3; ++i) {
    const std::size_t to = std::min(si.find_first_of("xX,", from), si.size());
    if (!parse_number(si.substr(from, to - from), size[i]) || !(size[i] > 0) ||
        (to == si.size()) != (i == 2))
      fail_usage("--block: '" + text + "' is not three positive lengths",
                 "write for example 120x80x40mm");
    from = to + 1;
  }
  return size;
}

PlyFile block_surface(const Vec3& size) {
  PlyFile file;
  file.comments = {"block " + format_number(size.x()) + " x " + format_number(size.y()) + " x " +
                   format_number(size.z()) + " m"};
  PlyElement vertices{"vertex", 8, {}};
  for (const char* name : {"x", "y", "z"})
    vertices.properties.push_back({name, PlyType::kFloat64, false, PlyType::kUint8, {}, {}});
  for (int corner = 0; corner < 8; ++corner) {
    vertices.properties[0].values.push_back((corner & 1 ? 0.5 : -0.5) * size.x());
    vertices.properties[1].values.push_back((corner & 2 ? 0.5 : -0.5) * size.y());
    vertices.properties[2].values.push_back(corner & 4 ? size.z() : 0);
  }
  constexpr std::array<std::array<int, 3>, 12> kFaces{{{0, 2, 1},
                                                       {1, 2, 3},
                                                       {4, 5, 6},
                                                       {5, 7, 6},
                                                       {0, 1, 4},
                                                       {1, 5, 4},
                                                       {2, 6, 3},
                                                       {3, 6, 7},
                                                       {0, 4, 2},
                                                       {2, 4, 6},
                                                       {1, 3, 5},
                                                       {3, 7, 5}}};
  PlyElement faces{
      "face", kFaces.size(), {{"vertex_indices", PlyType::kInt32, true, PlyType::kUint8, {}, {0}}}};
  for (const auto& face : kFaces) {
    for (const int corner : face) faces.properties[0].values.push_back(corner);
    faces.properties[0].offset.push_back(faces.properties[0].values.size());
  }
  file.elements = {vertices, faces};
  return file;
}

}  // namespace hapsim
