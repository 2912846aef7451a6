#include "import/block.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "base/error.h"
#include "io/number.h"
#include "io/quantity.h"

namespace hapsim {
namespace {

constexpr int kSides = 64;

Surface cuboid(const Vec3& size) {
  Surface surface;
  for (int corner = 0; corner < 8; ++corner)
    surface.vertices.emplace_back((corner & 1 ? 0.5 : -0.5) * size.x(),
                                  (corner & 2 ? 0.5 : -0.5) * size.y(), corner & 4 ? size.z() : 0);
  surface.faces = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                   {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return surface;
}

Surface prism(double radius, double height) {
  Surface surface;
  const double turn = 2 * std::numbers::pi / kSides;
  const double corner = radius * std::sqrt(turn / std::sin(turn));
  for (const double z : {0.0, height})
    for (int i = 0; i < kSides; ++i)
      surface.vertices.emplace_back(corner * std::cos(i * turn), corner * std::sin(i * turn), z);
  const int below = 2 * kSides, above = below + 1;
  surface.vertices.emplace_back(0, 0, 0);
  surface.vertices.emplace_back(0, 0, height);
  for (int i = 0; i < kSides; ++i) {
    const int j = (i + 1) % kSides;
    surface.faces.push_back({below, j, i});
    surface.faces.push_back({above, kSides + i, kSides + j});
    surface.faces.push_back({i, j, kSides + j});
    surface.faces.push_back({i, kSides + j, kSides + i});
  }
  return surface;
}

}  // namespace

Block parse_block(const std::string& text) {
  const std::string si = list_in_si(text, {Quantity::kLength}, "--block");
  std::vector<double> length;
  bool sound = true;
  for (std::size_t from = 0; from <= si.size();) {
    const std::size_t to = std::min(si.find_first_of("xX,", from), si.size());
    sound = parse_number(si.substr(from, to - from), length.emplace_back()) && sound;
    from = to + 1;
  }
  sound = sound && (length.size() == 2 || length.size() == 3) &&
          std::all_of(length.begin(), length.end(), [](double l) { return l > 0; });
  if (!sound)
    fail_usage("--block: '" + text + "' is neither three nor two positive lengths",
               "write for example 120x80x40mm, or 50x30mm for a cylinder's diameter and height");
  if (length.size() == 2) return {{length[0], length[0], length[1]}, true};
  return {{length[0], length[1], length[2]}, false};
}

std::string block_words(const Block& block) {
  const auto number = [&](Eigen::Index k) { return format_number(block.size[k]); };
  return block.round ? fmt::format("diameter {}, height {} m", number(0), number(2))
                     : fmt::format("{} x {} x {} m", number(0), number(1), number(2));
}

Surface block_surface(const Block& block) {
  return block.round ? prism(block.size.x() / 2, block.size.z()) : cuboid(block.size);
}

double covering_radius(const Block& block) {
  return block.round ? block.size.x() / 2 : std::hypot(block.size.x(), block.size.y()) / 2;
}

}  // namespace hapsim
