#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <set>

#include "base/median.h"
#include "mesh/surface_tree.h"
#include "reconstruct/plan_view.h"

namespace hapsim {
namespace {

using Sparse = Eigen::SparseMatrix<double>;
using Entry = Eigen::Triplet<double>;

constexpr int kFolds = 5;

// A point over the plan: its triangle, shares of the corners, height.
struct Sample {
  Triangle face;
  Vec3 share;
  double z;
};

std::vector<Sample> samples_over(const Surface& plan, const std::vector<Vec3>& points) {
  const SurfaceTree tree(plan);
  std::vector<Sample> samples;
  for (const Vec3& p : points) {
    const SurfacePoint near = tree.nearest({p.x(), p.y(), 0});
    const Triangle& f = plan.faces[near.face];
    const Vec3& a = plan.vertices[f[0]];
    const Vec3 u = plan.vertices[f[1]] - a;
    const Vec3 v = plan.vertices[f[2]] - a;
    const double area = u.cross(v).z();
    // A point just outside the outline speaks for the line's continuation: shares beyond 0 to 1.
    const Vec3 d = Vec3(p.x(), p.y(), 0) - a;
    const double s = d.cross(v).z() / area;
    const double t = u.cross(d).z() / area;
    if (std::max({std::abs(s), std::abs(t), std::abs(1 - s - t)}) > 2.5) continue;
    samples.push_back({f, {1 - s - t, s, t}, p.z()});
  }
  return samples;
}

// Squared Laplacian: cotangent weights inside; along the rim, second differences.
Sparse bending(const Surface& plan) {
  const auto n = static_cast<Eigen::Index>(plan.vertices.size());
  std::vector<Entry> entries;
  std::set<std::pair<int, int>> half;
  for (const Triangle& f : plan.faces) {
    for (int k = 0; k < 3; ++k) half.emplace(f[k], f[(k + 1) % 3]);
  }
  std::vector<char> rim(n, 0);
  std::vector<int> before(n, -1), after(n, -1);
  for (const auto& [a, b] : half) {
    if (half.count({b, a}) > 0) continue;
    rim[a] = rim[b] = 1;
    after[a] = b;
    before[b] = a;
  }
  for (const Triangle& f : plan.faces) {
    for (int k = 0; k < 3; ++k) {
      const int a = f[k], b = f[(k + 1) % 3], c = f[(k + 2) % 3];
      const Vec3 u = plan.vertices[a] - plan.vertices[c];
      const Vec3 v = plan.vertices[b] - plan.vertices[c];
      const double cotangent = u.dot(v) / u.cross(v).norm() / 2;
      for (const auto& [i, j] : {std::pair(a, b), std::pair(b, a)}) {
        if (rim[i]) continue;
        entries.emplace_back(i, i, cotangent);
        entries.emplace_back(i, j, -cotangent);
      }
    }
  }
  for (int v = 0; v < n; ++v) {
    if (!rim[v] || before[v] < 0 || after[v] < 0) continue;
    entries.emplace_back(v, v, 1.0);
    entries.emplace_back(v, before[v], -0.5);
    entries.emplace_back(v, after[v], -0.5);
  }
  Sparse laplace(n, n);
  laplace.setFromTriplets(entries.begin(), entries.end());
  return laplace.transpose() * laplace;
}

// Heights for one smoothing; samples of the fold `without` are left out.
Eigen::VectorXd solve(const std::vector<Sample>& samples, const std::vector<double>& weight,
                      const Sparse& bend, double smoothing, int without) {
  const Eigen::Index n = bend.rows();
  std::vector<Entry> entries;
  Eigen::VectorXd right = Eigen::VectorXd::Zero(n);
  double mean = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (static_cast<int>(i % kFolds) == without || weight[i] <= 0) continue;
    const Sample& s = samples[i];
    mean += s.z;
    for (int k = 0; k < 3; ++k) {
      right[s.face[k]] += weight[i] * s.share[k] * s.z;
      for (int l = 0; l < 3; ++l) {
        entries.emplace_back(s.face[k], s.face[l], weight[i] * s.share[k] * s.share[l]);
      }
    }
  }
  Sparse matrix(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  Sparse unit(n, n);
  unit.setIdentity();
  // A trace of a pull to the mean height settles what neither points nor smoothness do.
  mean /= static_cast<double>(samples.size());
  const double trace = 1e-9 * (smoothing + 1);
  matrix += smoothing * bend + trace * unit;
  right.array() += trace * mean;
  const Eigen::SimplicialLDLT<Sparse> solver(matrix);
  return solver.solve(right);
}

double residual(const Sample& s, const Eigen::VectorXd& z) {
  double height = 0;
  for (int k = 0; k < 3; ++k) height += s.share[k] * z[s.face[k]];
  return s.z - height;
}

std::vector<double> tukey(const std::vector<Sample>& samples, const Eigen::VectorXd& z) {
  std::vector<double> size;
  for (const Sample& s : samples) size.push_back(std::abs(residual(s, z)));
  const double cut = 4.685 * 1.4826 * std::max(upper_median(size), 1e-9);
  std::vector<double> weight;
  for (const double r : size) {
    const double t = 1 - r * r / (cut * cut);
    weight.push_back(t > 0 ? t * t : 0);
  }
  return weight;
}

// Mean over the held-out points of min(r^2, c^2): one cut for all smoothings.
double heldout(const std::vector<Sample>& samples, const std::vector<double>& weight,
               const Sparse& bend, double smoothing) {
  double sum = 0;
  for (int fold = 0; fold < kFolds; ++fold) {
    const Eigen::VectorXd z = solve(samples, weight, bend, smoothing, fold);
    for (std::size_t i = fold; i < samples.size(); i += kFolds) {
      const double r = residual(samples[i], z);
      sum += weight[i] * r * r;
    }
  }
  return sum;
}

}  // namespace

std::vector<double> fit_heights(const Surface& plan, const std::vector<Vec3>& points) {
  const std::vector<Sample> samples = samples_over(plan, points);
  const Sparse bend = bending(plan);
  const double density =
      static_cast<double>(samples.size()) / static_cast<double>(plan.vertices.size());
  std::vector<double> weight(samples.size(), 1);
  // A first, smooth surface tells gross outliers from points.
  for (int round = 0; round < 3; ++round) {
    weight = tukey(samples, solve(samples, weight, bend, 3 * density, -1));
  }
  double best = 0, best_error = 1e300;
  for (double smoothing = 300; smoothing > 1e-3; smoothing /= 3.1623) {
    const double error = heldout(samples, weight, bend, smoothing * density);
    // Less smoothing must earn its place by more than a hair.
    if (error < 0.998 * best_error) {
      best_error = error;
      best = smoothing * density;
    }
  }
  Eigen::VectorXd z = solve(samples, weight, bend, best, -1);
  for (int round = 0; round < 2; ++round) {
    z = solve(samples, tukey(samples, z), bend, best, -1);
  }
  return {z.data(), z.data() + z.size()};
}

}  // namespace hapsim
