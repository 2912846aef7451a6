#include "reconstruct/surface_fit.h"

#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>

#include "base/median.h"
#include "mesh/surface_tree.h"

namespace hapsim {
namespace {

using Sparse = Eigen::SparseMatrix<double>;
using Entry = Eigen::Triplet<double>;

bool on_base(const Surface& surface, const Triangle& f, double base) {
  return std::all_of(f.begin(), f.end(), [&](int v) { return surface.vertices[v].z() == base; });
}

// Unit direction in which each vertex may move; zero where it may not.
std::vector<Vec3> directions(const Surface& surface, double base) {
  std::vector<Vec3> direction(surface.vertices.size(), Vec3::Zero());
  for (std::size_t f = 0; f < surface.faces.size(); ++f) {
    const Triangle& t = surface.faces[f];
    if (on_base(surface, t, base)) continue;
    const Vec3 normal = face_normal(surface, static_cast<int>(f));
    for (const int v : t) direction[v] += normal;
  }
  for (std::size_t v = 0; v < direction.size(); ++v) {
    if (surface.vertices[v].z() == base) direction[v].z() = 0;
    const double length = direction[v].norm();
    if (length > 0) direction[v] /= length;
  }
  return direction;
}

std::vector<std::vector<int>> neighbours(const Surface& surface) {
  std::vector<std::vector<int>> ring(surface.vertices.size());
  for (const Triangle& f : surface.faces) {
    for (int k = 0; k < 3; ++k) ring[f[k]].push_back(f[(k + 1) % 3]);
  }
  return ring;
}

// Shares of the corners in a point of the triangle.
Vec3 barycentric(const Surface& surface, const Triangle& f, const Vec3& q) {
  const Vec3& a = surface.vertices[f[0]];
  const Vec3 u = surface.vertices[f[1]] - a;
  const Vec3 v = surface.vertices[f[2]] - a;
  const Vec3 n = u.cross(v);
  const double square = n.squaredNorm();
  const double s = (q - a).cross(v).dot(n) / square;
  const double t = u.cross(q - a).dot(n) / square;
  return {1 - s - t, s, t};
}

// The largest halving of the movement that turns no triangle by more than 60 degrees.
void move(Surface& surface, const std::vector<Vec3>& direction, const Eigen::VectorXd& d) {
  std::vector<double> share(surface.vertices.size(), 1);
  const std::vector<Vec3> old = surface.vertices;
  for (int attempt = 0; attempt < 6; ++attempt) {
    std::vector<Vec3> normal(surface.faces.size());
    for (std::size_t v = 0; v < old.size(); ++v) surface.vertices[v] = old[v];
    for (std::size_t f = 0; f < normal.size(); ++f) {
      normal[f] = face_normal(surface, static_cast<int>(f));
    }
    for (std::size_t v = 0; v < old.size(); ++v) {
      surface.vertices[v] = old[v] + share[v] * d[static_cast<Eigen::Index>(v)] * direction[v];
    }
    bool turned = false;
    for (std::size_t f = 0; f < normal.size(); ++f) {
      const Vec3 now = face_normal(surface, static_cast<int>(f));
      if (now.dot(normal[f]) > 0.5 * now.norm() * normal[f].norm() &&
          now.norm() > 0.2 * normal[f].norm()) {
        continue;
      }
      turned = true;
      for (const int v : surface.faces[f]) share[v] *= attempt == 5 ? 0 : 0.5;
    }
    if (!turned) return;
  }
  for (std::size_t v = 0; v < old.size(); ++v) {
    surface.vertices[v] = old[v] + share[v] * d[static_cast<Eigen::Index>(v)] * direction[v];
  }
}

}  // namespace

void fit_surface(Surface& surface, const std::vector<Vec3>& points,
                 const SurfaceFitOptions& options) {
  const auto n = static_cast<Eigen::Index>(surface.vertices.size());
  const std::vector<std::vector<int>> ring = neighbours(surface);
  for (int round = 0; round < options.rounds; ++round) {
    const SurfaceTree tree(surface);
    std::vector<SurfacePoint> near;
    std::vector<double> off;
    for (const Vec3& p : points) {
      near.push_back(tree.nearest(p));
      off.push_back(near.back().distance);
    }
    const double cut = 4.685 * 1.4826 * std::max(upper_median(off), 1e-9);
    const std::vector<Vec3> direction = directions(surface, options.base);

    std::vector<Entry> entries;
    Eigen::VectorXd right = Eigen::VectorXd::Zero(n);
    double weight_sum = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Triangle& f = surface.faces[near[i].face];
      if (off[i] >= cut || on_base(surface, f, options.base)) continue;
      const double away = off[i] / cut;
      const double weight = (1 - away * away) * (1 - away * away);
      const Vec3 share = barycentric(surface, f, near[i].point);
      const Vec3 normal = face_normal(surface, near[i].face).normalized();
      const double residual = normal.dot(points[i] - near[i].point);
      Vec3 row;
      for (int k = 0; k < 3; ++k) row[k] = share[k] * direction[f[k]].dot(normal);
      for (int k = 0; k < 3; ++k) {
        right[f[k]] += weight * row[k] * residual;
        for (int l = 0; l < 3; ++l) entries.emplace_back(f[k], f[l], weight * row[k] * row[l]);
      }
      weight_sum += weight;
    }
    const double mean = weight_sum / static_cast<double>(n);
    std::vector<Entry> second;
    for (int v = 0; v < n; ++v) {
      // The bottom neither moves nor holds the rim back.
      if (direction[v].isZero()) continue;
      double count = 0;
      for (const int w : ring[v]) {
        if (direction[w].isZero()) continue;
        second.emplace_back(v, w, -1.0);
        count += 1;
      }
      second.emplace_back(v, v, count);
    }
    Sparse laplace(n, n);
    laplace.setFromTriplets(second.begin(), second.end());
    Sparse normal_matrix(n, n);
    normal_matrix.setFromTriplets(entries.begin(), entries.end());
    Sparse unit(n, n);
    unit.setIdentity();
    // 36: the square of the usual number of neighbours.
    normal_matrix +=
        options.smoothing * mean / 36 * Sparse(laplace.transpose() * laplace) + 1e-3 * mean * unit;
    const Eigen::SimplicialLDLT<Sparse> solver(normal_matrix);
    move(surface, direction, solver.solve(right));
  }
}

}  // namespace hapsim
