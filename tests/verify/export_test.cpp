// What hs-export writes, solved by CalculiX: the force of the tool is that of hapsim on the same
// mesh.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "effects/catalogue.h"
#include "exchange/match.h"
#include "exchange/scene.h"
#include "simulate/full_simulation.h"
#include "support/block_mesh.h"
#include "support/needs.h"

namespace hapsim {
namespace {

const Vec3 kSize(0.04, 0.05, 0.03), kPoint(0.02, 0.025, 0.03);

class Export : public ::testing::Test {
 protected:
  void SetUp() override { HAPSIM_NEEDS_PROGRAM("ccx"); }

  static void add(Model& model, const std::string& effect, const std::vector<double>& values,
                  int region = 0) {
    for (Parameter p : effect_rows(*find_effect(effect), 1, values)) {
      p.region = region;
      model.parameters.push_back(p);
    }
  }

  // A press of four rows, deeper and sheared, of 5 mm into 30 mm.
  static Recording press() {
    Recording r;
    r.metadata.set("tool_radius", "0.0125");
    for (int i = 0; i <= 4; ++i) {
      r.line.push_back(i + 1);
      r.press.push_back(1);
      r.t.push_back(0.1 * i);
      r.position.push_back(kPoint);
      r.u.emplace_back(0.0003 * i, -0.0001 * i, -0.00125 * i);
    }
    return r;
  }

  // Forces of the body on the tool, step by step, from the .dat file.
  static std::vector<Vec3> calculix(const Scene& scene, const std::string& name) {
    const std::string folder = ::testing::TempDir() + "hapsim_export_" + name + "/";
    std::filesystem::create_directories(folder);
    {
      std::ofstream out(folder + "run.inp");
      write_calculix(out, scene);
    }
    const std::string command =
        "cd '" + folder + "' && OMP_NUM_THREADS=1 ccx -i run > run.log 2>&1";
    EXPECT_EQ(std::system(command.c_str()), 0) << folder;
    std::vector<Vec3> forces;
    std::vector<double> times;
    std::ifstream in(folder + "run.dat");
    for (std::string line; std::getline(in, line);) {
      if (const auto at = line.find("time"); at != line.npos)
        times.push_back(std::atof(&line[at + 4]));
      std::istringstream words(line);
      Vec3 f;
      if (words >> f[0] >> f[1] >> f[2]) forces.push_back(-f);
    }
    // Increments inside a step are printed as well: only those at whole times end one.
    std::vector<Vec3> ends;
    for (std::size_t i = 0; i < std::min(times.size(), forces.size()); ++i)
      if (std::abs(times[i] - std::round(times[i])) < 1e-6) ends.push_back(forces[i]);
    std::filesystem::remove_all(folder);
    return ends;
  }

  static void compare(int order, const Model& model, double tolerance, const std::string& name) {
    const TetMesh mesh = test::block_mesh(kSize, 4, 4, 4, order, 0.15);
    const Recording motion = press();
    const Scene scene = make_scene(mesh, model, motion, motion.presses()[0].rows, {});
    const FullResult mine =
        simulate_full(mesh, model, motion, {.own_mesh = true, .averaged = false});
    const std::vector<Vec3> theirs = calculix(scene, name);
    ASSERT_EQ(theirs.size(), 4U);  // the first row does not move
    double worst = 0;
    for (std::size_t i = 0; i < 4; ++i)
      worst = std::max(worst, (theirs[i] - mine.force[i + 1]).norm() / mine.force[4].norm());
    std::printf("%-28s %.4f N, differs by %.1e\n", name.c_str(), mine.force[4].norm(), worst);
    EXPECT_LT(worst, tolerance);
  }
};

constexpr double kPrinted = 1e-6, kFinite = 1e-5;

TEST_F(Export, ElasticForcesAreTheSame) {
  for (const int order : {1, 2})
    for (const double nu : {0.3, 0.45}) {
      Model model;
      add(model, "elastic", {2e4, nu});
      compare(order, model, kPrinted,
              "elastic_" + std::to_string(order) + "_" + std::to_string(nu));
    }
}

// hapsim's own forces of second order are softer by what averaging the change of volume takes away:
// next to nothing far from nu = 1/2, the more the nearer.
TEST_F(Export, AveragingTheChangeOfVolumeSoftensSecondOrder) {
  const TetMesh mesh = test::block_mesh(kSize, 4, 4, 4, 2, 0.15);
  const Recording motion = press();
  double before = 1;
  for (const double nu : {0.2, 0.4, 0.45, 0.49, 0.499}) {
    Model model;
    add(model, "elastic", {2e4, nu});
    const Scene scene = make_scene(mesh, model, motion, motion.presses()[0].rows, {});
    const double own = simulate_full(mesh, model, motion, {.own_mesh = true}).force[4].norm();
    const std::vector<Vec3> theirs = calculix(scene, "averaged");
    ASSERT_EQ(theirs.size(), 4U);
    const double ratio = theirs[3].norm() / own;
    std::printf("nu %.3f: CalculiX %.4f N is %.1f %% above %.4f N\n", nu, theirs[3].norm(),
                100 * (ratio - 1), own);
    EXPECT_GT(ratio, before);
    before = ratio;
  }
}

TEST_F(Export, ForcesOfRegionsAreTheSame) {
  for (const int order : {1, 2}) {
    Model model;
    add(model, "elastic", {1e4, 0.4});
    Parameter stiff = model.parameters[0];
    stiff.region = 1;
    stiff.value = 6e4;
    model.parameters.push_back(stiff);
    const std::vector<Vec3> centres{{0.01, 0.02, 0}, {0.03, 0.03, 0}};
    for (int k = 0; k < 2; ++k)
      for (const char* axis : {"x1", "y1"}) {
        const Vec3& at = centres[static_cast<std::size_t>(k)];
        model.parameters.push_back({"regions", k, axis, axis[0] == 'x' ? at.x() : at.y(), "m"});
      }
    compare(order, model, kPrinted, "regions_" + std::to_string(order));
  }
}

TEST_F(Export, NeoHookeanForcesAreTheSame) {
  for (const int order : {1, 2}) {
    Model model;
    add(model, "elastic", {16800, 0.4});
    add(model, "hyperelastic", {0, 1});
    compare(order, model, kFinite, "neo-Hookean_" + std::to_string(order));
  }
}

// A coarse body, two regions, presses at four places: the matched deck's force is hapsim's own,
// from meshes with other elements, and CalculiX has the error that the match has told.
TEST_F(Export, MatchedForcesAreHapsimsOwn) {
  const TetMesh coarse = test::block_mesh({0.08, 0.06, 0.04}, 4, 3, 2, 1, 0);
  Model model;
  add(model, "elastic", {1e4, 0.45});
  Recording motion;
  motion.metadata.set("tool_radius", "0.004");
  for (const Vec3& at : {Vec3(0.02, 0.02, 0.04), Vec3(0.06, 0.02, 0.04), Vec3(0.02, 0.045, 0.04),
                         Vec3(0.055, 0.04, 0.04)}) {
    motion.line.push_back(static_cast<long>(motion.line.size()) + 1);
    motion.press.push_back(static_cast<int>(motion.press.size()) + 1);
    motion.position.push_back(at);
    motion.u.emplace_back(0.0005, 0, -0.002);
  }
  for (const bool regions : {false, true}) {
    if (regions) {
      Parameter stiff = model.parameters[0];
      stiff.region = 1;
      stiff.value = 3e4;
      model.parameters.push_back(stiff);
      for (int k = 0; k < 2; ++k) {
        model.parameters.push_back({"regions", k, "x1", k == 0 ? 0.02 : 0.06, "m"});
        model.parameters.push_back({"regions", k, "y1", 0.03, "m"});
      }
    }
    for (const Press& press : {motion.presses().front(), motion.presses().back()}) {
      const auto row = static_cast<std::size_t>(press.rows[0]);
      Scene scene = make_scene(coarse, model, motion, press.rows, {});
      const Match match = match_scene(scene, coarse, model, motion, press, {});
      const GradedPress graded = graded_presses(coarse, model, motion, {press}, {})[0];
      const Vec3 ours = -graded.K * motion.u[row];
      const std::vector<Vec3> theirs = calculix(scene, "matched");
      ASSERT_EQ(theirs.size(), 1U);
      const double error = (theirs[0] - ours).norm() / ours.norm();
      std::printf("press %d: hapsim %.4f N, CalculiX %.2f %% off, said %.2f %%, before %.0f %%\n",
                  press.id, ours.norm(), 100 * error, 100 * match.presses[0].error,
                  100 * match.before);
      EXPECT_FALSE(match.presses[0].learned);
      EXPECT_EQ(match.learned(), 2U);
      EXPECT_GT(std::abs(match.before), 0.05);
      EXPECT_LT(error, 0.02);
      EXPECT_NEAR(error, std::abs(match.presses[0].error), 1e-4);
      EXPECT_LE(error, match.largest_unseen() + 1e-4);
    }
  }
}

}  // namespace
}  // namespace hapsim
