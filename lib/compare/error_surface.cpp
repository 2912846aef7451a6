#include "compare/error_surface.h"

#include <fmt/format.h>

#include <limits>

#include "report/palette.h"

namespace hapsim {

PlyFile coloured_ply(const ErrorMap& map, double top) {
  const auto column = [](const char* name, PlyType type) {
    PlyProperty property;
    property.name = name;
    property.type = type;
    return property;
  };
  PlyElement vertex{"vertex", map.surface.vertices.size(), {}};
  for (const char* name : {"x", "y", "z"})
    vertex.properties.push_back(column(name, PlyType::kFloat64));
  for (const char* name : {"red", "green", "blue"})
    vertex.properties.push_back(column(name, PlyType::kUint8));
  vertex.properties.push_back(column("error", PlyType::kFloat32));
  for (std::size_t i = 0; i < vertex.count; ++i) {
    const bool known = map.distance[i] <= map.reach;
    const Rgb colour = known ? error_colour(map.error[i] / top) : kUnknownColour;
    for (std::size_t k = 0; k < 3; ++k) {
      vertex.properties[k].values.push_back(map.surface.vertices[i][static_cast<Eigen::Index>(k)]);
      vertex.properties[3 + k].values.push_back(colour[k]);
    }
    vertex.properties[6].values.push_back(known ? map.error[i]
                                                : std::numeric_limits<double>::quiet_NaN());
  }
  PlyElement face{"face", map.surface.faces.size(), {column("vertex_indices", PlyType::kInt32)}};
  PlyProperty& corners = face.properties[0];
  corners.is_list = true;
  corners.offset.push_back(0);
  for (const Triangle& f : map.surface.faces) {
    corners.values.insert(corners.values.end(), f.begin(), f.end());
    corners.offset.push_back(corners.values.size());
  }
  PlyFile file;
  file.comments.push_back(
      fmt::format("error: rmse of nearby presses [N], colours from 0 to {:.4g}", top));
  file.elements = {vertex, face};
  return file;
}

}  // namespace hapsim
