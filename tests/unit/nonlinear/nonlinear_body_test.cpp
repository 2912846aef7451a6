// The body at finite strain: patch tests, rigid motions, tangents and parameter derivatives, and
// what it says when it fails.
#include "nonlinear/nonlinear_body.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "linalg/conjugate_gradients.h"
#include "material/hooke_law.h"
#include "material/hyperelastic_law.h"
#include "material/ogden_law.h"
#include "solid/elastic_body.h"
#include "support/block_mesh.h"

namespace hapsim {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::VectorXd;

const std::vector<std::pair<std::string, LawPointer>>& laws() {
  static const std::vector<std::pair<std::string, LawPointer>> all{
      {"neo-Hookean", neo_hookean_law(4e3, 4e4)},
      {"Yeoh", yeoh_law(2e3, 500, 100, 4e4)},
      {"exponential", exponential_law(4e3, 2, 4e4)},
      {"Ogden", ogden_law({{3e3, 1.3}, {1e3, 6}}, 4e4)},
      {"isotropic", isotropic_law(1e4, 0.45)},
      {"Saint Venant-Kirchhoff", isotropic_law(1e4, 0.3, StrainMeasure::kGreenLagrange)},
      {"transverse", transverse_law({1e4, 4e4, 0.4, 0.3, 6e3}, {1, 1, 2})},
      {"transverse, Green-Lagrange",
       transverse_law({1e4, 4e4, 0.4, 0.3, 6e3}, {1, 1, 2}, StrainMeasure::kGreenLagrange)}};
  return all;
}

struct Formulation {
  int order;
  Dilatation dilatation;
};
constexpr Formulation kFormulations[] = {{1, Dilatation::kPointwise},
                                         {1, Dilatation::kPatch},
                                         {2, Dilatation::kPointwise},
                                         {2, Dilatation::kElement}};

// All boundary nodes on handles of their own.
std::vector<int> boundary_handles(const TetMesh& mesh, const Vec3& size) {
  std::vector<int> handle(mesh.nodes.size(), kFreeNode);
  int handles = 0;
  for (std::size_t i = 0; i < handle.size(); ++i)
    for (int c = 0; c < 3; ++c)
      if (handle[i] < 0 && (mesh.nodes[i][c] < 1e-12 || mesh.nodes[i][c] > size[c] - 1e-12))
        handle[i] = handles++;
  return handle;
}

VectorXd prescribe(const TetMesh& mesh, const std::vector<int>& handle, const Matrix3d& F) {
  VectorXd p(3 * (1 + *std::max_element(handle.begin(), handle.end())));
  for (std::size_t i = 0; i < handle.size(); ++i)
    if (handle[i] >= 0) p.segment<3>(3 * handle[i]) = F * mesh.nodes[i] - mesh.nodes[i];
  return p;
}

Matrix3d some_F() {
  Matrix3d F;
  F << 1.1, 0.15, -0.05, 0.05, 0.9, 0.1, -0.1, 0.08, 1.15;
  return F;
}

// A block on its base with a patch of its top moved; distorted mesh, two materials.
struct Pressed {
  TetMesh mesh;
  std::vector<int> handle;
  explicit Pressed(int order, int n = 3) {
    mesh = test::block_mesh({0.04, 0.05, 0.03}, n, n, n, order, 0.15);
    handle.assign(mesh.nodes.size(), kFreeNode);
    for (std::size_t i = 0; i < handle.size(); ++i) {
      const Vec3& p = mesh.nodes[i];
      if (mesh.fixed[i]) handle[i] = kHeldNode;
      if (p.z() > 0.03 - 1e-9 && (p - Vec3(0.02, 0.025, 0.03)).norm() < 0.012) handle[i] = 0;
    }
    for (std::size_t t = 0; t < mesh.tets.size(); ++t)
      mesh.region[t] = mesh.nodes[mesh.tets[t][0]].x() > 0.019;
  }
};

TEST(NonlinearBody, PassesThePatchTest) {
  const Vec3 size(0.1, 0.1, 0.1);
  for (const auto& [name, law] : laws())
    for (const Formulation& f : kFormulations) {
      const TetMesh mesh = test::block_mesh(size, 3, 3, 3, f.order, 0.15);
      const std::vector<int> handle = boundary_handles(mesh, size);
      BodyModel model{&mesh, {law}};
      model.dilatation = f.dilatation;
      NonlinearBody body(model, handle);
      const SolveReport report = body.solve(prescribe(mesh, handle, some_F()), {1e-13});
      ASSERT_TRUE(report.ok()) << name << ": " << report.message;
      double worst = 0;
      for (std::size_t i = 0; i < mesh.nodes.size(); ++i)
        worst = std::max(worst, (body.field().segment<3>(3 * static_cast<Eigen::Index>(i)) -
                                 (some_F() - Matrix3d::Identity()) * mesh.nodes[i])
                                    .norm());
      EXPECT_LT(worst, 1e-10 * size.x()) << name << " order " << f.order;
      // The work of the boundary's forces is the law's own stress times the volume.
      const Matrix3d P = nominal_stress(*law, some_F());
      const VectorXd p = prescribe(mesh, handle, some_F());
      const double work = body.reaction().dot(p);
      const double expected = size.prod() * P.cwiseProduct(some_F() - Matrix3d::Identity()).sum();
      EXPECT_NEAR(work, expected, 1e-10 * std::abs(expected)) << name << " order " << f.order;
    }
}

TEST(NonlinearBody, RigidMotionsGiveNoForceAndTurnWithTheBody) {
  Matrix3d R(Eigen::AngleAxisd(1.1, Vec3(1, -2, 0.5).normalized()));
  for (const auto& [name, law] : laws())
    for (const Formulation& f : kFormulations) {
      const TetMesh mesh = test::block_mesh({1, 1, 1}, 2, 2, 2, f.order, 0.2);
      BodyModel model{&mesh, {law}};
      model.dilatation = f.dilatation;
      BodyAssembly assembly(model);
      const auto forces = [&](const Matrix3d& F) {
        VectorXd u(3 * static_cast<Eigen::Index>(mesh.nodes.size()));
        for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
          const Vec3& x = mesh.nodes[i];
          // Beyond the linear part something curved, turned along.
          const Vec3 bent = law->small_strain()
                                ? Vec3(Vec3::Zero())
                                : Vec3(0.05 * Vec3(x.y() * x.z(), 0, x.x() * x.x()));
          u.segment<3>(3 * static_cast<Eigen::Index>(i)) = F * (x + bent) - x + Vec3(3, 4, 5);
        }
        EXPECT_TRUE(assembly.set_state(u));
        return assembly.forces();
      };
      if (law->small_strain()) {  // infinitesimal rotation
        Matrix3d W;
        W << 0, 0.3, -0.2, -0.3, 0, 0.1, 0.2, -0.1, 0;
        EXPECT_LT(forces(Matrix3d::Identity() + W).norm(), 1e-9) << name;
        continue;
      }
      const VectorXd f0 = forces(Matrix3d::Identity()), f1 = forces(R);
      for (Eigen::Index i = 0; i < f0.size(); i += 3)
        EXPECT_LT((R * f0.segment<3>(i) - f1.segment<3>(i)).norm(), 1e-11 * f0.norm()) << name;
      // R alone.
      VectorXd u(f0.size());
      for (std::size_t i = 0; i < mesh.nodes.size(); ++i)
        u.segment<3>(3 * static_cast<Eigen::Index>(i)) = R * mesh.nodes[i] - mesh.nodes[i];
      ASSERT_TRUE(assembly.set_state(u));
      EXPECT_LT(assembly.forces().norm(), 1e-11 * f0.norm()) << name;
    }
}

// Forces are the energy's slope and the tangent the forces', in a curved state.
TEST(NonlinearBody, ForcesAndTangentAreTheDifferences) {
  for (const auto& [name, law] : laws())
    for (const Formulation& f : kFormulations) {
      const TetMesh mesh = test::block_mesh({1, 1, 1}, 2, 1, 1, f.order, 0);
      BodyModel model{&mesh, {law}};
      model.dilatation = f.dilatation;
      model.foundation = {{mesh.faces[0], mesh.faces[1]}, 3e3, 1e3};
      BodyAssembly assembly(model);
      const Eigen::Index size = 3 * static_cast<Eigen::Index>(mesh.nodes.size());
      VectorXd u(size);
      for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
        const Vec3& x = mesh.nodes[i];
        u.segment<3>(3 * static_cast<Eigen::Index>(i)) =
            (some_F() - Matrix3d::Identity()) * x +
            0.05 * Vec3(x.y() * x.z(), std::sin(3 * x.x()), x.x() * x.x());
      }
      NodeSystem system(std::vector<char>(mesh.nodes.size(), 1), assembly.cliques());
      std::vector<BodyAssembly::CliqueMatrix> kept;
      ASSERT_TRUE(assembly.set_state(u));
      const VectorXd forces = assembly.forces();
      system.clear();
      assembly.tangent(system, std::vector<char>(mesh.nodes.size(), 0), kept);
      const SymmetricSparse& s = system.matrix();
      MatrixXd K = MatrixXd::Zero(size, size);
      for (int c = 0; c < s.size; ++c)
        for (int k = s.column_start[c]; k < s.column_start[c + 1]; ++k)
          K(s.row[k], c) = K(c, s.row[k]) = s.value[k];
      VectorXd direction = VectorXd::Zero(size);
      for (Eigen::Index i = 0; i < size; ++i) direction[i] = std::cos(1.7 * static_cast<double>(i));
      const double h = 1e-6;
      ASSERT_TRUE(assembly.set_state(u + h * direction));
      const VectorXd up = assembly.forces();
      const double energy_up = assembly.energy();
      ASSERT_TRUE(assembly.set_state(u - h * direction));
      const VectorXd change = (up - assembly.forces()) / (2 * h);
      const double slope = (energy_up - assembly.energy()) / (2 * h);
      EXPECT_NEAR(slope, forces.dot(direction), 1e-6 * forces.norm()) << name;
      EXPECT_LT((change - K * direction).norm(), 1e-7 * change.norm())
          << name << " order " << f.order << " formulation " << static_cast<int>(f.dilatation);
    }
}

TEST(NonlinearBody, SmallStrainIsTheLinearBody) {
  for (const int order : {1, 2}) {
    const Pressed p(order);
    const std::vector<double> modulus{1e4, 3e4};
    BodyModel model{&p.mesh, {isotropic_law(modulus[0], 0.4), isotropic_law(modulus[1], 0.4)}};
    NonlinearBody body(model, p.handle);
    ElasticBody linear(p.mesh, p.handle);
    std::vector<Lame> constants;
    for (const int r : p.mesh.region) constants.push_back(lame(modulus[r], 0.4));
    linear.factorise(constants);
    const Matrix3d K = linear.solve(Matrix3d::Identity()).reaction;
    EXPECT_LT((body.linearise().K - K).norm(), 1e-10 * K.norm());
    const SolveReport report = body.solve(Vec3(0, 0, -0.001));
    EXPECT_TRUE(report.ok());
    EXPECT_EQ(report.newton_steps, 1);
    EXPECT_LT((body.reaction() - K * Vec3(0, 0, -0.001)).norm(), 1e-10 * body.reaction().norm());
  }
}

// d reaction by displacement, constants, element factors and foundation, against central
// differences of converged solutions.
TEST(NonlinearBody, DerivativesAreTheDifferences) {
  for (const Formulation& f : kFormulations) {
    const Pressed p(f.order, f.order == 1 ? 3 : 2);
    const std::vector<double> start{4e3, 2, 4e4, 2e3, 400, 50, 3e4};
    std::vector<double> factors(p.mesh.tets.size(), 1.0);
    for (std::size_t t = 0; t < factors.size(); ++t) factors[t] = 1 + 0.3 * std::sin(0.7 * t);
    const auto make = [](const std::vector<double>& c) {
      return std::vector<LawPointer>{exponential_law(c[0], c[1], c[2]),
                                     yeoh_law(c[3], c[4], c[5], c[6])};
    };
    BodyModel model{&p.mesh, make(start)};
    model.dilatation = f.dilatation;
    model.scale = factors;
    Vec3 press(0.001, -0.0005, -0.005);
    const SolveOptions exact{1e-13};
    NonlinearBody body(model, p.handle);
    ASSERT_TRUE(body.solve(press, exact).ok());
    const auto d = body.linearise(true);
    ASSERT_TRUE(d.stable);
    EXPECT_LT((d.K - d.K.transpose()).norm(), 1e-10 * d.K.norm());
    const auto forces = [&](const Vec3& u) {
      EXPECT_TRUE(body.solve(u, exact).ok());
      return Vec3(body.reaction());
    };
    for (int k = 0; k < 3; ++k) {
      const Vec3 h = 1e-7 * Vec3::Unit(k);
      const Vec3 difference = (forces(press + h) - forces(press - h)) / 2e-7;
      EXPECT_LT((difference - d.K.col(k)).norm(), 1e-6 * d.K.norm()) << "displacement " << k;
    }
    const double size = forces(press).norm();
    for (std::size_t k = 0; k < start.size(); ++k) {
      std::vector<double> up = start, down = start;
      up[k] *= 1 + 1e-4;
      down[k] *= 1 - 1e-4;
      body.set_laws(make(up));
      const Vec3 a = forces(press);
      body.set_laws(make(down));
      const Vec3 difference = (a - forces(press)) / (2e-4 * start[k]);
      const Vec3 given = k < 3 ? d.by_constants[0].col(static_cast<Eigen::Index>(k))
                               : d.by_constants[1].col(static_cast<Eigen::Index>(k) - 3);
      EXPECT_LT((difference - given).norm(), 1e-6 * size / start[k]) << "constant " << k;
    }
    body.set_laws(make(start));
    for (const std::size_t t : {std::size_t{0}, p.mesh.tets.size() / 2, p.mesh.tets.size() - 1}) {
      std::vector<double> up = factors, down = factors;
      up[t] += 1e-3;
      down[t] -= 1e-3;
      body.set_scale(up);
      const Vec3 a = forces(press);
      body.set_scale(down);
      const Vec3 difference = (a - forces(press)) / 2e-3;
      EXPECT_LT((difference - d.by_scale.col(static_cast<Eigen::Index>(t))).norm(), 1e-6 * size)
          << "factor " << t;
    }
    // The force is homogeneous of degree one in the factors (Euler).
    body.set_scale(factors);
    const VectorXd sum = d.by_scale * Eigen::Map<const VectorXd>(factors.data(), factors.size());
    EXPECT_LT((sum - forces(press)).norm(), 1e-9 * size);
  }
}

// A body on an elastic foundation: a stiff block sinks as a whole, F = k_n A u; derivatives by k.
TEST(NonlinearBody, FoundationCarriesTheBody) {
  for (const int order : {1, 2}) {
    TetMesh mesh = test::block_mesh({0.04, 0.05, 0.03}, 2, 2, 2, order);
    std::vector<int> handle(mesh.nodes.size(), kFreeNode);
    for (std::size_t i = 0; i < handle.size(); ++i)
      if (mesh.nodes[i].z() > 0.03 - 1e-9) handle[i] = 0;
    BodyModel model{&mesh, {isotropic_law(1e9, 0.3)}};
    for (const Triangle& f : mesh.faces)
      if (mesh.nodes[f[0]].z() + mesh.nodes[f[1]].z() + mesh.nodes[f[2]].z() < 1e-9)
        model.foundation.faces.push_back(f);
    model.foundation.normal = 1e5;
    model.foundation.tangential = 3e4;
    NonlinearBody body(model, handle);
    ASSERT_TRUE(body.solve(Vec3(0.001, 0, -0.002)).ok());
    const double area = 0.04 * 0.05;
    EXPECT_NEAR(body.reaction()[2], -1e5 * area * 0.002, 1e-4 * 0.4);
    EXPECT_NEAR(body.reaction()[0], 3e4 * area * 0.001, 1e-4 * 0.4);
    const auto d = body.linearise();
    EXPECT_NEAR(d.by_foundation(2, 0), -area * 0.002, 1e-3 * area * 0.002);
    EXPECT_NEAR(d.by_foundation(0, 1), area * 0.001, 1e-3 * area * 0.002);
  }
}

// The stiffness of a body by conjugate gradients, nearly incompressible included.
TEST(NonlinearBody, StiffnessBySteps) {
  for (const double nu : {0.3, 0.49}) {
    const TetMesh mesh = test::block_mesh({0.04, 0.05, 0.03}, 5, 5, 5, 2, 0.15);
    BodyModel model{&mesh, {isotropic_law(1e4, nu)}};
    model.dilatation = Dilatation::kElement;
    BodyAssembly assembly(model);
    std::vector<char> free;
    for (const auto f : mesh.fixed) free.push_back(f == 0);
    NodeSystem system(free, assembly.cliques());
    std::vector<BodyAssembly::CliqueMatrix> kept;
    ASSERT_TRUE(
        assembly.set_state(VectorXd::Zero(3 * static_cast<Eigen::Index>(mesh.nodes.size()))));
    assembly.tangent(system, std::vector<char>(mesh.nodes.size(), 0), kept);
    ConjugateGradients cg;
    ASSERT_TRUE(cg.prepare(system.matrix()));
    const VectorXd b = VectorXd::Ones(system.unknowns());
    Eigen::MatrixXd x = VectorXd::Zero(b.size());
    const IterationReport report = cg.solve(b, x, 1e-9);
    EXPECT_TRUE(report.converged);
    std::printf("nu %.2f: %d steps for %d unknowns, shift %.3g\n", nu, report.iterations,
                system.unknowns(), cg.shift());
    EXPECT_LT(report.iterations, nu < 0.4 ? 150 : 400);
  }
}

TEST(NonlinearBody, SaysWhenItFails) {
  const Pressed p(1);
  const LawPointer law = neo_hookean_law(4e3, 4e4);
  BodyModel model{&p.mesh, {law, law}};
  NonlinearBody body(model, p.handle);
  const SolveReport report = body.solve(Vec3(0, 0, -0.05));  // through the base
  EXPECT_FALSE(report.ok());
  EXPECT_LT(report.reached, 1);
  EXPECT_NE(report.message.find("% of the displacement only"), std::string::npos) << report.message;
  std::printf("%s\n", report.message.c_str());
  // It stands in the last equilibrium and goes on from there.
  EXPECT_TRUE(body.solve(Vec3(0, 0, -0.002)).ok());
  NonlinearBody fresh(model, p.handle);
  ASSERT_TRUE(fresh.solve(Vec3(0, 0, -0.002)).ok());
  EXPECT_LT((fresh.reaction() - body.reaction()).norm(), 1e-6 * fresh.reaction().norm());

  const std::vector<int> loose(p.mesh.nodes.size(), kFreeNode);
  std::vector<int> one = loose;
  one[0] = 0;
  NonlinearBody floating(model, one);
  const SolveReport unstable = floating.solve(Vec3(0, 0, 0.001));
  EXPECT_NE(unstable.status, SolveStatus::kConverged);
}

}  // namespace
}  // namespace hapsim
