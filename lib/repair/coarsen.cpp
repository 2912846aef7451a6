#include "repair/coarsen.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Bounded_normal_change_placement.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Constrained_placement.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk_placement.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <boost/optional.hpp>
#include <cmath>

#include "base/error.h"

namespace hapsim {
namespace {

namespace SMS = CGAL::Surface_mesh_simplification;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Outline = Mesh::Property_map<Mesh::Edge_index, bool>;
using FaceClass = Mesh::Property_map<Mesh::Face_index, std::uint8_t>;

using EdgeLength = std::function<double(const Vec3&)>;

// Of a triangle: its height over its longest side. Thin ones have less than kThin.
double height_over_side(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double side = std::max({(a - b).norm(), (a - c).norm(), (b - c).norm()});
  return side > 0 ? (b - a).cross(c - a).norm() / (side * side) : 0;
}
constexpr double kThin = 0.3;
constexpr double kNeedle = 0.135;  // no collapse makes such: at its price it may make kThin / 2

Vec3 vec(const Kernel::Point_3& p) {
  return Vec3(p.x(), p.y(), p.z());
}

Mesh make_mesh(const Surface& surface) {
  std::vector<Kernel::Point_3> points;
  for (const Vec3& p : surface.vertices) points.emplace_back(p.x(), p.y(), p.z());
  std::vector<std::array<std::size_t, 3>> faces;
  for (const Triangle& f : surface.faces)
    faces.push_back({static_cast<std::size_t>(f[0]), static_cast<std::size_t>(f[1]),
                     static_cast<std::size_t>(f[2])});
  if (!CGAL::Polygon_mesh_processing::is_polygon_soup_a_polygon_mesh(faces))
    fail_input("", "triangles meet in a way no surface can (a vertex or edge is shared twice)",
               "run hs-reconstruct to get a closed clean surface");
  Mesh mesh;
  CGAL::Polygon_mesh_processing::polygon_soup_to_polygon_mesh(points, faces, mesh);
  return mesh;
}

// May v move to the point `to` of its neighbour without turning a triangle over?
bool keeps_normals(const Mesh& mesh, Mesh::Vertex_index v, Mesh::Vertex_index to) {
  for (const auto h : CGAL::halfedges_around_target(v, mesh)) {
    const auto a = mesh.source(h), b = mesh.target(mesh.next(h));
    if (a == to || b == to) continue;
    const Vec3 pa = vec(mesh.point(a)), pb = vec(mesh.point(b));
    const Vec3 before = (pa - vec(mesh.point(v))).cross(pb - vec(mesh.point(v)));
    const Vec3 after = (pa - vec(mesh.point(to))).cross(pb - vec(mesh.point(to)));
    if (!(before.dot(after) > 0.8 * before.norm() * after.norm())) return false;
    if (!(after.norm() > 0.02 * (pa - pb).squaredNorm())) return false;
  }
  return true;
}

// Takes vertices out of the outline where it runs straight: the collapse below leaves it alone.
bool coarsen_outline_once(Mesh& mesh, Outline outline, const EdgeLength& edge_at,
                          double tolerance) {
  bool changed = false;
  const std::vector<Mesh::Vertex_index> vertices(mesh.vertices().begin(), mesh.vertices().end());
  for (const auto v : vertices) {
    if (mesh.is_removed(v)) continue;
    std::vector<Mesh::Halfedge_index> line;  // outline edges that end in v
    for (const auto h : CGAL::halfedges_around_target(v, mesh))
      if (outline[mesh.edge(h)]) line.push_back(h);
    if (line.size() != 2) continue;
    const Vec3 p = vec(mesh.point(v)), a = vec(mesh.point(mesh.source(line[0]))),
               b = vec(mesh.point(mesh.source(line[1])));
    const double length = (b - a).norm(), edge = edge_at(p);
    if (!(length < 1.2 * edge) || (p - a).cross(b - a).norm() > tolerance * edge * length) continue;
    for (const auto h : line) {
      const auto keep = mesh.source(h);
      const Kernel::Point_3 point = mesh.point(keep);
      if (!CGAL::Euler::does_satisfy_link_condition(mesh.edge(h), mesh) ||
          !keeps_normals(mesh, v, keep))
        continue;
      outline[mesh.edge(h)] = false;  // collapse_edge() wants it so; v's other edge carries on
      const auto left = CGAL::Euler::collapse_edge(mesh.edge(h), mesh, outline);
      mesh.point(left) = point;
      changed = true;
      break;
    }
  }
  return changed;
}

// Squared edge length plus squared distance of the new vertex from the old planes, each over what
// is wished, plus a price for thin triangles: flat parts become even triangles of the wished size,
// bent parts stay finer. Needles that the input has, as about a pole, may become less so for
// nothing.
class EvenCost {
 public:
  EvenCost(const EdgeLength& edge, double tolerance) : edge_(edge), tolerance_(tolerance) {}
  template <class Profile>
  boost::optional<double> operator()(const Profile& profile,
                                     const boost::optional<Kernel::Point_3>& placed) const {
    if (!placed) return boost::none;
    const Vec3 p = vec(*placed);
    const double edge = edge_(p);
    const auto& mesh = profile.surface_mesh();
    double off = 0, longest = 0, before = kThin, thinnest = kThin;
    for (const auto v : {profile.v0(), profile.v1()})
      for (const auto h : CGAL::halfedges_around_target(v, mesh)) {
        const Vec3 a = vec(mesh.point(mesh.target(h))), b = vec(mesh.point(mesh.source(h))),
                   c = vec(mesh.point(mesh.target(mesh.next(h))));
        const Vec3 n = (b - a).cross(c - a);
        if (n.norm() > 0) off = std::max(off, std::abs(n.dot(p - a)) / n.norm());
        longest = std::max(longest, (p - b).norm());
        before = std::min(before, height_over_side(a, b, c));
        const auto removed = [&](auto w) { return w == profile.v0() || w == profile.v1(); };
        if (removed(mesh.source(h)) || removed(mesh.target(mesh.next(h)))) continue;
        thinnest = std::min(thinnest, height_over_side(p, b, c));
      }
    const double bend = off / (tolerance_ * edge), size = longest / (1.6 * edge);
    const bool needles = before < kNeedle && thinnest >= before;
    const double thin = needles ? 0 : kThin / std::max(thinnest, 1e-6) - 1;
    return size * size + bend * bend + thin;
  }

 private:
  const EdgeLength& edge_;
  double tolerance_;
};

struct StopAtCost {
  template <class Cost, class Profile, class Size>
  bool operator()(const Cost& cost, const Profile&, Size, Size) const {
    return cost > 1;
  }
};

void coarsen(Mesh& mesh, Outline outline, const EdgeLength& edge, const CoarsenOptions& options) {
  for (int pass = 0;
       pass < 8 && coarsen_outline_once(mesh, outline, edge, options.outline_tolerance); ++pass) {
  }
  using Placement = SMS::Bounded_normal_change_placement<
      SMS::Constrained_placement<SMS::LindstromTurk_placement<Mesh>, Outline>>;
  const SMS::Constrained_placement<SMS::LindstromTurk_placement<Mesh>, Outline> inner(outline);
  SMS::edge_collapse(mesh, StopAtCost(),
                     CGAL::parameters::edge_is_constrained_map(outline)
                         .get_cost(EvenCost(edge, options.tolerance))
                         .get_placement(Placement(inner)));
}

ClassedSurface surface_of(Mesh& mesh, FaceClass face_class) {
  ClassedSurface result;
  mesh.collect_garbage();
  for (const auto v : mesh.vertices()) result.surface.vertices.push_back(vec(mesh.point(v)));
  for (const auto f : mesh.faces()) {
    const auto h = mesh.halfedge(f);
    result.surface.faces.push_back({static_cast<int>(mesh.source(h)),
                                    static_cast<int>(mesh.target(h)),
                                    static_cast<int>(mesh.target(mesh.next(h)))});
    result.face_class.push_back(face_class[f]);
  }
  return result;
}

}  // namespace

ClassedSurface coarsen_surface(const ClassedSurface& surface, const EdgeLength& edge,
                               const CoarsenOptions& options) {
  const double inside = signed_volume(surface.surface);
  double scale = 1;
  for (int attempt = 0; attempt < 6; ++attempt, scale *= 0.7) {
    Mesh mesh = make_mesh(surface.surface);
    Outline outline = mesh.add_property_map<Mesh::Edge_index, bool>("e:outline", false).first;
    FaceClass face_class = mesh.add_property_map<Mesh::Face_index, std::uint8_t>("f:class").first;
    for (const auto f : mesh.faces())
      face_class[f] = surface.face_class[static_cast<std::size_t>(f)];
    for (const auto e : mesh.edges()) {
      const auto h = mesh.halfedge(e);
      outline[e] = face_class[mesh.face(h)] != face_class[mesh.face(mesh.opposite(h))];
    }
    coarsen(
        mesh, outline, [&](const Vec3& p) { return scale * edge(p); }, options);
    if (CGAL::Polygon_mesh_processing::does_self_intersect<CGAL::Sequential_tag>(mesh)) continue;
    ClassedSurface result = surface_of(mesh, face_class);
    if (std::abs(signed_volume(result.surface) - inside) <= options.volume_tolerance * inside)
      return result;
  }
  return surface;
}

}  // namespace hapsim
