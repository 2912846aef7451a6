#include "contact/field_stiffness.h"

#include <algorithm>
#include <cmath>

namespace hapsim {
namespace {

// The cell of a coordinate and the share of the way through it.
std::pair<int, double> cell_of(double x, int count) {
  if (count < 2) return {0, 0.0};
  const double clamped = std::clamp(x, 0.0, static_cast<double>(count - 1));
  const int cell = std::min(static_cast<int>(clamped), count - 2);
  return {cell, clamped - cell};
}

template <class Add>
void for_weights(const FieldGrid& grid, const Vec3& p, const Add& add) {
  std::pair<int, double> at[3];
  for (int c = 0; c < 3; ++c) at[c] = cell_of((p[c] - grid.low[c]) / grid.step, grid.count[c]);
  for (int corner = 0; corner < 8; ++corner) {
    double weight = 1;
    int index[3];
    for (int c = 0; c < 3; ++c) {
      const bool high = (corner >> c & 1) != 0;
      weight *= high ? at[c].second : 1 - at[c].second;
      index[c] = at[c].first + (high ? 1 : 0);
    }
    if (weight > 0) add(grid.index(index[0], index[1], index[2]), weight);
  }
}

using Corners = std::array<Vec3, 4>;

// The eight tetrahedra of equal volume that the middles of the edges make: four at the corners, and
// the octahedron between them cut along one diagonal.
std::array<Corners, 8> eighths(const Corners& t) {
  const auto& [a, b, c, d] = t;
  const Vec3 ab = (a + b) / 2, ac = (a + c) / 2, ad = (a + d) / 2, bc = (b + c) / 2,
             bd = (b + d) / 2, cd = (c + d) / 2;
  return {Corners{a, ab, ac, ad},  {b, ab, bc, bd},  {c, ac, bc, cd},  {d, ad, bd, cd},
          Corners{ab, cd, ac, ad}, {ab, cd, ad, bd}, {ab, cd, bd, bc}, {ab, cd, bc, ac}};
}

// Points that stand for equal parts of a tetrahedron, closer than `step` where that takes no more
// than 64.
void add_points(const Corners& t, double step, int level, std::vector<Vec3>& points) {
  double longest = 0;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < i; ++j) longest = std::max(longest, (t[i] - t[j]).norm());
  if (level == 0 || (level == 1 && longest < 2 * step)) {
    points.push_back((t[0] + t[1] + t[2] + t[3]) / 4);
    return;
  }
  for (const Corners& part : eighths(t)) add_points(part, step, level - 1, points);
}

}  // namespace

Vec3 FieldGrid::node(std::size_t n) const {
  const auto nx = static_cast<std::size_t>(count[0]), ny = static_cast<std::size_t>(count[1]);
  return low + step * Vec3(static_cast<double>(n % nx), static_cast<double>(n / nx % ny),
                           static_cast<double>(n / nx / ny));
}

void FieldGrid::add_weights(const Vec3& p, double factor,
                            Eigen::Ref<Eigen::VectorXd> weights) const {
  for_weights(*this, p, [&](std::size_t n, double w) {
    weights[static_cast<Eigen::Index>(n)] += factor * w;
  });
}

double FieldGrid::value(const Eigen::VectorXd& field, const Vec3& p) const {
  double sum = 0;
  for_weights(*this, p,
              [&](std::size_t n, double w) { sum += w * field[static_cast<Eigen::Index>(n)]; });
  return sum;
}

FieldBody::FieldBody(const ContactBase& base, const Vec3& position, double radius, double rim_edge,
                     double growth, const FieldGrid& grid)
    : contact_(make_contact_mesh(base, position, radius, rim_edge, growth)), grid_(grid) {
  const TetMesh& mesh = contact_.mesh;
  std::vector<int> handle(mesh.nodes.size(), kFreeNode);
  for (std::size_t n = 0; n < handle.size(); ++n)
    if (mesh.fixed[n]) handle[n] = kHeldNode;
  for (const int n : contact_.patch_nodes) handle[n] = 0;
  body_ = std::make_unique<ElasticBody>(mesh, handle, Dilatation::kElement);
  weights_.resize(mesh.tets.size());
  std::vector<double> sum(grid_.size(), 0);  // of the weights of one element
  std::vector<int> met;
  std::vector<Vec3> points;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const auto& n = mesh.tets[t];
    points.clear();
    const Corners corners{mesh.nodes[n[0]], mesh.nodes[n[1]], mesh.nodes[n[2]], mesh.nodes[n[3]]};
    add_points(corners, grid_.step, 2, points);
    const double share = 1 / static_cast<double>(points.size());
    for (const Vec3& p : points)
      for_weights(grid_, p, [&](std::size_t node, double w) {
        if (sum[node] == 0) met.push_back(static_cast<int>(node));
        sum[node] += w * share;
      });
    std::sort(met.begin(), met.end());
    for (const int node : met) {
      weights_[t].emplace_back(node, sum[static_cast<std::size_t>(node)]);
      sum[static_cast<std::size_t>(node)] = 0;
    }
    met.clear();
  }
}

FieldBody::Solution FieldBody::solve(double nu, const Eigen::VectorXd& log_modulus,
                                     bool derivatives) {
  const TetMesh& mesh = contact_.mesh;
  const Lame unit = lame(1, nu);
  std::vector<Lame> constants(mesh.tets.size());
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    double log_e = 0;
    for (const auto& [node, w] : weights_[t]) log_e += w * log_modulus[node];
    const double modulus = std::exp(log_e);
    constants[t] = {modulus * unit.lambda, modulus * unit.mu};
  }
  body_->factorise(constants);
  const ElasticBody::Response response = body_->solve(Eigen::Matrix3d::Identity());
  Solution solution;
  solution.K = response.reaction;
  if (!derivatives) return solution;
  const Eigen::Matrix<double, Eigen::Dynamic, 3> fields = response.field;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const ElementEnergies e = element_energies(mesh, t, fields, Dilatation::kElement);
    solution.by_element.push_back(constants[t].lambda * e.volumetric +
                                  constants[t].mu * e.deviatoric);
  }
  return solution;
}

Eigen::MatrixXd FieldBody::by_node(const Solution& solution) const {
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(6, static_cast<Eigen::Index>(grid_.size()));
  for (std::size_t t = 0; t < weights_.size(); ++t) {
    const Eigen::Matrix3d& k = solution.by_element[t];
    Eigen::Matrix<double, 6, 1> v;
    v << k(0, 0), k(1, 1), k(2, 2), k(0, 1), k(1, 2), k(0, 2);
    for (const auto& [node, w] : weights_[t]) result.col(node) += w * v;
  }
  return result;
}

}  // namespace hapsim
