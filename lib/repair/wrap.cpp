#include "repair/wrap.h"

#include <CGAL/alpha_wrap_3.h>

#include "base/error.h"
#include "repair/cgal_mesh.h"

namespace hapsim {
namespace {

Surface finished(cgal::Mesh& mesh) {
  Surface surface = cgal::to_surface(mesh);
  if (surface.faces.empty()) {
    fail_numerics("", "nothing is left inside the wrap", "give a finer --edge");
  }
  return surface;
}

}  // namespace

Surface wrap_points(const std::vector<Vec3>& points, double alpha, double offset) {
  cgal::Mesh mesh;
  CGAL::alpha_wrap_3(cgal::points_of(points), alpha, offset, mesh);
  return finished(mesh);
}

Surface wrap_triangles(const Surface& triangles, double alpha, double offset) {
  cgal::Mesh mesh;
  CGAL::alpha_wrap_3(cgal::points_of(triangles.vertices), cgal::faces_of(triangles), alpha, offset,
                     mesh);
  return finished(mesh);
}

}  // namespace hapsim
