#include "solid/inhomogeneity.h"

#include <algorithm>
#include <cmath>

namespace hapsim {
namespace {

// Place of the zero on the edge from i to j (of opposite signs) as a share, and its derivatives.
struct Crossing {
  double at, by_i, by_j;
};
Crossing crossing(double i, double j) {
  const double d = i - j;
  return {i / d, -j / (d * d), i / (d * d)};
}

// The corner `i` is alone on its side: the part next to it is the product of its three crossings.
CutShare corner_part(const std::array<double, 4>& v, int i) {
  CutShare part{1, {}};
  std::array<Crossing, 4> c{};
  for (int j = 0; j < 4; ++j)
    if (j != i) part.share *= (c[j] = crossing(v[i], v[j])).at;
  for (int j = 0; j < 4; ++j) {
    if (j == i) continue;
    double others = 1;
    for (int k = 0; k < 4; ++k)
      if (k != i && k != j) others *= c[k].at;
    part.by_value[i] += others * c[j].by_i;
    part.by_value[j] += others * c[j].by_j;
  }
  return part;
}

// Corners a, b negative, c, d not: a prism of three tetrahedra.
CutShare prism_part(const std::array<double, 4>& v, int a, int b, int c, int d) {
  const Crossing ac = crossing(v[a], v[c]), ad = crossing(v[a], v[d]), bc = crossing(v[b], v[c]),
                 bd = crossing(v[b], v[d]);
  CutShare part;
  part.share = ac.at * ad.at * (1 - bd.at) + ac.at * (1 - bc.at) * bd.at + bc.at * bd.at;
  const double by_ac = ad.at * (1 - bd.at) + (1 - bc.at) * bd.at, by_ad = ac.at * (1 - bd.at);
  const double by_bc = bd.at * (1 - ac.at);
  const double by_bd = -ac.at * ad.at + ac.at * (1 - bc.at) + bc.at;
  part.by_value[a] = by_ac * ac.by_i + by_ad * ad.by_i;
  part.by_value[b] = by_bc * bc.by_i + by_bd * bd.by_i;
  part.by_value[c] = by_ac * ac.by_j + by_bc * bc.by_j;
  part.by_value[d] = by_ad * ad.by_j + by_bd * bd.by_j;
  return part;
}

struct Corner {
  Vec3 at;
  LevelValue level;
};
using Corners = std::array<Vec3, 4>;
using LevelCorners = std::array<const Corner*, 4>;

// Adds the share of one part (of relative volume `weight`) and its derivatives. It is divided into
// eight tetrahedra of equal volume: four at the corners, four of the inner octahedron (Bey,
// Computing 55, 1995).
void add_part(const LevelCorners& x, const LevelSet& level, int subdivisions, double weight,
              double& share, Eigen::Ref<Eigen::RowVectorXd> by_parameters) {
  if (subdivisions > 0) {
    const auto mid = [&](int i, int j) {
      const Vec3 at = 0.5 * (x[i]->at + x[j]->at);
      return Corner{at, level(at)};
    };
    const Corner a = mid(0, 1), b = mid(0, 2), c = mid(0, 3), d = mid(1, 2), e = mid(1, 3),
                 f = mid(2, 3);
    const LevelCorners parts[] = {{x[0], &a, &b, &c}, {&a, x[1], &d, &e}, {&b, &d, x[2], &f},
                                  {&c, &e, &f, x[3]}, {&a, &b, &c, &e},   {&a, &b, &d, &e},
                                  {&b, &c, &e, &f},   {&b, &d, &e, &f}};
    for (const LevelCorners& part : parts)
      add_part(part, level, subdivisions - 1, weight / 8, share, by_parameters);
    return;
  }
  const CutShare cut =
      cut_share({x[0]->level.value, x[1]->level.value, x[2]->level.value, x[3]->level.value});
  share += weight * cut.share;
  for (std::size_t i = 0; i < 4; ++i)
    if (cut.by_value[i] != 0)
      by_parameters += weight * cut.by_value[i] * x[i]->level.by_parameters.transpose();
}

Corners corners_of(const TetMesh& mesh, std::size_t t) {
  const auto& n = mesh.tets[t];
  return {mesh.nodes[n[0]], mesh.nodes[n[1]], mesh.nodes[n[2]], mesh.nodes[n[3]]};
}

}  // namespace

std::vector<int> inside_by_centroid(const TetMesh& mesh, const LevelSet& level) {
  std::vector<int> inside;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const Corners x = corners_of(mesh, t);
    inside.push_back(level(0.25 * (x[0] + x[1] + x[2] + x[3])).value < 0);
  }
  return inside;
}

CutShare cut_share(const std::array<double, 4>& value) {
  int negative = 0;
  std::array<int, 4> order{};  // negative corners first
  for (int i = 0; i < 4; ++i)
    if (value[i] < 0) order[negative++] = i;
  for (int i = 0, at = negative; i < 4; ++i)
    if (!(value[i] < 0)) order[at++] = i;
  switch (negative) {
    case 0:
      return {0, {}};
    case 1:
      return corner_part(value, order[0]);
    case 2:
      return prism_part(value, order[0], order[1], order[2], order[3]);
    case 3: {
      CutShare rest = corner_part(value, order[3]);
      rest.share = 1 - rest.share;
      for (double& d : rest.by_value) d = -d;
      return rest;
    }
    default:
      return {1, {}};
  }
}

double inside_share(const TetMesh& mesh, std::size_t tetrahedron, const LevelSet& level,
                    int subdivisions, Eigen::Ref<Eigen::RowVectorXd> by_parameters) {
  const Corners x = corners_of(mesh, tetrahedron);
  double reach = 0;
  const Vec3 centre = 0.25 * (x[0] + x[1] + x[2] + x[3]);
  for (const Vec3& p : x) reach = std::max(reach, (p - centre).norm());
  const LevelValue at_centre = level(centre);
  by_parameters.setZero();
  if (at_centre.clear > reach) return at_centre.value < 0;
  std::array<Corner, 4> corner;
  for (std::size_t i = 0; i < 4; ++i) corner[i] = {x[i], level(x[i])};
  double share = 0;
  add_part({&corner[0], &corner[1], &corner[2], &corner[3]}, level, subdivisions, 1, share,
           by_parameters);
  return share;
}

InsideShares inside_shares(const TetMesh& mesh, const LevelSet& level, int subdivisions) {
  InsideShares result;
  const Eigen::Index parameters =
      mesh.nodes.empty() ? 0 : level(mesh.nodes.front()).by_parameters.size();
  result.by_parameters =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(mesh.tets.size()), parameters);
  Eigen::RowVectorXd row(parameters);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    result.share.push_back(inside_share(mesh, t, level, subdivisions, row));
    result.by_parameters.row(static_cast<Eigen::Index>(t)) = row;
  }
  return result;
}

std::vector<double> stiffness_factors(const std::vector<double>& share, double ratio) {
  std::vector<double> factor;
  for (const double s : share) factor.push_back(std::pow(ratio, s));
  return factor;
}

Eigen::MatrixXd by_inhomogeneity(const Eigen::MatrixXd& by_scale, const InsideShares& shares,
                                 double ratio) {
  const auto count = static_cast<Eigen::Index>(shares.share.size());
  const Eigen::VectorXd share = Eigen::Map<const Eigen::VectorXd>(shares.share.data(), count);
  const Eigen::VectorXd factor = share.unaryExpr([ratio](double s) { return std::pow(ratio, s); });
  Eigen::MatrixXd result(by_scale.rows(), 1 + shares.by_parameters.cols());
  result.col(0) = by_scale * factor.cwiseProduct(share) / ratio;
  result.rightCols(shares.by_parameters.cols()) =
      std::log(ratio) * by_scale * factor.asDiagonal() * shares.by_parameters;
  return result;
}

}  // namespace hapsim
