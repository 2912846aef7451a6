// Two regions that relax each in its own way, as Maxwell elements of the tool's stiffness, against
// the whole body integrated in time in ever finer steps.
#include "solid/relaxation_spectrum.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "base/error.h"
#include "solid/elastic_assembly.h"
#include "support/block_mesh.h"

namespace hapsim {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kNu = 0.4;
const std::vector<RegionRelaxation> kRegions{{2e4, {{1e4, 0.05}, {8e3, 0.4}}},
                                             {8e3, {{2e4, 0.15}}}};

// The stiffness of each region for a modulus of one, dense over the free nodes; the patch last.
struct Body {
  std::vector<MatrixXd> A;
  Eigen::Index inside = 0;  // unknowns before the patch's

  Body() {
    const TetMesh mesh = test::block_mesh({0.04, 0.04, 0.03}, 4, 4, 3, 1, 0.2);
    std::vector<char> free;
    for (const auto fixed : mesh.fixed) free.push_back(fixed ? 0 : 1);
    NodeSystem system(free, element_cliques(mesh));
    std::vector<int> order, patch;
    int block = 0;
    for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
      if (mesh.fixed[n]) continue;
      const bool under =
          mesh.nodes[n].z() > 0.0299 && (mesh.nodes[n] - Vec3(0.02, 0.02, 0.03)).norm() < 0.011;
      for (int k = 0; k < 3; ++k) (under ? patch : order).push_back(3 * block + k);
      ++block;
    }
    inside = static_cast<Eigen::Index>(order.size());
    order.insert(order.end(), patch.begin(), patch.end());
    for (int r = 0; r < 2; ++r) {
      std::vector<Lame> constants;
      for (const auto& t : mesh.tets) {
        Vec3 centre = Vec3::Zero();
        for (int k = 0; k < 4; ++k) centre += mesh.nodes[t[k]] / 4;
        constants.push_back((centre.x() < 0.022 ? 0 : 1) == r ? lame(1, kNu) : Lame{0, 0});
      }
      assemble_elastic(system, mesh, constants, Dilatation::kPointwise);
      const SymmetricSparse& m = system.matrix();
      MatrixXd dense = MatrixXd::Zero(m.size, m.size);
      for (int c = 0; c < m.size; ++c)
        for (int k = m.column_start[c]; k < m.column_start[c + 1]; ++k)
          dense(m.row[k], c) = dense(c, m.row[k]) = m.value[k];
      A.push_back(dense(order, order));
    }
  }
  MatrixXd together(const std::vector<double>& moduli) const {
    return moduli[0] * A[0] + moduli[1] * A[1];
  }
  Eigen::Matrix3d K(const std::vector<double>& moduli) const {
    const MatrixXd a = together(moduli);
    const Eigen::Index p = a.rows() - inside;
    const MatrixXd T = Eigen::Matrix3d::Identity().replicate(p / 3, 1);
    const MatrixXd at = a.topRightCorner(inside, p) * T;
    return T.transpose() * a.bottomRightCorner(p, p) * T -
           at.transpose() * a.topLeftCorner(inside, inside).llt().solve(at);
  }
};

// A ramp in, a hold, a sideways move, a quick way out; from the relaxed body.
Vec3 motion(double t) {
  if (t < 0.1) return {0, 0, -0.02 * t};
  if (t < 0.3) return {0, 0, -0.002};
  if (t < 0.5) return {0.004 * (t - 0.3), 0, -0.002};
  return {0.0008, 0, -0.002 + 0.005 * (t - 0.5)};
}
constexpr double kEnd = 0.7;

double step_a(double dt, double tau) {
  return std::exp(-dt / tau);
}
double step_c(double dt, double tau) {
  return -std::expm1(-dt / tau) * tau / dt;
}

// Force that holds the tool at the end, every node straight between the steps.
Vec3 reference(const Body& body, int steps) {
  const double dt = kEnd / steps;
  std::vector<double> moduli;
  for (const RegionRelaxation& r : kRegions) {
    moduli.push_back(r.modulus);
    for (const MaxwellModulus& t : r.terms) moduli.back() += t.modulus * step_c(dt, t.tau);
  }
  const MatrixXd a = body.together(moduli);
  const Eigen::LLT<MatrixXd> llt(a.topLeftCorner(body.inside, body.inside));
  const Eigen::Index n = a.rows(), p = n - body.inside;
  VectorXd u = VectorXd::Zero(n), forces;
  std::vector<VectorXd> q(3, u);  // memories, region by region
  for (int i = 1; i <= steps; ++i) {
    VectorXd next(n), past = VectorXd::Zero(n);
    next.tail(p) = motion(i * dt).replicate(p / 3, 1);
    std::size_t k = 0;
    for (std::size_t r = 0; r < 2; ++r) {
      VectorXd kept = VectorXd::Zero(n);
      for (const MaxwellModulus& t : kRegions[r].terms) {
        kept += t.modulus * (step_a(dt, t.tau) * q[k] - step_c(dt, t.tau) * u);
        ++k;
      }
      past += body.A[r] * kept;
    }
    next.head(body.inside) = -llt.solve(
        (past.head(body.inside) + a.topRightCorner(body.inside, p) * next.tail(p)).eval());
    forces = a * next + past;
    k = 0;
    for (const RegionRelaxation& r : kRegions)
      for (const MaxwellModulus& t : r.terms) {
        q[k] = step_a(dt, t.tau) * q[k] + step_c(dt, t.tau) * (next - u);
        ++k;
      }
    u = next;
  }
  Vec3 sum = Vec3::Zero();
  for (Eigen::Index i = body.inside; i < n; i += 3) sum += forces.segment<3>(i);
  return sum;
}

Vec3 by_spectrum(const Body& body, const RelaxationSpectrum& spectrum, int steps) {
  const std::size_t terms = spectrum.times().size();
  MatrixXd values(static_cast<Eigen::Index>(spectrum.moduli().size()), 9);
  for (Eigen::Index k = 0; k < values.rows(); ++k)
    values.row(k) = body.K(spectrum.moduli()[static_cast<std::size_t>(k)]).reshaped().transpose();
  const MatrixXd parts = spectrum.parts(values);
  std::vector<Eigen::Matrix3d> part;
  for (Eigen::Index j = 0; j < parts.rows(); ++j) part.push_back(parts.row(j).reshaped(3, 3));
  const double dt = kEnd / steps;
  std::vector<Vec3> h(terms, Vec3::Zero());
  for (int i = 1; i <= steps; ++i)
    for (std::size_t j = 0; j < terms; ++j)
      h[j] = step_a(dt, spectrum.times()[j]) * h[j] +
             step_c(dt, spectrum.times()[j]) * part[j] * (motion(i * dt) - motion((i - 1) * dt));
  Vec3 f = values.row(0).reshaped(3, 3) * motion(kEnd);
  for (const Vec3& x : h) f += x;
  return f;
}

TEST(RelaxationSpectrum, IsTheWholeBodyInFineSteps) {
  const Body body;
  const RelaxationSpectrum spectrum(kRegions);
  // Exact for straight motion: 7 steps that end where the motion bends are as good as 700.
  const Vec3 f = by_spectrum(body, spectrum, 7), finer = by_spectrum(body, spectrum, 700);
  EXPECT_LT((f - finer).norm(), 1e-10 * f.norm());
  double last = 0;
  std::vector<Vec3> fine;
  for (const int steps : {14, 28, 56}) {
    fine.push_back(reference(body, steps));
    const double error = (fine.back() - f).norm() / f.norm();
    std::printf("%d steps of the whole body: %.2e from the spectrum's force\n", steps, error);
    if (last > 0) {
      EXPECT_NEAR(last / error, 4, 0.5);  // second order in the step
    }
    last = error;
  }
  const Vec3 limit = fine[2] + (fine[2] - fine[1]) / 3;
  std::printf("their limit: %.1e from the spectrum's force\n", (f - limit).norm() / f.norm());
  EXPECT_LT((f - limit).norm(), 1e-7 * f.norm());
}

TEST(RelaxationSpectrum, FitsTheStiffnessBetweenItsSamples) {
  const Body body;
  const RelaxationSpectrum spectrum(kRegions);
  VectorXd values(static_cast<Eigen::Index>(spectrum.moduli().size()));
  for (std::size_t k = 0; k < spectrum.moduli().size(); ++k)
    values[static_cast<Eigen::Index>(k)] = body.K(spectrum.moduli()[k])(2, 2);
  const VectorXd parts = spectrum.parts(values);
  double worst = 0;
  for (double s = 1e-3; s < 1e4; s *= 1.37) {
    double fitted = values[0];
    for (Eigen::Index j = 0; j < parts.size(); ++j) {
      const double x = s * spectrum.times()[static_cast<std::size_t>(j)];
      fitted += parts[j] * x / (1 + x);
    }
    const double exact = body.K({kRegions[0].at(s), kRegions[1].at(s)})(2, 2);
    worst = std::max(worst, std::abs(fitted - exact) / values[values.size() - 1]);
  }
  std::printf("%zu Maxwell elements, worst between samples %.1e, misfit %.1e\n",
              spectrum.times().size(), worst, spectrum.misfit(values, parts));
  EXPECT_LT(worst, 1e-9);
  EXPECT_LT(spectrum.misfit(values, parts), 1e-9);
}

// Regions of the same relative relaxation are one Maxwell material: its own elements are enough.
TEST(RelaxationSpectrum, FindsTheCommonRelaxation) {
  const RelaxationSpectrum spectrum({{1e4, {{5e3, 0.1}}}, {3e4, {{15e3, 0.1}}}});
  VectorXd values(static_cast<Eigen::Index>(spectrum.moduli().size()));
  for (std::size_t k = 0; k < spectrum.moduli().size(); ++k)
    values[static_cast<Eigen::Index>(k)] = spectrum.moduli()[k][0];
  const VectorXd parts = spectrum.parts(values);
  EXPECT_NEAR(parts.sum(), 5e3, 1e-4 * 5e3);
  double s = 3;
  double fitted = 1e4;
  for (Eigen::Index j = 0; j < parts.size(); ++j) {
    const double x = s * spectrum.times()[static_cast<std::size_t>(j)];
    fitted += parts[j] * x / (1 + x);
  }
  EXPECT_NEAR(fitted, 1e4 + 5e3 * 0.3 / 1.3, 1e-6 * 1.5e4);
}

TEST(RelaxationSpectrum, RefusesTooManyDecades) {
  EXPECT_THROW(RelaxationSpectrum({{1, {{1e9, 1e-3}}}, {1, {{1e9, 10}}}}), Error);
}

}  // namespace
}  // namespace hapsim
