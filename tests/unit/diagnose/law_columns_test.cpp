// Laws that act alike on all samples.
#include "diagnose/law_columns.h"

#include <gtest/gtest.h>

#include <Eigen/QR>

#include "base/random.h"

namespace hapsim {
namespace {

// Places of a ball, each pressed into the surface and aside, that are stiffer along the normal than
// across it by one ratio; forces and what another motion would change of them.
struct Pressed {
  LawSamples s;
  Eigen::VectorXd change;

  explicit Pressed(const Eigen::Matrix3d& of_motion) {
    constexpr int kPlaces = 24, kWays = 3;
    constexpr double kStiffness = 300, kAcross = 0.7;
    const Eigen::Index count = kPlaces * kWays;
    for (LawSamples::Vectors* v : {&s.normal, &s.u, &s.f, &s.across}) v->setZero(3, count);
    change.resize(3 * count);
    Random random(4);
    const auto any = [&] { return Vec3(random.normal(), random.normal(), random.normal()); };
    for (Eigen::Index i = 0; i < count; ++i) {
      if (i % kWays == 0)
        s.normal.col(i) = any().normalized();
      else
        s.normal.col(i) = s.normal.col(i - 1);
      const Vec3 n = s.normal.col(i), aside = any();
      const double slant = 0.5 * static_cast<double>(i % kWays);
      s.u.col(i) = 1e-3 * (slant * (aside - aside.dot(n) * n) - n);
      const auto force = [&](const Vec3& u) -> Vec3 {
        return kStiffness * (n.dot(u) * n + kAcross * (u - n.dot(u) * n));
      };
      s.f.col(i) = force(s.u.col(i));
      s.across.col(i) = s.f.col(i) - n.dot(Vec3(s.f.col(i))) * n;
      change.segment<3>(3 * i) = force(of_motion * s.u.col(i));
      s.kept.push_back(i);
    }
  }

  double left_by(const law::Columns& columns) const {
    const Eigen::MatrixXd A = law::stacked(columns, s);
    return (change - A * A.completeOrthogonalDecomposition().solve(change)).norm() / change.norm();
  }
};

// A robot whose axes are mixed is no sensor whose are, where normals differ.
TEST(LawColumns, AMatrixOfTheMotionIsNoneOfTheForce) {
  Eigen::Matrix3d mixed;
  mixed << 0.05, 0.2, 0, -0.1, 0, 0.1, 0.15, 0, -0.05;
  const Pressed p(mixed);
  EXPECT_LT(p.left_by(law::by_motion(p.s)), 1e-9);
  EXPECT_GT(p.left_by(law::by_matrix(p.s)), 0.1);
}

TEST(LawColumns, AScaleOfAllAxesIsBoth) {
  const Pressed p(0.1 * Eigen::Matrix3d::Identity());
  EXPECT_LT(p.left_by(law::by_motion(p.s)), 1e-9);
  EXPECT_LT(p.left_by(law::by_matrix(p.s)), 1e-9);
}

}  // namespace
}  // namespace hapsim
