// The same mesh, supports, material and displacements in CalculiX 2.20 (Dhondt, The Finite Element
// Method for Three-Dimensional Thermomechanical Applications, 2004): reaction forces node by node.
// CalculiX prints seven digits, which bounds the comparison at small strain; at finite strain its
// Newton iteration stops at a relative residual.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>

#include "effects/catalogue.h"
#include "material/hooke_law.h"
#include "material/hyperelastic_law.h"
#include "material/ogden_law.h"
#include "nonlinear/nonlinear_body.h"
#include "simulate/full_simulation.h"
#include "solid/elastic_body.h"
#include "support/block_mesh.h"
#include "support/needs.h"

namespace hapsim {
namespace {

using Eigen::VectorXd;

constexpr double kDepth = 0.004;
// Seven printed digits of the largest reaction; at finite strain the step of one more Newton
// iteration comes on top.
constexpr double kPrinted = 1e-6, kFinite = 5e-6;
const Vec3 kSize(0.04, 0.05, 0.03);

TetMesh block(int order, int n) {
  return test::block_mesh(kSize, n, n, n, order, 0.15);
}

bool in_patch(const Vec3& p) {
  return p.z() > kSize.z() - 1e-9 && (p - Vec3(0.02, 0.025, kSize.z())).norm() < 0.013;
}

Vec3 press(const Vec3& p) {  // a sheared, unevenly deep press
  return kDepth * Vec3(0.2, -0.1, -1 - 5 * (p.x() - 0.02));
}

class CalculiX : public ::testing::Test {
 protected:
  void SetUp() override { HAPSIM_NEEDS_PROGRAM("ccx"); }

  static VectorXd reactions(const TetMesh& mesh, const std::string& material, bool finite,
                            const std::string& name,
                            const std::function<bool(const Vec3&)>& moved = in_patch,
                            const std::function<Vec3(const Vec3&)>& way = press) {
    const std::string folder = ::testing::TempDir() + "hapsim_ccx_" + name + "/";
    std::filesystem::create_directories(folder);
    std::ofstream out(folder + "run.inp");
    char line[200];
    out << "*NODE, NSET=NALL\n";
    for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
      const Vec3& p = mesh.nodes[n];
      std::snprintf(line, sizeof line, "%zu,%.12e,%.12e,%.12e\n", n + 1, p.x(), p.y(), p.z());
      out << line;
    }
    const int nodes = mesh.order == 1 ? 4 : 10;
    out << "*ELEMENT, ELSET=EALL, TYPE=" << (mesh.order == 1 ? "C3D4" : "C3D10") << "\n";
    for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
      out << t + 1;
      for (int a = 0; a < nodes; ++a) out << "," << mesh.tets[t][a] + 1;
      out << "\n";
    }
    out << "*MATERIAL, NAME=M\n"
        << material << "\n*SOLID SECTION, ELSET=EALL, MATERIAL=M\n"
        << (finite ? "*STEP, NLGEOM, INC=100\n*STATIC, DIRECT\n.25,1.\n" : "*STEP\n*STATIC\n");
    if (finite) out << "*CONTROLS, PARAMETERS=FIELD\n1.e-9,1.e-8,,,1.e-9,1.e-5,1.e-3,1.e-8\n";
    out << "*BOUNDARY\n";
    for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
      if (!mesh.fixed[n] && !moved(mesh.nodes[n])) continue;
      const Vec3 u = mesh.fixed[n] ? Vec3(Vec3::Zero()) : way(mesh.nodes[n]);
      for (int c = 0; c < 3; ++c) {
        std::snprintf(line, sizeof line, "%zu,%d,%d,%.12e\n", n + 1, c + 1, c + 1, u[c]);
        out << line;
      }
    }
    out << "*NODE PRINT, NSET=NALL\nRF\n*END STEP\n";
    out.close();
    const std::string command =
        "cd '" + folder + "' && OMP_NUM_THREADS=1 ccx -i run > run.log 2>&1";
    EXPECT_EQ(std::system(command.c_str()), 0) << folder;

    // The last table of the .dat: node, rf_x, rf_y, rf_z.
    VectorXd forces = VectorXd::Zero(3 * static_cast<Eigen::Index>(mesh.nodes.size()));
    std::ifstream in(folder + "run.dat");
    std::string text;
    int rows = 0;
    while (std::getline(in, text)) {
      if (text.find("time") != std::string::npos) rows = 0;
      std::istringstream words(text);
      std::size_t n = 0;
      Vec3 f;
      if (!(words >> n >> f[0] >> f[1] >> f[2])) continue;
      forces.segment<3>(3 * static_cast<Eigen::Index>(n - 1)) = f;
      ++rows;
    }
    EXPECT_EQ(rows, static_cast<int>(mesh.nodes.size())) << folder;
    std::filesystem::remove_all(folder);
    return forces;
  }

  static VectorXd ours(const TetMesh& mesh, const LawPointer& law) {
    std::vector<int> handle(mesh.nodes.size(), kFreeNode);
    int handles = 0;
    for (std::size_t n = 0; n < handle.size(); ++n) {
      if (in_patch(mesh.nodes[n])) handle[n] = handles++;
      if (mesh.fixed[n]) handle[n] = kHeldNode;
    }
    VectorXd prescribed(3 * handles);
    for (std::size_t n = 0; n < handle.size(); ++n)
      if (handle[n] >= 0) prescribed.segment<3>(3 * handle[n]) = press(mesh.nodes[n]);
    NonlinearBody body(BodyModel{&mesh, {law}}, handle);
    const SolveReport report = body.solve(prescribed, {1e-11});
    EXPECT_TRUE(report.ok()) << report.message;
    return body.nodal_forces();
  }

  static void compare(const TetMesh& mesh, const LawPointer& law, const std::string& material,
                      bool finite, double tolerance, const std::string& name) {
    const VectorXd theirs = reactions(mesh, material, finite, name), mine = ours(mesh, law);
    double worst = 0, largest = 0;
    Vec3 total_mine = Vec3::Zero(), total_theirs = Vec3::Zero();
    for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
      const auto at = 3 * static_cast<Eigen::Index>(n);
      if (!mesh.fixed[n] && !in_patch(mesh.nodes[n])) continue;
      worst = std::max(worst, (mine.segment<3>(at) - theirs.segment<3>(at)).norm());
      largest = std::max(largest, mine.segment<3>(at).norm());
      if (in_patch(mesh.nodes[n])) {
        total_mine += mine.segment<3>(at);
        total_theirs += theirs.segment<3>(at);
      }
    }
    const double resultant = (total_mine - total_theirs).norm() / total_mine.norm();
    std::printf("%-24s resultant differs by %.1e, worst nodal reaction by %.1e of the largest\n",
                name.c_str(), resultant, worst / largest);
    EXPECT_LT(worst / largest, tolerance) << name;
    EXPECT_LT(resultant, tolerance) << name;
  }
};

TEST_F(CalculiX, LinearReactionsAreTheSame) {
  for (const int order : {1, 2})
    for (const double nu : {0.3, 0.45})
      compare(block(order, 3), isotropic_law(2e4, nu), "*ELASTIC\n20000.," + std::to_string(nu),
              false, kPrinted,
              "linear C3D" + std::to_string(order == 1 ? 4 : 10) + " nu " +
                  std::to_string(nu).substr(0, 4));
}

// C10 (I1bar - 3) + (J - 1)^2 / D1: mu = 2 C10, K = 2/D1.
TEST_F(CalculiX, NeoHookeanReactionsAreTheSame) {
  for (const int order : {1, 2})
    for (const double bulk : {2e4, 1e5})
      compare(block(order, 3), neo_hookean_law(6e3, bulk),
              "*HYPERELASTIC, NEO HOOKE\n3000.," + std::to_string(2 / bulk), true, kFinite,
              "neo-Hooke C3D" + std::to_string(order == 1 ? 4 : 10) + " K " +
                  std::to_string(static_cast<int>(bulk)));
}

TEST_F(CalculiX, YeohReactionsAreTheSame) {
  for (const int order : {1, 2})
    compare(block(order, 3), yeoh_law(3000, 900, 400, 5e4),
            "*HYPERELASTIC, YEOH\n3000.,900.,400.,4.e-5,1.e20,1.e20", true, kFinite,
            "Yeoh C3D" + std::to_string(order == 1 ? 4 : 10));
}

TEST_F(CalculiX, OgdenReactionsAreTheSame) {
  for (const int order : {1, 2})
    compare(block(order, 3), ogden_law({{4000, 1.3}, {2000, -2.5}}, 5e4),
            "*HYPERELASTIC, OGDEN, N=2\n4000.,1.3,2000.,-2.5,4.e-5,1.e20", true, kFinite,
            "Ogden C3D" + std::to_string(order == 1 ? 4 : 10));
}

// The whole way of hs-simulate --full: bonded flat tools on the body's own mesh, pressed and
// sheared to finite strain, one alone and two at once.
class CalculiXFull : public CalculiX {
 protected:
  struct Tool {
    Vec3 at, u;
  };
  static constexpr double kTool = 0.0085;
  static bool under(const Vec3& p, const Tool& tool) {
    return p.z() > kSize.z() - 1e-9 && (p - tool.at).norm() <= kTool * (1 + 1e-6);
  }
  // mu = 6000, K = 28000.
  static void compare_tools(int order, const std::vector<Tool>& tools) {
    const TetMesh mesh = block(order, 6);
    Model model;
    for (const auto& [effect, values] : std::vector<std::pair<std::string, std::vector<double>>>{
             {"elastic", {16800, 0.4}}, {"hyperelastic", {0, 1}}})
      for (const Parameter& p : effect_rows(*find_effect(effect), 1, values))
        model.parameters.push_back(p);
    Recording r;
    r.metadata.set("tool_radius", std::to_string(kTool));
    r.extra_header = {"tool_id"};
    r.extra.resize(1);
    for (const double share : {0.5, 1.0})
      for (std::size_t k = 0; k < tools.size(); ++k) {
        r.line.push_back(1);
        r.press.push_back(1);
        r.position.push_back(tools[k].at);
        r.u.push_back(share * tools[k].u);
        r.extra[0].push_back(std::to_string(k));
      }
    const FullOptions options{.own_mesh = true, .averaged = false};
    const std::vector<Vec3> mine = simulate_full(mesh, model, r, options).force;
    const auto tool_of = [&](const Vec3& p) {
      return std::find_if(tools.begin(), tools.end(), [&](const Tool& t) { return under(p, t); });
    };
    const VectorXd theirs = reactions(
        mesh, "*HYPERELASTIC, NEO HOOKE\n3000.,7.142857142857e-5", true, "full",
        [&](const Vec3& p) { return tool_of(p) != tools.end(); },
        [&](const Vec3& p) { return tool_of(p)->u; });
    for (std::size_t k = 0; k < tools.size(); ++k) {
      Vec3 force = Vec3::Zero();
      for (std::size_t n = 0; n < mesh.nodes.size(); ++n)
        if (under(mesh.nodes[n], tools[k]))
          force -= theirs.segment<3>(3 * static_cast<Eigen::Index>(n));
      const double off = (mine[mine.size() - tools.size() + k] - force).norm() / force.norm();
      std::printf("full simulation C3D%d, tool %zu of %zu: force differs by %.1e\n",
                  order == 1 ? 4 : 10, k + 1, tools.size(), off);
      EXPECT_LT(off, kFinite);
    }
  }
};

TEST_F(CalculiXFull, OneToolsForceIsTheSame) {
  for (const int order : {1, 2})
    compare_tools(order, {{{0.02, 0.025, 0.03}, {0.001, -0.0005, -0.004}}});
}

TEST_F(CalculiXFull, TwoToolsForcesAreTheSame) {
  for (const int order : {1, 2})
    compare_tools(order, {{{0.01, 0.0125, 0.03}, {0.001, -0.0005, -0.003}},
                          {{0.03, 0.0375, 0.03}, {-0.0005, 0.001, -0.002}}});
}

// Engineering constants E1, E2, E3, nu12, nu13, nu23, G12, G13, G23; axis z: nu13 = nua Ep/Ea.
TEST_F(CalculiX, TransverseReactionsAreTheSame) {
  for (const int order : {1, 2})
    compare(block(order, 3), transverse_law({1e4, 4e4, 0.4, 0.3, 6e3}, {0, 0, 1}),
            "*ELASTIC, TYPE=ENGINEERING CONSTANTS\n1.e4,1.e4,4.e4,.4,.075,.075,"
            "3571.4285714286,6000.\n6000.,293.",
            false, kPrinted, "transverse C3D" + std::to_string(order == 1 ? 4 : 10));
}

}  // namespace
}  // namespace hapsim
