#include <CGAL/Advancing_front_surface_reconstruction.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <cstddef>
#include <tuple>
#include <utility>

#include "base/error.h"
#include "reconstruct/raw_surface.h"
#include "reconstruct/stamped.h"

namespace hapsim {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

// CGAL orders the edges of the front by how good the triangle is that could be added there, and by
// the edge's address where that is equal, as at mirrored points. Here the numbers of the edge's
// points decide instead.
template <class Base>
class FrontVertex : public Base {
 public:
  using Base::Base;
  template <class Structure>
  struct Rebind_TDS {
    using Other = FrontVertex<typename Base::template Rebind_TDS<Structure>::Other>;
  };

  // What CGAL's set of the front's edges holds; its names are CGAL's.
  struct Radius_ptr_type {
    typename Base::criteria first;
    typename Base::IO_edge_type* second;
    std::pair<std::size_t, std::size_t> points;

    Radius_ptr_type(typename Base::criteria value, typename Base::IO_edge_type* edge)
        : first(value), second(edge) {
      const auto& [cell, a, b] =
          std::tie(edge->first.first.first, edge->first.first.second, edge->first.first.third);
      points = std::minmax({cell->vertex(a)->info(), cell->vertex(b)->info()});
    }
    bool operator<(const Radius_ptr_type& other) const {
      return std::tie(first, points) < std::tie(other.first, other.points);
    }
  };
};

using Triangulation = CGAL::Delaunay_triangulation_3<
    Kernel,
    CGAL::Triangulation_data_structure_3<
        FrontVertex<Stamped<CGAL::Advancing_front_surface_reconstruction_vertex_base_3<Kernel>>>,
        Stamped<CGAL::Advancing_front_surface_reconstruction_cell_base_3<Kernel>>>>;

}  // namespace

Surface advancing_front(const std::vector<Vec3>& points) {
  std::vector<std::pair<Kernel::Point_3, std::size_t>> samples;
  for (const Vec3& p : points) {
    samples.emplace_back(Kernel::Point_3(p.x(), p.y(), p.z()), samples.size());
  }
  Triangulation triangulation(samples.begin(), samples.end());
  CGAL::Advancing_front_surface_reconstruction<Triangulation> front(triangulation);
  front.run();
  Surface surface;
  surface.vertices = points;
  const auto& found = front.triangulation_data_structure_2();
  for (auto f = found.faces_begin(); f != found.faces_end(); ++f) {
    if (!f->is_on_surface()) continue;  // it closes a gap
    Triangle face;
    for (int k = 0; k < 3; ++k) face[k] = static_cast<int>(f->vertex(k)->vertex_3()->info());
    surface.faces.push_back(face);
  }
  if (surface.faces.empty()) {
    fail_numerics("", "the advancing front found no triangle", "use --method poisson or height");
  }
  return surface;
}

}  // namespace hapsim
