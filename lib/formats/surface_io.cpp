#include "formats/surface_io.h"

#include <algorithm>

#include "base/error.h"
#include "formats/format_table.h"
#include "formats/mesh_file.h"
#include "mesh/drop_unused.h"

namespace hapsim {
namespace {

const std::string kMendSurface = "give triangles, or points to hs-reconstruct";

Surface as_given(const Recognised& found, const std::string& bytes, const std::string& name) {
  if (found.content == Content::kTetrahedra)
    return boundary_surface(parse_mesh(bytes, name, false).mesh);
  if (found.format != nullptr && found.format->read_surface != nullptr)
    return found.format->read_surface(bytes, name);
  fail_format(name, bytes, Content::kTriangles, kMendSurface);
}

}  // namespace

Surface parse_surface(const std::string& bytes, const std::string& name) {
  Surface surface = as_given(recognise(bytes), bytes, name);
  // A corner that met another leaves no area, only an edge that would look open.
  std::erase_if(surface.faces,
                [](const Triangle& f) { return f[0] == f[1] || f[1] == f[2] || f[2] == f[0]; });
  drop_unused(surface);
  return surface;
}

Surface read_surface(Input& input) {
  return parse_surface(input.read_all(), input.name());
}

PointCloud parse_points(const std::string& bytes, const std::string& name,
                        std::vector<std::string>* notes) {
  const Recognised found = recognise(bytes);
  PointCloud cloud;
  std::vector<std::string> own;
  if (found.format != nullptr && found.format->read_points != nullptr)
    cloud = found.format->read_points(bytes, name, notes != nullptr ? *notes : own);
  else if (found.format != nullptr && found.format->read_surface != nullptr)
    cloud.points = found.format->read_surface(bytes, name).vertices;
  else
    fail_format(name, bytes, Content::kPoints, "give rows of x,y,z");
  if (cloud.points.empty()) fail_input(name, "there are no points", "give rows of x,y,z");
  return cloud;
}

PointCloud read_points(Input& input) {
  return parse_points(input.read_all(), input.name());
}

Shape read_shape(Input& input) {
  const std::string bytes = input.read_all();
  const Recognised found = recognise(bytes);
  if (found.format == nullptr && !bytes.empty())
    fail_format(input.name(), bytes, Content::kTriangles,
                "points are read as " + names_to_read(Content::kPoints));
  Shape shape;
  shape.has_triangles =
      found.content == Content::kTriangles || found.content == Content::kTetrahedra;
  if (shape.has_triangles)
    shape.surface = as_given(found, bytes, input.name());
  else
    shape.cloud = parse_points(bytes, input.name());
  return shape;
}

}  // namespace hapsim
