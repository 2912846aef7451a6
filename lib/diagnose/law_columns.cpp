#include "diagnose/law_columns.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hapsim::law {

std::vector<double> quantiles(const Column& x, int count) {
  std::vector<double> sorted(x.begin(), x.end()), knots;
  std::sort(sorted.begin(), sorted.end());
  for (int k = 0; k < count; ++k) {
    const double at = sorted[(sorted.size() - 1) * static_cast<std::size_t>(k) /
                             static_cast<std::size_t>(count - 1)];
    if (knots.empty() || at > knots.back()) knots.push_back(at);
  }
  return knots;
}

std::vector<double> even(const Column& x, int count) {
  std::vector<double> knots;
  for (int k = 0; k < count; ++k)
    knots.push_back(x.minCoeff() + (x.maxCoeff() - x.minCoeff()) * k / (count - 1));
  return knots;
}

std::vector<Column> hats(const Column& x, const std::vector<double>& knots) {
  std::vector<Column> hat(knots.size(), Column::Zero(x.size()));
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const auto above = static_cast<std::size_t>(std::upper_bound(knots.begin(), knots.end(), x[i]) -
                                                knots.begin());
    if (above == 0 || above == knots.size()) {
      hat[above == 0 ? 0 : above - 1][i] = 1;
      continue;
    }
    const double share = (x[i] - knots[above - 1]) / (knots[above] - knots[above - 1]);
    hat[above - 1][i] = 1 - share;
    hat[above][i] = share;
  }
  return hat;
}

Columns gains(const LawSamples& s) {
  return {s.along, s.across};
}
Columns gains_of_axes(const LawSamples& s) {
  Columns c(3, Vectors::Zero(3, s.f.cols()));
  for (Eigen::Index axis = 0; axis < 3; ++axis)
    c[static_cast<std::size_t>(axis)].row(axis) = s.f.row(axis);
  return c;
}
Columns zeros(const LawSamples& s) {
  Columns c(3, Vectors::Zero(3, s.f.cols()));
  for (Eigen::Index axis = 0; axis < 3; ++axis)
    c[static_cast<std::size_t>(axis)].row(axis).setOnes();
  c.push_back(s.normal);
  return c;
}

Columns by_matrix(const LawSamples& s) {
  Columns c;
  for (Eigen::Index to = 0; to < 3; ++to)
    for (Eigen::Index from = 0; from < 3; ++from) {
      c.emplace_back(Vectors::Zero(3, s.f.cols()));
      c.back().row(to) = s.f.row(from);
    }
  return c;
}

Columns by_motion(const LawSamples& s) {
  constexpr double kSideways = 0.1;  // of the motion, to tell a stiffness
  const Eigen::Index count = s.f.cols();
  Column along = Column::Zero(count), across = Column::Zero(count);
  double products = 0, squares = 0;
  for (Eigen::Index i = 0; i < count; ++i) {
    const Vec3 n = s.normal.col(i), u = s.u.col(i), side = u - n.dot(u) * n;
    const double down = n.dot(u);
    if (std::abs(down) > kSideways * u.norm()) along[i] = n.dot(Vec3(s.f.col(i))) / down;
    if (side.norm() > kSideways * u.norm()) across[i] = s.across.col(i).norm() / side.norm();
    products += std::abs(along[i]) * across[i];
    squares += across[i] > 0 ? along[i] * along[i] : 0;
  }
  const double ratio = squares > 0 ? products / squares : 0;
  Columns c;
  for (Eigen::Index to = 0; to < 3; ++to)
    for (Eigen::Index from = 0; from < 3; ++from) {
      c.emplace_back(Vectors::Zero(3, count));
      for (Eigen::Index i = 0; i < count; ++i) {
        const Vec3 n = s.normal.col(i), e = Vec3::Unit(to);
        const double aside = std::copysign(across[i] > 0 ? across[i] : ratio * along[i], along[i]);
        c.back().col(i) = s.u(from, i) * (along[i] * n[to] * n + aside * (e - n[to] * n));
      }
    }
  return c;
}

Columns join(Columns a, const Columns& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

Columns times(const std::vector<Column>& factors, const Columns& what) {
  Columns c;
  for (const Column& factor : factors)
    for (const Vectors& v : what) c.emplace_back(v * factor.asDiagonal());
  return c;
}

std::vector<Column> products(const std::vector<Column>& a, const std::vector<Column>& b) {
  std::vector<Column> all;
  for (const Column& one : a)
    for (const Column& other : b) all.emplace_back(one.cwiseProduct(other));
  return all;
}

std::vector<Column> numbers(const LawSamples& s) {
  const double most = std::min(5.0, s.number.maxCoeff());
  std::vector<Column> found;
  for (double number = 0; number <= most; ++number)
    found.push_back(
        s.number.unaryExpr([&](double x) { return std::min(x, most) == number ? 1.0 : 0.0; }));
  return found;
}

Column slants(const LawSamples& s) {
  return s.across.colwise().norm().array() /
         (s.f.colwise().norm().array() + std::numeric_limits<double>::min());
}

Eigen::MatrixXd stacked(const Columns& columns, const LawSamples& s) {
  Eigen::MatrixXd X(s.f.size(), static_cast<Eigen::Index>(columns.size()));
  for (std::size_t k = 0; k < columns.size(); ++k)
    X.col(static_cast<Eigen::Index>(k)) = columns[k].reshaped();
  return X;
}

}  // namespace hapsim::law
