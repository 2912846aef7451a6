#include "tetmesh/insert_points.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "mesh/surface_tree.h"

namespace hapsim {
namespace {

constexpr double kSame = 0.1;         // of an edge length: points this close share a vertex
constexpr double kBeside = 0.3;       // of an edge length: that vertex is taken
constexpr double kOnEdge = 0.1;       // of a triangle's height: its edge is divided
constexpr double kLeastCosine = 0.7;  // between a face's normals before and after

Vec3 normal(const Vec3& a, const Vec3& b, const Vec3& c) {
  return (b - a).cross(c - a);
}

class Inserter {
 public:
  explicit Inserter(ClassedSurface& classed)
      : faces_(classed.surface.faces), x_(classed.surface.vertices), class_(classed.face_class) {}

  int insert(const Vec3& p, const SurfacePoint& at) {
    taken_.push_back(place(p, at));
    return taken_.back();
  }

 private:
  int place(const Vec3& p, const SurfacePoint& at) {
    const Triangle f = faces_[at.face];
    double shortest = 1e300;
    for (int k = 0; k < 3; ++k)
      shortest = std::min(shortest, (x_[f[k]] - x_[f[(k + 1) % 3]]).norm());
    int beside = f[0];
    for (const int v : f)
      if ((x_[v] - at.point).norm() < (x_[beside] - at.point).norm()) beside = v;
    const double gap = (x_[beside] - at.point).norm();
    const bool taken = std::find(taken_.begin(), taken_.end(), beside) != taken_.end();
    if (taken && gap < kSame * shortest) return beside;
    if (!taken && gap < kBeside * shortest && move(beside, p)) return beside;
    if (gap < 1e-3 * shortest) return beside;

    const double area = normal(x_[f[0]], x_[f[1]], x_[f[2]]).norm();
    for (int k = 0; k < 3; ++k) {
      const Vec3 &a = x_[f[k]], &b = x_[f[(k + 1) % 3]];
      if (normal(a, b, at.point).norm() < kOnEdge * area) {
        const double t = (at.point - a).dot(b - a) / (b - a).squaredNorm();
        return split_edge(f[k], f[(k + 1) % 3], a + std::clamp(t, 0.0, 1.0) * (b - a), p);
      }
    }
    const int v = add(at.point);
    faces_[at.face] = {f[0], f[1], v};
    add_face({f[1], f[2], v}, class_[at.face]);
    add_face({f[2], f[0], v}, class_[at.face]);
    move(v, p);
    return v;
  }

  int add(const Vec3& p) {
    x_.push_back(p);
    return static_cast<int>(x_.size()) - 1;
  }

  void add_face(const Triangle& f, std::uint8_t its) {
    faces_.push_back(f);
    class_.push_back(its);
  }

  int split_edge(int a, int b, const Vec3& on_edge, const Vec3& p) {
    const int v = add(on_edge);
    const std::size_t count = faces_.size();
    for (std::size_t i = 0; i < count; ++i)
      for (int k = 0; k < 3; ++k) {
        const int s = faces_[i][k], e = faces_[i][(k + 1) % 3], o = faces_[i][(k + 2) % 3];
        if (!((s == a && e == b) || (s == b && e == a))) continue;
        faces_[i] = {s, v, o};
        add_face({v, e, o}, class_[i]);
        break;
      }
    move(v, p);
    return v;
  }

  // Whether the vertex may be moved: no face about it folds or shrinks away, no outline of a class
  // and no sharp edge of the body is bent.
  bool move(int v, const Vec3& to) {
    std::uint8_t classes = 0;
    Vec3 sum = Vec3::Zero();
    std::vector<Vec3> normals;
    for (std::size_t i = 0; i < faces_.size(); ++i) {
      const Triangle& f = faces_[i];
      const auto own = std::find(f.begin(), f.end(), v);
      if (own == f.end()) continue;
      classes |= class_[i] ? 2 : 1;
      const int k = static_cast<int>(own - f.begin());
      const Vec3 &b = x_[f[(k + 1) % 3]], &c = x_[f[(k + 2) % 3]];
      const Vec3 before = normal(x_[v], b, c), after = normal(to, b, c);
      if (!(before.dot(after) > kLeastCosine * before.norm() * after.norm()) ||
          after.norm() < 0.1 * before.norm())
        return false;
      sum += before;
      normals.push_back(before.normalized());
    }
    const bool moves = (to - x_[v]).norm() > 0;
    if (moves && classes == 3) return false;
    for (const Vec3& n : normals)
      if (moves && n.dot(sum.normalized()) < kLeastCosine) return false;
    x_[v] = to;
    return true;
  }

  std::vector<Triangle>& faces_;
  std::vector<Vec3>& x_;
  std::vector<std::uint8_t>& class_;
  std::vector<int> taken_;  // by points before
};

}  // namespace

std::vector<int> insert_points(ClassedSurface& classed, const std::vector<Vec3>& points) {
  Inserter inserter(classed);
  std::vector<int> vertices;
  for (const Vec3& p : points)
    vertices.push_back(inserter.insert(p, nearest_point(classed.surface, p)));
  return vertices;
}

}  // namespace hapsim
