// The loop against the batch mode, and what a loop must keep to: restart, coherence.
#include "realtime/force_loop.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>

#include "base/error.h"
#include "expect_error.h"
#include "experiment/forces.h"
#include "experiment/nearest_region.h"
#include "support/shared_cache.h"
#include "support/synthetic.h"

namespace hapsim {
namespace {

Model viscoelastic_model(int terms) {
  Model model;
  for (const Effect* effect : catalogue()) {
    std::vector<double> values;
    if (effect->card().name == "elastic") {
      values = {2e4, 0.4};
    } else if (effect->card().name == "viscoelastic" && terms > 0) {
      for (int k = 0; k < terms; ++k) {
        values.push_back(8e3 / (k + 1));
        values.push_back(0.07 * std::pow(5.0, k));
      }
    } else {
      continue;
    }
    const auto rows = effect_rows(*effect, effect->card().terms ? terms : 1, values);
    model.parameters.insert(model.parameters.end(), rows.begin(), rows.end());
  }
  return model;
}

TetMesh body_mesh() {
  return test::block_mesh({0.08, 0.08, 0.04}, 6, 6, 4, 1);
}

PreparedBodyOptions tool(double radius = 0.004) {
  PreparedBodyOptions options;
  options.tool_radius = radius;
  options.most_samples = 16;
  options.rim_edge = 0.5;  // no test of it: quick
  options.cache = test::shared_cache();
  return options;
}

TEST(ForceLoop, IsTheBatchModeAtPreparedContacts) {
  const Experiment w = test::experiment();
  for (const int terms : {0, 1, 3}) {
    const Model model = viscoelastic_model(terms);
    PreparedBodyOptions options = tool();
    options.contacts = [&](const MaterialSpec& m) { return known_contacts(w.places, m); };
    const PreparedBody body(body_mesh(), model, options);
    const Selection all = all_episodes(w.dataset);
    const Eigen::VectorXd batch = solved_forces(model, w, all, false).f;
    ForceLoop loop(body);
    Eigen::Index at = 0;
    double largest = 0;
    for (const Episode& episode : w.dataset.episodes) {
      loop.begin(w.dataset.positions[episode.position]);
      for (const int row : episode.rows) {
        const Vec3 f = loop.press(w.dataset.recording.t[row], w.dataset.recording.u[row]);
        largest = std::max(largest, (f - batch.segment<3>(at)).norm());
        at += 3;
      }
    }
    EXPECT_LT(largest, 1e-9 * batch.cwiseAbs().maxCoeff()) << terms << " terms";
  }
}

TEST(ForceLoop, FindsTheContactOfAToolThatComesDown) {
  const Model model = viscoelastic_model(0);
  const PreparedBody body(body_mesh(), model, tool());
  ForceLoop loop(body);
  const Vec3 place(0.031, 0.047, 0.04);
  EXPECT_EQ(loop.step(0, place + Vec3(0, 0, 0.003)).norm(), 0);
  const SurfaceSide side = body.distance().at(place);
  const Eigen::Matrix3d K = body.field().at(side.face, side.point);
  Vec3 f = Vec3::Zero();
  for (int i = 0; i <= 50; ++i) f = loop.step(1e-3 * i, place - Vec3(0, 0, 4e-5 * i));
  EXPECT_LT((f + K * Vec3(0, 0, -0.002)).norm(), 1e-12 * f.norm());
  EXPECT_GT(f.z(), 0);
  EXPECT_EQ(loop.step(0.1, place + Vec3(0, 0, 0.001)).norm(), 0);
}

TEST(ForceLoop, GoesOnFromAStoredState) {
  const Model model = viscoelastic_model(2);
  const PreparedBody body(body_mesh(), model, tool());
  ToolLoopOptions options;
  options.relaxed = false;
  const auto path = [](int i) {
    return Vec3(0.03 + 1e-5 * i, 0.04, 0.0405 - 0.002 * std::sin(0.02 * i));
  };
  ForceLoop whole(body, options);
  ForceLoopState stored;
  std::vector<Vec3> forces;
  for (int i = 0; i < 600; ++i) {
    if (i == 250) stored = whole.state();
    forces.push_back(whole.step(1e-3 * i, path(i)));
  }
  ForceLoop second(body, options);
  second.restore(stored);
  for (int i = 250; i < 600; ++i) EXPECT_EQ(second.step(1e-3 * i, path(i)), forces[i]);
}

TEST(ForceLoop, TheStepSizeDoesNotMatterOnStraightMotion) {
  const Model model = viscoelastic_model(3);
  const PreparedBody body(body_mesh(), model, tool());
  const auto pressed = [&](int steps) {
    ForceLoop loop(body);
    loop.begin({0.03, 0.03, 0.04});
    Vec3 f = Vec3::Zero();
    for (int i = 0; i <= steps; ++i) {
      const double share = static_cast<double>(i) / steps;
      f = loop.press(0.5 * share, share * Vec3(2e-4, 0, -2e-3));
    }
    return f;
  };
  EXPECT_LT((pressed(1) - pressed(1000)).norm(), 1e-12 * pressed(1).norm());
}

// Two halves of the body, each with its own modulus and Maxwell elements.
Model regional_model(const std::vector<double>& E, const std::vector<std::vector<double>>& terms) {
  Model model = viscoelastic_model(0);
  model.find("elastic", 0, "E")->value = E[0];
  const auto add = [&](const char* effect, int region, const std::string& name, double value) {
    Parameter p;
    p.effect = effect;
    p.region = region;
    p.name = name;
    p.value = value;
    model.parameters.push_back(p);
  };
  add("elastic", 1, "E", E[1]);
  for (int r = 0; r < 2; ++r) {
    add("regions", r, "x0", r == 0 ? 0.02 : 0.06);
    add("regions", r, "y0", 0.04);
  }
  for (std::size_t r = 0; r < terms.size(); ++r)
    for (std::size_t k = 0; k + 1 < terms[r].size(); k += 2) {
      add("viscoelastic", static_cast<int>(r), "E" + std::to_string(k / 2 + 1), terms[r][k]);
      add("viscoelastic", static_cast<int>(r), "tau" + std::to_string(k / 2 + 1), terms[r][k + 1]);
    }
  return model;
}

const Vec3 kPressed(0.045, 0.04, 0.04);
constexpr double kBlunt = 0.008;  // a tool whose contact meshes are quick: thirty materials each

// Solved for any material where pressed() presses.
PreparedBodyOptions known_where_pressed() {
  PreparedBodyOptions options = tool(kBlunt);
  ContactLibraryOptions how;
  how.rim_edge = options.rim_edge;
  const auto library =
      std::make_shared<const ContactLibrary>(body_mesh(), options.tool_radius, how);
  options.contacts = [library](const MaterialSpec& m) {
    const Material solid{m.nu, m.modulus, [&m](const Vec3& p) { return region_at(m, p); }, {}};
    const SampledContact c =
        *library->sample({kPressed}, solid, "", ContactLevel::kFine, true).front();
    return std::vector<KnownStiffness>{{c.point, c.normal, c.K}};
  };
  return options;
}

Vec3 pressed(const PreparedBody& body, int steps, double hold) {
  ForceLoop loop(body);
  loop.begin(kPressed);
  loop.press(0, Vec3::Zero());
  Vec3 f = Vec3::Zero();
  for (int i = 1; i <= steps; ++i) {
    const double share = static_cast<double>(i) / steps;
    f = loop.press(0.1 * share, share * Vec3(2e-4, 0, -2e-3));
  }
  return hold > 0 ? loop.press(0.1 + hold, Vec3(2e-4, 0, -2e-3)) : f;
}

TEST(ForceLoop, RegionsThatRelaxApartHaveNoLargeStrain) {
  PreparedBodyOptions options = tool();
  options.large_strain = true;
  const Model model = regional_model({2e4, 1e4}, {{8e3, 0.05}, {4e3, 0.05}});
  EXPECT_NE(error_of([&] { PreparedBody(body_mesh(), model, options); }).find("relax each"),
            std::string::npos);
}

TEST(ForceLoop, RegionsOfTheSameRelaxationAreTheCommonOne) {
  const PreparedBody common(body_mesh(), regional_model({2e4, 1e4}, {{8e3, 0.05, 4e3, 0.5}}),
                            tool(kBlunt));
  const PreparedBody apart(
      body_mesh(), regional_model({2e4, 1e4}, {{8e3, 0.05, 4e3, 0.5}, {4e3, 0.05, 2e3, 0.5}}),
      tool(kBlunt));
  EXPECT_FALSE(common.is_regional());
  EXPECT_TRUE(apart.is_regional());
  EXPECT_LT(apart.misfit(), 1e-9);
  for (const double hold : {0.0, 0.02, 0.3}) {
    const Vec3 f = pressed(common, 10, hold);
    EXPECT_LT((pressed(apart, 10, hold) - f).norm(), 1e-8 * f.norm()) << hold;
  }
}

TEST(ForceLoop, EachRegionRelaxesInItsOwnWay) {
  const PreparedBody body(body_mesh(),
                          regional_model({2e4, 1e4}, {{8e3, 0.05}, {2e4, 0.4, 3e3, 2}}),
                          known_where_pressed());
  // Straight motion in one step or many; both ends of the relaxation are elastic bodies.
  EXPECT_LT((pressed(body, 1, 0) - pressed(body, 500, 0)).norm(),
            1e-10 * pressed(body, 1, 0).norm());
  const PreparedBody relaxed(body_mesh(), regional_model({2e4, 1e4}, {}), known_where_pressed());
  const PreparedBody at_once(body_mesh(), regional_model({2.8e4, 3.3e4}, {}),
                             known_where_pressed());
  const Vec3 slow = pressed(relaxed, 1, 0), fast = pressed(at_once, 1, 0);
  EXPECT_LT((pressed(body, 1, 1e4) - slow).norm(), 1e-9 * slow.norm());
  ForceLoop loop(body);
  loop.begin(kPressed);
  EXPECT_LT((loop.press(0, Vec3(2e-4, 0, -2e-3)) - fast).norm(), 1e-9 * fast.norm());
  EXPECT_LT(pressed(body, 1, 0.1).z(), fast.z());
  EXPECT_GT(pressed(body, 1, 0.1).z(), slow.z());
}

TEST(Batch, RefusesRegionsThatRelaxEachInItsOwnWay) {
  const Experiment w = test::experiment();
  const Model model = regional_model({2e4, 1e4}, {{8e3, 0.05}, {2e4, 0.4}});
  try {
    solved_forces(model, w, all_episodes(w.dataset), false);
    FAIL() << "nothing was thrown";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kBadInput);
    EXPECT_NE(std::string(error.what()).find("hs-simulate"), std::string::npos) << error.what();
  }
}

// Of a model that was fitted to presses of 2 mm at 20 mm/s about the middle of the top.
TEST(ForceLoop, SaysWhatAForceIsBeyond) {
  Metadata metadata;
  metadata.set("depth", "0.002");
  metadata.set("speed", "0.02");
  metadata.set("places", "0.03 0.04 0.04 0.05 0.04 0.04");
  metadata.set("reach", "0.012");
  ToolLoopOptions options;
  options.fitted = fitted_range(metadata, "model");
  const PreparedBody body(body_mesh(), viscoelastic_model(1), tool());
  ForceLoop loop(body, options);
  const Vec3 middle(0.04, 0.04, 0.04);
  double t = 0;
  const auto press = [&](const Vec3& u, double speed, double along = 0) {
    loop.begin(middle + Vec3(along, 0, 0));
    int beyond = 0;
    for (int i = 0; i <= 50; ++i) {
      loop.press(t, 0.02 * i * u);
      beyond |= loop.beyond();
      t += u.norm() / speed / 50;
    }
    return beyond;
  };
  EXPECT_EQ(press({0, 0, -0.002}, 0.02), 0);
  EXPECT_EQ(press({0.0002, 0, -0.0015}, 0.01), 0);
  EXPECT_EQ(press({0, 0, -0.0025}, 0.01), kBeyondDepth);
  EXPECT_EQ(press({0, 0, -0.002}, 0.03), kBeyondSpeed);
  EXPECT_EQ(press({0, 0, -0.002}, 0.01, 0.02), 0);
  EXPECT_EQ(press({0, 0, -0.002}, 0.01, 0.024), kBeyondFitted);
  EXPECT_EQ(press({0.0025, 0, -0.002}, 0.01), kBeyondLaw);
  EXPECT_EQ(press({0, 0, -0.007}, 0.01), kBeyondDepth | kBeyondLaw);
  loop.press(t, {0, 0, 0.001}, true);
  EXPECT_EQ(loop.beyond(), 0);
  // A sensor that scatters by 0.1 mm from one millisecond to the next moves no faster.
  loop.begin(middle);
  for (int i = 0; i < 100; ++i) {
    loop.press(t += 0.001, Vec3(0, 0, -1e-5 * i - 1e-4 * (i % 2)));
    EXPECT_EQ(loop.beyond(), 0) << i;
  }
  // With the law of finite strain ways along the surface hold to a radius.
  Model finite = viscoelastic_model(0);
  for (const Parameter& p : effect_rows(*find_effect("hyperelastic"), 1, {0.1, 1}))
    finite.parameters.push_back(p);
  const PreparedBody stiffening(body_mesh(), finite, tool());
  ForceLoop bent(stiffening);
  bent.begin(middle);
  bent.press(0, {0.0035, 0, -0.002});
  EXPECT_EQ(bent.beyond(), 0);
  bent.press(0.01, {0.0045, 0, -0.002});
  EXPECT_EQ(bent.beyond(), kBeyondLaw);
}

TEST(ForceLoop, SurvivesBadSamples) {
  const Model model = viscoelastic_model(1);
  const PreparedBody body(body_mesh(), model, tool());
  ForceLoop loop(body);
  const double nan = std::nan("");
  loop.step(0, {0.04, 0.04, 0.041});
  const Vec3 f = loop.step(0.01, {0.04, 0.04, 0.039});
  EXPECT_TRUE(loop.step(0.02, {nan, 0.04, 0.039}).allFinite());
  EXPECT_TRUE(loop.step(nan, {0.04, 0.04, 0.039}).allFinite());
  EXPECT_TRUE(loop.step(0.001, {0.04, 0.04, 0.039}).allFinite());  // backwards
  EXPECT_TRUE(loop.step(0.03, {0.04, 0.04, 0.039}).allFinite());
  EXPECT_GT(f.z(), 0);
}

TEST(PreparedBody, RefusesAMoveThatNoContactKnowsOf) {
  Model model = viscoelastic_model(0);
  const auto rows = effect_rows(*find_effect("shift"), 1, {1e-3, 0, 0, 0, 0, 0});
  model.parameters.insert(model.parameters.end(), rows.begin(), rows.end());
  try {
    PreparedBody body(body_mesh(), model, tool());
    FAIL() << "nothing was thrown";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kBadInput);
    EXPECT_NE(std::string(error.what()).find("--contacts"), std::string::npos) << error.what();
  }
}

TEST(PreparedBody, TakesFromTheCacheWhatItWouldMake) {
  PreparedBodyOptions options = tool();
  options.cache = ::testing::TempDir() + "/hapsim-prepared-" + std::to_string(::getpid());
  const Model model = viscoelastic_model(0);
  const PreparedBody made(body_mesh(), model, options);
  int samples = 0;
  options.progress = [&](std::size_t) -> std::function<void()> { return [&] { ++samples; }; };
  const PreparedBody found(body_mesh(), model, options);
  EXPECT_EQ(samples, 0);
  EXPECT_EQ(found.field().bytes(), made.field().bytes());
  std::filesystem::remove_all(options.cache);
}

}  // namespace
}  // namespace hapsim
