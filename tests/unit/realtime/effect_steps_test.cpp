// Every effect of the catalogue sample by sample: as the batch mode has it, going on from a stored
// state, without taking memory. No effect is named.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <memory>

#include "effects/local_contact.h"
#include "experiment/forces.h"
#include "realtime/force_loop.h"
#include "support/allocations.h"
#include "support/every_effect.h"
#include "support/live_against_batch.h"
#include "support/shared_cache.h"

namespace hapsim {
namespace {

const Experiment& experiment(bool straight) {
  static const Experiment straight_one = test::rich_experiment(true);
  static const Experiment bent = test::rich_experiment(false);
  return straight ? straight_one : bent;
}

std::unique_ptr<PreparedBody> prepared(const Model& model) {
  PreparedBodyOptions options;
  options.tool_radius = 0.004;
  options.most_samples = 4;  // no test of the field, nor
  options.rim_edge = 0.5;    // of contact meshes: quick
  options.contacts = [](const MaterialSpec& m) {
    return known_contacts(experiment(true).places, m);
  };
  // Bodies of one material, and there are few, share their field.
  options.cache = test::shared_cache();
  return std::make_unique<PreparedBody>(test::pressed_block(), model, options);
}

// One body of an effect for all tests that ask no more of its sizes than that they are some.
const PreparedBody& body_of(const Effect& effect) {
  static std::map<const Effect*, std::unique_ptr<PreparedBody>> bodies;
  std::unique_ptr<PreparedBody>& body = bodies[&effect];
  if (!body) {
    Random random(12);
    body = prepared(test::model_with(effect, random, 4));
  }
  return *body;
}

Eigen::VectorXd batch(const Model& model, bool straight) {
  return test::batch_forces(model, experiment(straight));
}

double difference(const PreparedBody& body, bool straight, const Eigen::VectorXd& expected) {
  return test::live_difference(body, experiment(straight), expected);
}

class EveryEffectLive : public ::testing::TestWithParam<const Effect*> {};

TEST_P(EveryEffectLive, IsTheBatchModeSampleBySample) {
  const EffectCard& card = GetParam()->card();
  Random random(11);
  const bool dear = card.solved || card.moves_body;  // finite elements for every draw
  double acts = 0;
  for (int draw = 0; draw < (dear ? 1 : 3); ++draw) {
    const Model model = test::model_with(*GetParam(), random, 4);
    const auto body = prepared(model);
    for (const bool straight : {true, false}) {
      if (card.looks_ahead && !straight) continue;
      Model bare;
      bare.parameters = {model.parameters[0], model.parameters[1]};
      const Eigen::VectorXd expected = batch(model, straight);
      EXPECT_LT(difference(*body, straight, card.of_recording ? batch(bare, straight) : expected),
                1e-9)
          << "draw " << draw << straight;
      acts = std::max(acts, (expected - batch(bare, straight)).cwiseAbs().maxCoeff() /
                                expected.cwiseAbs().maxCoeff());
    }
  }
  EXPECT_TRUE(acts > 1e-3 || GetParam() == &body_effect()) << "it does nothing here";
  EXPECT_TRUE(!(card.looks_ahead || card.of_recording) || !card.live.empty());
}

TEST_P(EveryEffectLive, GoesOnFromAStoredState) {
  const PreparedBody& body = body_of(*GetParam());
  const Dataset& dataset = experiment(false).dataset;
  for (const std::size_t at : {110UL, 333UL, 950UL, 1310UL}) {
    ForceLoop whole(body), second(body);
    std::vector<Vec3> forces;
    ForceLoopState stored;
    test::run_live(whole, dataset, 0, [&](std::size_t i, const Vec3& f) {
      forces.push_back(f);
      if (i + 1 == at) stored = whole.state();
    });
    second.restore(stored);
    test::run_live(second, dataset, at,
                   [&](std::size_t i, const Vec3& f) { ASSERT_EQ(f, forces[i]) << i; });
  }
}

// The force at the end of a press into the body and along it, of a place `factor` times as stiff,
// and what the steps say of an error of that.
std::pair<Vec3, double> pressed(const PreparedBody& body, double factor) {
  StepPlace place;
  const double radius = body.tool_radius();
  const DiscStiffness disc = bonded_disc(body.modulus(), 0.4, radius);
  const Eigen::Matrix3d along = Vec3::UnitZ() * Vec3::UnitZ().transpose();
  place.contact.modulus = body.modulus();
  place.contact.nu = 0.4;
  place.contact.K = factor * 0.9 *
                    (disc.normal * along + disc.tangential * (Eigen::Matrix3d::Identity() - along));
  std::vector<std::unique_ptr<EffectStep>> steps;
  std::vector<std::vector<double>> memories;
  for (const EffectInstance& i : body.effects()) {
    if (i.effect->card().stage == Stage::kSensor) continue;
    auto step = i.effect->step(i.values, {radius, body.modulus(), false});
    if (!step) continue;
    step->take_place(place);
    memories.emplace_back(step->memory(), 0.0);
    steps.push_back(std::move(step));
  }
  Vec3 f = Vec3::Zero();
  double share = 1;
  for (int k = 0; k <= 50; ++k) {
    StepSample sample;
    sample.first = k == 0;
    sample.t = 0.01 * k;
    sample.dt = k == 0 ? 0 : 0.01;
    sample.recorded = sample.u = radius * k / 50 * Vec3(0.05, 0.1, -0.8);
    for (std::size_t i = 0; i < steps.size(); ++i) steps[i]->move(sample, memories[i].data());
    f = -place.contact.K * sample.u;
    for (std::size_t i = 0; i < steps.size(); ++i) steps[i]->apply(sample, memories[i].data(), f);
  }
  for (const auto& step : steps) share = std::max(share, step->share_of_stiffness());
  return {f, share};
}

TEST_P(EveryEffectLive, TellsWhatAnErrorOfTheStiffnessIsInTheForce) {
  const EffectCard& card = GetParam()->card();
  const PreparedBody& body = body_of(*GetParam());
  if (body.is_regional()) GTEST_SKIP() << "regions have steps of their own";
  const double by = 1e-5;
  const auto [force, share] = pressed(body, 1);
  const double change = (pressed(body, 1 + by).first - force).norm() / (by * force.norm());
  EXPECT_LT(change, 1.05 * share) << card.name;  // adhesion takes off of the force
  if (share > 1) {
    EXPECT_GT(change, 0.98 * share) << card.name;
  }
}

TEST_P(EveryEffectLive, TakesNoMemoryAndStaysFinite) {
  const PreparedBody& body = body_of(*GetParam());
  for (const bool slides : {false, true}) {
    ToolLoopOptions options;
    options.contact.slides = slides;
    ForceLoop loop(body, options);
    const Vec3 middle(0.04, 0.04, 0.04);
    bool finite = true;
    double largest = 0;
    const long before = test::allocations;
    for (int i = 0; i < 50000; ++i) {
      const double t = 1e-3 * i;
      loop.set_temperature(20 + std::sin(0.1 * t));
      // Over the top, in and out; now and then a sample that is lost, or of nowhere.
      const Vec3 tool = middle + Vec3(0.02 * std::sin(0.9 * t), 0.02 * std::sin(1.3 * t),
                                      0.0005 - 0.003 * std::sin(5 * t));
      const Vec3 f =
          loop.step(t, i % 997 == 0 ? Vec3::Constant(i % 2 == 0 ? 1e155 : std::nan("")) : tool);
      finite = finite && f.allFinite();
      largest = std::max(largest, f.norm());
    }
    EXPECT_EQ(test::allocations - before, 0);
    EXPECT_TRUE(finite);
    EXPECT_GT(largest, 0.1);
  }
}

INSTANTIATE_TEST_SUITE_P(Catalogue, EveryEffectLive, ::testing::ValuesIn(catalogue()),
                         [](const auto& test) {
                           std::string name = test.param->card().name;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

// All at once, so that their order counts: those that no finite elements are solved for.
TEST(EffectSteps, TogetherAreTheBatchMode) {
  for (int draw = 0; draw < 3; ++draw) {
    Random random(20 + draw);
    Model model;
    for (const Effect* effect : catalogue()) {
      const EffectCard& card = effect->card();
      if (card.solved || card.moves_body || card.is_map || card.of_recording) continue;
      for (const Parameter& p : test::model_with(*effect, random, 4).parameters)
        if (p.effect == card.name) model.parameters.push_back(p);
    }
    EXPECT_LT(difference(*prepared(model), true, batch(model, true)), 1e-9) << draw;
  }
}

TEST(EffectSteps, AHandFeelsNoSensor) {
  Random random(4);
  Model model, bare;
  for (const Effect* effect : catalogue()) {
    if (effect->card().stage != Stage::kSensor && effect != &body_effect()) continue;
    for (const Parameter& p : test::model_with(*effect, random, 4).parameters)
      if (p.effect == effect->card().name) model.parameters.push_back(p);
  }
  bare.parameters = {model.parameters[0], model.parameters[1]};
  ToolLoopOptions hand;
  hand.sensor = false;
  const auto body = prepared(model), bare_body = prepared(bare);
  ForceLoop felt(*body, hand), without(*bare_body);
  std::vector<Vec3> forces;
  const Dataset& dataset = experiment(false).dataset;
  test::run_live(without, dataset, 0, [&](std::size_t, const Vec3& f) { forces.push_back(f); });
  test::run_live(felt, dataset, 0, [&](std::size_t i, const Vec3& f) { ASSERT_EQ(f, forces[i]); });
}

}  // namespace
}  // namespace hapsim
