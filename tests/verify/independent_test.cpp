// Recordings computed with an established finite-element package, on other meshes than ours.
#include <gtest/gtest.h>

#include "diagnose/diagnose.h"
#include "formats/surface_io.h"
#include "support/needs.h"
#include "tetmesh/body_mesh.h"

namespace hapsim {
namespace {

std::string shared_folder() {
  return test::shared_path("independent/");
}

class Independent : public ::testing::Test {
 protected:
  void SetUp() override { HAPSIM_NEEDS_SHARED(shared_folder()); }
  struct Case {
    Experiment experiment;
    Fit elastic;
  };
  static Case load(const std::string& recording, const std::string& body) {
    Input surface(shared_folder() + body + ".stl");
    const TetMesh mesh = make_body_mesh(read_surface(surface), {}, body);
    Input data(shared_folder() + recording + ".csv");
    ExperimentOptions options;
    options.cache = ::testing::TempDir() + "hapsim_independent_cache";
    options.draft = true;  // as hs-diagnose
    Case c{make_experiment(mesh, read_recording(data), options), {}};
    const Selection all = all_episodes(c.experiment.dataset);
    c.elastic = fit(elastic_model(c.experiment, all), c.experiment, all,
                    {c.experiment.noise.value, c.experiment.floor, true});
    const Model& m = c.elastic.model;
    std::printf("%s: elastic E %.0f Pa, nu %.3f, rmse %.2f x noise\n", recording.c_str(),
                m.find("elastic", 0, "E")->value, m.find("elastic", 0, "nu")->value,
                c.elastic.error.told() / c.experiment.noise.value);
    return c;
  }
  static Diagnosis diagnosed(Case& c) {
    const Diagnosis d = diagnose(c.elastic.model, c.experiment, c.experiment.allowance(), {});
    std::printf("%s: %s\n", verdict_name(d.verdict).c_str(), d.explanation.c_str());
    return d;
  }
};

TEST_F(Independent, NothingHiddenNothingFound) {
  Case c = load("null", "cuboid");
  EXPECT_NEAR(c.elastic.model.find("elastic", 0, "E")->value, 20000, 0.03 * 20000);
  EXPECT_NEAR(c.elastic.model.find("elastic", 0, "nu")->value, 0.4, 0.03);
  EXPECT_LT(c.elastic.error.told(), 1.05 * c.experiment.noise.value);
  EXPECT_EQ(diagnosed(c).verdict, ModelVerdict::kComplete);
}

TEST_F(Independent, RelaxationIsNamedAndExplainsAll) {
  Case c = load("viscoelastic", "ball");
  const Diagnosis d = diagnosed(c);
  EXPECT_EQ(d.verdict, ModelVerdict::kIncomplete);
  EXPECT_EQ(d.findings.front().effect, "viscoelastic");
  EXPECT_EQ(d.findings.front().verdict, Verdict::kMissing);
  EXPECT_LT(d.rmse_end.told(), 1.1 * d.noise);
  EXPECT_LT(d.held_out_end.told(), 1.1 * d.noise);
}

TEST_F(Independent, RegionsAreNamed) {
  Case c = load("regions", "cuboid");
  const Diagnosis d = diagnosed(c);
  EXPECT_EQ(d.findings.front().effect, "regions");
  EXPECT_EQ(d.findings.front().verdict, Verdict::kMissing);
  // truth.json; the boundary, which is not straight, is found with the moduli.
  const Model& found = d.rivals.front();
  ASSERT_NE(found.find("elastic", 1, "E"), nullptr);
  const double soft = found.find("elastic", 0, "E")->value;
  const double stiff = found.find("elastic", 1, "E")->value;
  const double nu = found.find("elastic", 0, "nu")->value;
  std::printf("regions: E %.0f and %.0f Pa (14000 and 35000), nu %.3f (0.4), %.2f x noise\n", soft,
              stiff, nu, d.rmse_end.told() / d.noise);
  EXPECT_NEAR(soft / 14000, 1, 0.03);
  EXPECT_NEAR(stiff / 35000, 1, 0.03);
  EXPECT_NEAR(nu, 0.4, 0.03);
  EXPECT_LT(d.rmse_end.told(), 1.3 * d.noise);
}

TEST_F(Independent, StiffeningIsNamed) {
  Case c = load("hyperelastic", "blob");
  const Diagnosis d = diagnosed(c);
  EXPECT_EQ(d.findings.front().effect, "hyperelastic");
  // Nothing else is hidden in these data.
  for (const Finding& f : d.findings)
    if (f.effect != "hyperelastic") {
      EXPECT_NE(f.verdict, Verdict::kMissing) << f.effect;
    }
  EXPECT_LT(d.findings.front().rmse_after.told(), 1.2 * d.noise);
  EXPECT_LT(d.findings.front().held_out_after.told(), 1.2 * d.noise);
}

TEST_F(Independent, DriftIsNamedWithItsSize) {
  Case c = load("bias_drift", "ball");
  const Diagnosis d = diagnosed(c);
  EXPECT_EQ(d.findings.front().effect, "sensor-drift");
  EXPECT_LT(d.rmse_end.told(), 1.1 * d.noise);
}

}  // namespace
}  // namespace hapsim
