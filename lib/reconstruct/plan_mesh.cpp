#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Delaunay_mesh_face_base_2.h>
#include <CGAL/Delaunay_mesh_size_criteria_2.h>
#include <CGAL/Delaunay_mesh_vertex_base_2.h>
#include <CGAL/Delaunay_mesher_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/lloyd_optimize_mesh_2.h>

#include <map>

#include "base/error.h"
#include "reconstruct/plan_view.h"
#include "reconstruct/stamped.h"

namespace hapsim {

Surface plan_mesh(const std::vector<Vec2>& outline, double edge, int& rim) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  using VertexBase = Stamped<CGAL::Delaunay_mesh_vertex_base_2<Kernel>>;
  using FaceBase = Stamped<CGAL::Delaunay_mesh_face_base_2<Kernel>>;
  using Triangulation = CGAL::Constrained_Delaunay_triangulation_2<
      Kernel, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>>;
  using Criteria = CGAL::Delaunay_mesh_size_criteria_2<Triangulation>;
  Triangulation mesh;
  std::vector<Triangulation::Vertex_handle> corner;
  for (const Vec2& p : outline) corner.push_back(mesh.insert(Kernel::Point_2(p.x(), p.y())));
  for (std::size_t i = 0; i < corner.size(); ++i) {
    mesh.insert_constraint(corner[i], corner[(i + 1) % corner.size()]);
  }
  // Sides up to 1.25 edges: refinement stops at anything shorter, so that the mean comes to `edge`.
  CGAL::refine_Delaunay_mesh_2(mesh, Criteria(0.125, 1.25 * edge));
  CGAL::lloyd_optimize_mesh_2(mesh, CGAL::parameters::max_iteration_number = 10);

  // Around the outline first: the mesher may have put further vertices on it.
  Surface plan;
  std::map<Triangulation::Vertex_handle, int> number;
  const auto add = [&](Triangulation::Vertex_handle v) {
    const auto [at, added] = number.try_emplace(v, static_cast<int>(plan.vertices.size()));
    if (added) plan.vertices.emplace_back(v->point().x(), v->point().y(), 0);
    return at->second;
  };
  std::map<Triangulation::Vertex_handle, Triangulation::Vertex_handle> next;
  for (auto f = mesh.finite_faces_begin(); f != mesh.finite_faces_end(); ++f) {
    if (!f->is_in_domain()) continue;
    for (int k = 0; k < 3; ++k) {
      if (f->neighbor(k)->is_in_domain() && !mesh.is_infinite(f->neighbor(k))) continue;
      next[f->vertex(mesh.ccw(k))] = f->vertex(mesh.cw(k));
    }
  }
  const auto start = corner.front();
  auto v = start;
  do {
    add(v);
    const auto at = next.find(v);
    if (at == next.end()) {
      fail_numerics("", "the outline of the points touches itself", "give a larger --edge");
    }
    v = at->second;
  } while (v != start && plan.vertices.size() <= next.size());
  if (plan.vertices.size() != next.size()) {
    fail_numerics("", "the outline of the points touches itself", "give a larger --edge");
  }
  rim = static_cast<int>(plan.vertices.size());
  for (auto f = mesh.finite_faces_begin(); f != mesh.finite_faces_end(); ++f) {
    if (!f->is_in_domain()) continue;
    plan.faces.push_back({add(f->vertex(0)), add(f->vertex(1)), add(f->vertex(2))});
  }
  return plan;
}

}  // namespace hapsim
