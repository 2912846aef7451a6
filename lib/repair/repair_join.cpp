#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Polygon_mesh_processing/intersection.h>

#include "repair/cgal_mesh.h"
#include "repair/repair_parts.h"

namespace hapsim {

namespace PMP = CGAL::Polygon_mesh_processing;

bool parts_cut(const Surface& one, const Surface& other) {
  cgal::Mesh a, b;
  return cgal::to_mesh(one, a) && cgal::to_mesh(other, b) && PMP::do_intersect(a, b);
}

bool join_parts(const Surface& one, const Surface& other, Surface& joined) {
  cgal::Mesh a, b, both;
  if (!cgal::to_mesh(one, a) || !cgal::to_mesh(other, b)) return false;
  try {
    if (!PMP::corefine_and_compute_union(a, b, both)) return false;
  } catch (const std::exception&) {
    return false;
  }
  joined = cgal::to_surface(both);
  return true;
}

}  // namespace hapsim
