#include "import/block.h"

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

Surface block_surface(const Vec3& size) {
  Surface surface;
  for (int corner = 0; corner < 8; ++corner)
    surface.vertices.emplace_back((corner & 1 ? 0.5 : -0.5) * size.x(),
                                  (corner & 2 ? 0.5 : -0.5) * size.y(), corner & 4 ? size.z() : 0);
  surface.faces = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                   {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return surface;
}

}  // namespace hapsim
