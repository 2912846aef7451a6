// The loop with a thread beside it: right forces, failure of the thread, no race (thread
// sanitizer).
#include "fusion/fused_loop.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <vector>

#include "base/error.h"

namespace hapsim {
namespace {

Acfm springs() {
  Acfm model;
  model.positions.resize(1);
  for (AcfmAxis& axis : model.positions[0].axis) axis.value[0] = 400;
  return model;
}

// The truth is a quarter stiffer; it takes a few milliseconds.
class Stiffer : public SlowPress {
 public:
  Vec3 step(const Vec3& u, double) override {
    std::this_thread::sleep_for(std::chrono::milliseconds(3));
    if (u.z() < -0.0099) fail_numerics("press", "too deep", "press less");
    return -500 * u;
  }
};

Vec3 run(FusedLoop& loop, double deepest, int samples) {
  Vec3 f = Vec3::Zero();
  loop.begin(Vec3::Zero());
  for (int i = 0; i <= samples; ++i) {
    f = loop.press(1e-3 * i, {0, 0, -deepest * i / samples});
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return f;
}

TEST(FusedLoop, IsPutRightByItsThread) {
  const Acfm model = springs();
  AcfmLoop fast(model);
  FusedLoop loop(fast, [](const Vec3&) { return std::make_unique<Stiffer>(); }, {});
  for (int press = 0; press < 3; ++press) run(loop, 0.005, 300);
  const double f = run(loop, 0.005, 300).z();
  loop.stop();
  EXPECT_EQ(loop.failure(), "");
  EXPECT_GT(loop.report().observations, 20);
  EXPECT_GT(loop.slow_steps().count(), loop.report().observations);
  EXPECT_NEAR(f, 2.5, 0.1);  // the fast source alone says 2
}

// A solver that is long in being made, and notes what it is first asked.
class Noting : public SlowPress {
 public:
  explicit Noting(std::vector<double>& asked) : asked_(asked) {
    std::this_thread::sleep_for(std::chrono::milliseconds(40));
  }
  Vec3 step(const Vec3& u, double dt) override {
    asked_.insert(asked_.end(), {u.z(), dt});
    return -500 * u;
  }

 private:
  std::vector<double>& asked_;
};

TEST(FusedLoop, ItsSolverBeginsWhereTheContactDid) {
  const Acfm model = springs();
  AcfmLoop fast(model);
  std::vector<double> asked;
  FusedLoop loop(fast, [&](const Vec3&) { return std::make_unique<Noting>(asked); }, {});
  run(loop, 0.005, 200);
  loop.stop();
  ASSERT_GE(asked.size(), 4u);
  EXPECT_EQ(asked[0], 0);
  EXPECT_EQ(asked[1], 0);
  // Then its own way in its own time: 25 mm/s.
  EXPECT_LT(asked[2], 0);
  EXPECT_NEAR(asked[2], -0.025 * asked[3], 1e-12);
}

// The analytical model itself as a solver of seldom steps.
class Seldom : public SlowPress {
 public:
  explicit Seldom(const Acfm& model) : loop_(model) { loop_.begin(Vec3::Zero()); }
  Vec3 step(const Vec3& u, double dt) override {
    std::this_thread::sleep_for(std::chrono::milliseconds(25));
    t_ += dt;
    return loop_.press(t_, u);
  }

 private:
  AcfmLoop loop_;
  double t_ = 0;
};

// Presses of a model that relaxes, all but still for a while and then down: the largest difference
// between the fused and the fast force.
double off(const Acfm& model, ToolLoop* coarse) {
  AcfmLoop fast(model), alone(model);
  FusedLoop loop(
      fast, [&](const Vec3&) { return std::make_unique<Seldom>(model); }, {}, nullptr, {}, coarse);
  double most = 0;
  for (int press = 0; press < 2; ++press) {
    loop.begin(Vec3::Zero());
    alone.begin(Vec3::Zero());
    for (int i = 0; i <= 200; ++i) {
      const Vec3 u(0, 0, -0.005 * std::pow(i / 200.0, 6));
      most = std::max(most, (loop.press(1e-3 * i, u) - alone.press(1e-3 * i, u)).norm());
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }
  loop.stop();
  return most;
}

TEST(FusedLoop, TakesOffWhatSeldomStepsMakeOfABodyThatRelaxes) {
  Acfm model;
  model.terms = 1;
  model.positions.resize(1);
  for (AcfmAxis& axis : model.positions[0].axis) axis.value = {400, 400, 0.02};
  AcfmLoop coarse(model);
  EXPECT_LT(off(model, &coarse), 1e-9);
  EXPECT_GT(off(model, nullptr), 1e-4);
}

TEST(FusedLoop, GoesOnWhenItsThreadFails) {
  const Acfm model = springs();
  AcfmLoop fast(model);
  FusedLoop loop(fast, [](const Vec3&) { return std::make_unique<Stiffer>(); }, {});
  const double f = run(loop, 0.0115, 200).z();
  loop.stop();
  EXPECT_NE(loop.failure().find("too deep"), std::string::npos);
  EXPECT_GT(f, 4);
}

}  // namespace
}  // namespace hapsim
