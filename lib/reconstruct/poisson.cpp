#include "reconstruct/poisson.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/IO/facets_in_complex_2_to_triangle_mesh.h>
#include <CGAL/Implicit_surface_3.h>
#include <CGAL/Poisson_reconstruction_function.h>
#include <CGAL/Polyhedron_3.h>
#include <CGAL/Random.h>
#include <CGAL/Surface_mesh_default_criteria_3.h>
#include <CGAL/Surface_mesh_default_triangulation_3.h>
#include <CGAL/make_surface_mesh.h>
#include <CGAL/property_map.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <stdexcept>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/random.h"
#include "reconstruct/stamped.h"

namespace hapsim {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

// Of the cell. Of equally bad tetrahedra, as mirrored points make them, the function's refinement
// takes that one first which lies first in memory; points shaken by so little have none.
constexpr double kShake = 1e-6;

// CGAL's default for surface meshes, stamped.
using Traits = CGAL::Robust_circumcenter_traits_3<Kernel>;
using Vertex = Stamped<CGAL::Surface_mesh_vertex_base_3<Traits>>;
using Cell = Stamped<CGAL::Delaunay_triangulation_cell_base_with_circumcenter_3<
    Traits, CGAL::Surface_mesh_cell_base_3<Traits>>>;
using Triangulation =
    CGAL::Delaunay_triangulation_3<Traits, CGAL::Triangulation_data_structure_3<Vertex, Cell>>;

// CGAL numbers the result by where it lies in memory: by coordinates instead, so that the same
// points give the same bytes.
Surface in_order(const Surface& surface) {
  std::vector<int> order(surface.vertices.size());
  std::iota(order.begin(), order.end(), 0);
  const auto key = [&](int v) {
    const Vec3& p = surface.vertices[v];
    return std::array<double, 3>{p.x(), p.y(), p.z()};
  };
  std::sort(order.begin(), order.end(), [&](int a, int b) { return key(a) < key(b); });
  Surface sorted;
  std::vector<int> number(order.size());
  for (const int v : order) {
    number[v] = static_cast<int>(sorted.vertices.size());
    sorted.vertices.push_back(surface.vertices[v]);
  }
  for (const Triangle& f : surface.faces) {
    Triangle g{number[f[0]], number[f[1]], number[f[2]]};
    std::rotate(g.begin(), std::min_element(g.begin(), g.end()), g.end());
    sorted.faces.push_back(g);
  }
  std::sort(sorted.faces.begin(), sorted.faces.end());
  return sorted;
}

// How often the mesher may ask for the function. A body takes about 140 for a triangle, and its
// area is at most about that of the box around all points but the outermost; points that are no
// body's (at two scales, far astray) make a surface that the mesher follows for hours.
double most_questions(const std::vector<Vec3>& points, double cell) {
  constexpr double kForTriangle = 2 * 140;
  const auto cut = static_cast<std::ptrdiff_t>(0.01 * static_cast<double>(points.size()));
  Vec3 size;
  for (int k = 0; k < 3; ++k) {
    std::vector<double> along;
    for (const Vec3& p : points) along.push_back(p[k]);
    std::sort(along.begin(), along.end());
    size[k] = *(along.end() - 1 - cut) - *(along.begin() + cut);
  }
  const double area = 2 * size.dot(Vec3(size.y(), size.z(), size.x()));
  return kForTriangle * (area / (std::sqrt(3.0) / 4 * cell * cell) + 1000);
}

}  // namespace

Surface poisson_surface(const PointCloud& cloud, double cell, double off, std::uint64_t seed) {
  using Oriented = std::pair<Kernel::Point_3, Kernel::Vector_3>;
  using Polyhedron = CGAL::Polyhedron_3<Kernel>;
  // The triangulation inserts in random order.
  CGAL::get_default_random() = CGAL::Random(static_cast<unsigned>(seed));
  Random shake(seed);
  std::vector<Oriented> points;
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const Vec3 p =
        cloud.points[i] + kShake * cell * Vec3(shake.normal(), shake.normal(), shake.normal());
    const Vec3& n = cloud.normals[i];
    points.emplace_back(Kernel::Point_3(p.x(), p.y(), p.z()),
                        Kernel::Vector_3(n.x(), n.y(), n.z()));
  }
  Polyhedron mesh;
  using Function = CGAL::Poisson_reconstruction_function<Kernel>;
  Function function(points.begin(), points.end(), CGAL::First_of_pair_property_map<Oriented>(),
                    CGAL::Second_of_pair_property_map<Oriented>());
  Triangulation triangulation;
  if (function.compute_implicit_function()) {
    // Smallest angle 20 degrees.
    const double radius = 5 * std::sqrt(function.bounding_sphere().squared_radius());
    double left = most_questions(cloud.points, cell);
    const auto bounded = [&](const Kernel::Point_3& p) {
      if (--left < 0) throw std::runtime_error("the surface does not end");
      return function(p);
    };
    const CGAL::Implicit_surface_3<Kernel> implicit(
        bounded, Kernel::Sphere_3(function.get_inner_point(), radius * radius),
        off / 1000 / radius);
    CGAL::Surface_mesh_complex_2_in_triangulation_3<Triangulation> complex(triangulation);
    // The tag asks for a surface without a boundary.
    CGAL::make_surface_mesh(complex, implicit,
                            CGAL::Surface_mesh_default_criteria_3<Triangulation>(20, cell, off),
                            CGAL::Manifold_tag());
    // Where the mesher starts on zeros of the function far from the points it ends without a facet.
    if (complex.number_of_facets() > 0) CGAL::facets_in_complex_2_to_triangle_mesh(complex, mesh);
  }
  if (mesh.empty()) {
    fail_numerics("", "the Poisson surface could not be found",
                  "check the points with hs-scan2ply, or use --method height");
  }
  Surface surface;
  std::map<Polyhedron::Vertex_const_handle, int> number;
  for (auto v = mesh.vertices_begin(); v != mesh.vertices_end(); ++v) {
    number.emplace(v, static_cast<int>(surface.vertices.size()));
    surface.vertices.emplace_back(v->point().x(), v->point().y(), v->point().z());
  }
  for (auto f = mesh.facets_begin(); f != mesh.facets_end(); ++f) {
    Triangle face;
    auto h = f->facet_begin();
    for (int& corner : face) corner = number.at((h++)->vertex());
    surface.faces.push_back(face);
  }
  return in_order(surface);
}

}  // namespace hapsim
