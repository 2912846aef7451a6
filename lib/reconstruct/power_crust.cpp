#include <CGAL/Cartesian_converter.h>
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Delaunay_triangulation_cell_base_with_circumcenter_3.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Regular_triangulation_3.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>
#include <CGAL/exceptions.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <unordered_map>
#include <utility>

#include "base/error.h"
#include "reconstruct/raw_surface.h"
#include "reconstruct/stamped.h"

namespace hapsim {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Delaunay = CGAL::Delaunay_triangulation_3<
    Kernel, CGAL::Triangulation_data_structure_3<
                CGAL::Triangulation_vertex_base_with_info_3<int, Kernel>,
                CGAL::Delaunay_triangulation_cell_base_with_circumcenter_3<Kernel>>>;
using Regular = CGAL::Regular_triangulation_3<
    Kernel, CGAL::Triangulation_data_structure_3<
                CGAL::Triangulation_vertex_base_with_info_3<
                    int, Kernel, CGAL::Regular_triangulation_vertex_base_3<Kernel>>,
                // Its edges are told by the first of the cells about them.
                Stamped<CGAL::Regular_triangulation_cell_base_3<Kernel>>>>;

constexpr double kBeyond = 0.02;  // of the size: the surface ends this near the points

Vec3 vec(const Point& p) {
  return {p.x(), p.y(), p.z()};
}

struct Pole {
  Vec3 centre;
  double radius;
  double vote;  // above 0: outside
};

// A centre that CGAL computes with rounding; not finite where that makes its points lie in one
// plane, which CGAL's assertions do not allow where they are compiled in.
template <typename Construct>
Vec3 rounded(const Construct& construct) {
  try {
    return vec(construct());
  } catch (const CGAL::Assertion_exception&) {
    return Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
  }
}

// Poles of every sample. The samples -1 are the box: their poles are outer.
std::vector<Pole> find_poles(const Delaunay& delaunay, const PointCloud& cloud,
                             double least_radius) {
  const std::vector<Vec3>& points = cloud.points;
  std::vector<std::vector<int>> corners(points.size());
  std::vector<Vec3> centre;
  std::vector<double> radius;
  std::vector<char> beside_box;
  for (auto c = delaunay.finite_cells_begin(); c != delaunay.finite_cells_end(); ++c) {
    const Vec3 at = rounded([&] { return c->circumcenter(); });
    if (!at.allFinite()) continue;
    const int number = static_cast<int>(centre.size());
    centre.push_back(at);
    radius.push_back((at - vec(c->vertex(0)->point())).norm());
    bool box = false;
    for (int k = 0; k < 4; ++k) {
      const int sample = c->vertex(k)->info();
      if (sample < 0) {
        box = true;
      } else {
        corners[sample].push_back(number);
      }
    }
    beside_box.push_back(box);
  }
  std::vector<int> pole_of(centre.size(), -1);
  std::vector<Pole> poles;
  const auto pole = [&](int corner) {
    if (pole_of[corner] < 0) {
      pole_of[corner] = static_cast<int>(poles.size());
      poles.push_back({centre[corner], radius[corner], beside_box[corner] ? 1e9 : 0});
    }
    return pole_of[corner];
  };
  for (std::size_t s = 0; s < points.size(); ++s) {
    const auto farthest = [&](const Vec3* against) {
      int best = -1;
      double far = 0;
      for (const int corner : corners[s]) {
        const Vec3 d = centre[corner] - points[s];
        if (against != nullptr && d.dot(*against) >= 0) continue;
        if (d.norm() > far) {
          far = d.norm();
          best = corner;
        }
      }
      return best;
    };
    const int first = farthest(nullptr);
    if (first < 0 || radius[first] < least_radius) continue;
    const Vec3 one = centre[first] - points[s];
    const int second = farthest(&one);
    Pole& one_pole = poles[pole(first)];
    one_pole.vote += one.dot(cloud.normals[s]) / one.norm();
    if (second < 0 || radius[second] < least_radius) continue;
    const Vec3 other = centre[second] - points[s];
    Pole& other_pole = poles[pole(second)];
    other_pole.vote += other.dot(cloud.normals[s]) / other.norm();
  }
  return poles;
}

// Where the four balls have equal power. Exactly when they lie so flat that rounding would throw it
// far away.
Vec3 power_centre(const Regular& power, Regular::Cell_handle c, double size) {
  const Vec3 p = rounded([&] { return power.dual(c); });
  std::array<double, 4> value;
  for (int k = 0; k < 4; ++k) {
    const auto& ball = c->vertex(k)->point();
    value[k] = (p - vec(ball.point())).squaredNorm() - ball.weight();
  }
  const auto [low, high] = std::minmax_element(value.begin(), value.end());
  if (p.allFinite() && *high - *low < 1e-9 * size * size) return p;
  using Exact = CGAL::Exact_predicates_exact_constructions_kernel;
  const CGAL::Cartesian_converter<Kernel, Exact> exact;
  const auto q = Exact().construct_weighted_circumcenter_3_object()(
      exact(c->vertex(0)->point()), exact(c->vertex(1)->point()), exact(c->vertex(2)->point()),
      exact(c->vertex(3)->point()));
  return {CGAL::to_double(q.x()), CGAL::to_double(q.y()), CGAL::to_double(q.z())};
}

}  // namespace

Surface power_crust(const PointCloud& cloud, double least_radius) {
  const std::vector<Vec3>& points = cloud.points;
  Vec3 low = points.front(), high = points.front();
  for (const Vec3& p : points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const Vec3 middle = (low + high) / 2;
  const double size = (high - low).norm();
  std::vector<std::pair<Point, int>> samples;
  for (std::size_t i = 0; i < points.size(); ++i) {
    samples.emplace_back(Point(points[i].x(), points[i].y(), points[i].z()), static_cast<int>(i));
  }
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 p = middle + 3 * size *
                                Vec3((corner & 1) != 0 ? 1 : -1, (corner & 2) != 0 ? 1 : -1,
                                     (corner & 4) != 0 ? 1 : -1);
    samples.emplace_back(Point(p.x(), p.y(), p.z()), -1);
  }
  const Delaunay delaunay(samples.begin(), samples.end());
  const std::vector<Pole> poles = find_poles(delaunay, cloud, least_radius);

  std::vector<std::pair<Kernel::Weighted_point_3, int>> balls;
  for (std::size_t p = 0; p < poles.size(); ++p) {
    const Vec3& c = poles[p].centre;
    balls.emplace_back(
        Kernel::Weighted_point_3(Point(c.x(), c.y(), c.z()), poles[p].radius * poles[p].radius),
        static_cast<int>(p));
  }
  const Regular power(balls.begin(), balls.end());
  if (power.dimension() < 3) {
    fail_numerics("", "the points have no medial axis that power crust could use",
                  "use --method poisson or height");
  }
  Surface surface;
  std::map<std::array<double, 3>, int> number;  // equal corners of cells on one sphere are one
  std::unordered_map<const void*, int> corner_of;
  const auto corner = [&](Regular::Cell_handle c) {
    const auto [at, fresh] = corner_of.try_emplace(&*c, 0);
    if (fresh) {
      const Vec3 p = power_centre(power, c, size);
      const auto [found, added] =
          number.try_emplace({p.x(), p.y(), p.z()}, static_cast<int>(surface.vertices.size()));
      if (added) surface.vertices.push_back(p);
      at->second = found->second;
    }
    return at->second;
  };
  for (auto e = power.finite_edges_begin(); e != power.finite_edges_end(); ++e) {
    const Pole& a = poles[e->first->vertex(e->second)->info()];
    const Pole& b = poles[e->first->vertex(e->third)->info()];
    if ((a.vote > 0) == (b.vote > 0)) continue;
    std::vector<int> ring;
    bool open = false;
    auto c = power.incident_cells(*e), start = c;
    do {
      if (power.is_infinite(c)) {
        open = true;
        break;
      }
      const int v = corner(c);
      if (ring.empty() || (ring.back() != v && ring.front() != v)) ring.push_back(v);
    } while (++c != start);
    // A ball labelled wrongly, at an outlier, throws a needle far out.
    const bool needle = std::any_of(ring.begin(), ring.end(), [&](int v) {
      const Vec3 off = (surface.vertices[v] - middle).cwiseAbs() - (high - low) / 2;
      return off.maxCoeff() > kBeyond * size;
    });
    if (open || needle || ring.size() < 3) continue;
    Vec3 normal = Vec3::Zero();
    for (std::size_t k = 2; k < ring.size(); ++k) {
      normal += (surface.vertices[ring[k - 1]] - surface.vertices[ring[0]])
                    .cross(surface.vertices[ring[k]] - surface.vertices[ring[0]]);
    }
    const Vec3 out = a.vote > 0 ? Vec3(a.centre - b.centre) : Vec3(b.centre - a.centre);
    if (normal.dot(out) < 0) std::reverse(ring.begin(), ring.end());
    for (std::size_t k = 2; k < ring.size(); ++k) {
      surface.faces.push_back({ring[0], ring[k - 1], ring[k]});
    }
  }
  if (surface.faces.empty()) {
    fail_numerics("", "power crust found no inside", "use --method poisson or height");
  }
  return surface;
}

}  // namespace hapsim
