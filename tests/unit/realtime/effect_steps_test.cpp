// Every effect of the catalogue sample by sample: as the batch mode has it, going on from a stored
// state, without taking memory. No effect is named.
#include <gtest/gtest.h>

#include <algorithm>

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
  options.most_samples = 16;
  options.rim_edge = 0.5;  // no test of it: quick
  options.contacts = [](const MaterialSpec& m) {
    return known_contacts(experiment(true).places, m);
  };
  // Bodies of one material, and there are few, share their field.
  options.cache = test::shared_cache();
  return std::make_unique<PreparedBody>(test::pressed_block(), model, options);
}

Eigen::VectorXd batch(const Model& model, bool straight) {
  return test::batch_forces(model, experiment(straight));
}

double difference(const Model& model, bool straight, const Eigen::VectorXd& expected) {
  return test::live_difference(*prepared(model), experiment(straight), expected);
}

class EveryEffectLive : public ::testing::TestWithParam<const Effect*> {};

TEST_P(EveryEffectLive, IsTheBatchModeSampleBySample) {
  const EffectCard& card = GetParam()->card();
  Random random(11);
  const bool dear = card.solved || card.moves_body;  // finite elements for every draw
  double acts = 0;
  for (int draw = 0; draw < (dear ? 1 : 4); ++draw) {
    const Model model = test::model_with(*GetParam(), random, 4);
    for (const bool straight : {true, false}) {
      if (card.looks_ahead && !straight) continue;
      Model bare;
      bare.parameters = {model.parameters[0], model.parameters[1]};
      const Eigen::VectorXd expected = batch(model, straight);
      EXPECT_LT(difference(model, straight, card.of_recording ? batch(bare, straight) : expected),
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
  Random random(12);
  const auto body = prepared(test::model_with(*GetParam(), random, 4));
  const Dataset& dataset = experiment(false).dataset;
  for (const std::size_t at : {110UL, 333UL, 950UL, 1310UL}) {
    ForceLoop whole(*body), second(*body);
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

TEST_P(EveryEffectLive, TakesNoMemoryAndStaysFinite) {
  Random random(13);
  const auto body = prepared(test::model_with(*GetParam(), random, 4));
  for (const bool slides : {false, true}) {
    ToolLoopOptions options;
    options.contact.slides = slides;
    ForceLoop loop(*body, options);
    const Vec3 middle(0.04, 0.04, 0.04);
    bool finite = true;
    double largest = 0;
    const long before = test::allocations;
    for (int i = 0; i < 50000; ++i) {
      const double t = 1e-3 * i;
      loop.set_temperature(20 + std::sin(0.1 * t));
      // Over the top, in and out; now and then a sample that is lost.
      const Vec3 tool = middle + Vec3(0.02 * std::sin(0.9 * t), 0.02 * std::sin(1.3 * t),
                                      0.0005 - 0.003 * std::sin(5 * t));
      const Vec3 f = loop.step(t, i % 997 == 0 ? Vec3::Constant(std::nan("")) : tool);
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
  for (int draw = 0; draw < 5; ++draw) {
    Random random(20 + draw);
    Model model;
    for (const Effect* effect : catalogue()) {
      const EffectCard& card = effect->card();
      if (card.solved || card.moves_body || card.is_map || card.of_recording) continue;
      for (const Parameter& p : test::model_with(*effect, random, 4).parameters)
        if (p.effect == card.name) model.parameters.push_back(p);
    }
    EXPECT_LT(difference(model, true, batch(model, true)), 1e-9) << draw;
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
