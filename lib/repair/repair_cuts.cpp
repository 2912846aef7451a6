#include <CGAL/Polygon_mesh_processing/repair_self_intersections.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "repair/cgal_mesh.h"
#include "repair/repair_parts.h"

namespace hapsim {

namespace PMP = CGAL::Polygon_mesh_processing;

std::size_t count_cuts(const Surface& surface, std::array<int, 2>& first) {
  cgal::Mesh mesh;
  if (!cgal::to_mesh(surface, mesh)) return 0;
  std::vector<std::pair<cgal::Mesh::Face_index, cgal::Mesh::Face_index>> pairs;
  PMP::self_intersections<CGAL::Sequential_tag>(mesh, std::back_inserter(pairs));
  if (pairs.empty()) return 0;
  first = {static_cast<int>(surface.faces.size()), 0};
  for (const auto& [a, b] : pairs) {
    const int i = static_cast<int>(a), k = static_cast<int>(b);
    first = std::min(first, std::array<int, 2>{std::min(i, k), std::max(i, k)});
  }
  return pairs.size();
}

bool remove_cuts(Surface& surface) {
  cgal::Mesh mesh;
  if (!cgal::to_mesh(surface, mesh)) return false;
  bool done = false;
  try {
    done =
        PMP::experimental::remove_self_intersections(mesh, CGAL::parameters::preserve_genus(false));
  } catch (const std::exception&) {
    return false;
  }
  surface = cgal::to_surface(mesh);
  return done;
}

}  // namespace hapsim
