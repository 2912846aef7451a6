// The loop with a thread beside it: right forces, failure of the thread, no race (thread
// sanitizer).
#include "fusion/fused_loop.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <thread>
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

// What both threads have done: each waits for the other, so that no result hangs on how fast the
// machine is.
struct Course {
  std::atomic<int> samples{0}, steps{0};
  std::atomic<bool> over{false};  // nobody waits any longer
  template <class Condition>
  void wait(const Condition& condition) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (!condition() && !over && std::chrono::steady_clock::now() < end)
      std::this_thread::sleep_for(std::chrono::microseconds(50));
  }
  void wait_for_samples(int count) {
    wait([&] { return samples >= count; });
  }
  // One more sample; there is a step for so many.
  void sampled(int every) {
    const int due = ++samples / every;
    wait([&] { return steps >= due; });
  }
};

// The truth is a quarter stiffer.
class Stiffer : public SlowPress {
 public:
  explicit Stiffer(Course& course) : course_(course) {}
  Vec3 step(const Vec3& u, double) override {
    if (u.z() < -0.0099) {
      course_.over = true;
      fail_numerics("press", "too deep", "press less");
    }
    ++course_.steps;
    return -500 * u;
  }

 private:
  Course& course_;
};

Vec3 run(FusedLoop& loop, Course& course, double deepest, int samples) {
  Vec3 f = Vec3::Zero();
  loop.begin(Vec3::Zero());
  for (int i = 0; i <= samples; ++i) {
    f = loop.press(1e-3 * i, {0, 0, -deepest * i / samples});
    course.sampled(3);
  }
  return f;
}

TEST(FusedLoop, IsPutRightByItsThread) {
  const Acfm model = springs();
  AcfmLoop fast(model);
  Course course;
  FusedLoop loop(fast, [&](const Vec3&) { return std::make_unique<Stiffer>(course); }, {});
  for (int press = 0; press < 3; ++press) run(loop, course, 0.005, 300);
  const double f = run(loop, course, 0.005, 300).z();
  loop.stop();
  EXPECT_EQ(loop.failure(), "");
  EXPECT_GT(loop.report().observations, 20);
  EXPECT_GT(loop.slow_steps().count(), loop.report().observations);
  EXPECT_NEAR(f, 2.5, 0.1);  // the fast source alone says 2
}

// A solver that is long in being made, and notes what it is first asked.
class Noting : public SlowPress {
 public:
  Noting(std::vector<double>& asked, Course& course) : asked_(asked), course_(course) {
    course_.wait_for_samples(40);
  }
  Vec3 step(const Vec3& u, double dt) override {
    asked_.insert(asked_.end(), {u.z(), dt});
    ++course_.steps;
    return -500 * u;
  }

 private:
  std::vector<double>& asked_;
  Course& course_;
};

TEST(FusedLoop, ItsSolverBeginsWhereTheContactDid) {
  const Acfm model = springs();
  AcfmLoop fast(model);
  std::vector<double> asked;
  Course course;
  FusedLoop loop(fast, [&](const Vec3&) { return std::make_unique<Noting>(asked, course); }, {});
  loop.begin(Vec3::Zero());
  for (int i = 0; i <= 200; ++i, ++course.samples) loop.press(1e-3 * i, {0, 0, -0.005 * i / 200});
  course.wait([&] { return course.steps >= 2; });
  loop.stop();
  ASSERT_GE(asked.size(), 4u);
  EXPECT_EQ(asked[0], 0);
  EXPECT_EQ(asked[1], 0);
  // Then its own way in its own time: 25 mm/s.
  EXPECT_LT(asked[2], 0);
  EXPECT_NEAR(asked[2], -0.025 * asked[3], 1e-12);
}

// The analytical model itself as a solver of seldom steps, one in 25 samples.
constexpr int kSeldom = 25;
class Seldom : public SlowPress {
 public:
  Seldom(const Acfm& model, Course& course) : loop_(model), course_(course) {
    loop_.begin(Vec3::Zero());
  }
  Vec3 step(const Vec3& u, double dt) override {
    course_.wait_for_samples((course_.steps + 1) * kSeldom);
    ++course_.steps;
    t_ += dt;
    return loop_.press(t_, u);
  }

 private:
  AcfmLoop loop_;
  Course& course_;
  double t_ = 0;
};

// Presses of a model that relaxes, all but still for a while and then down: the largest difference
// between the fused and the fast force.
double off(const Acfm& model, ToolLoop* coarse) {
  AcfmLoop fast(model), alone(model);
  Course course;
  FusedLoop loop(
      fast, [&](const Vec3&) { return std::make_unique<Seldom>(model, course); }, {}, nullptr, {},
      coarse);
  double most = 0;
  for (int press = 0; press < 2; ++press) {
    loop.begin(Vec3::Zero());
    alone.begin(Vec3::Zero());
    for (int i = 0; i <= 200; ++i) {
      const Vec3 u(0, 0, -0.005 * std::pow(i / 200.0, 6));
      most = std::max(most, (loop.press(1e-3 * i, u) - alone.press(1e-3 * i, u)).norm());
      course.sampled(kSeldom);
    }
  }
  course.over = true;
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
  Course course;
  FusedLoop loop(fast, [&](const Vec3&) { return std::make_unique<Stiffer>(course); }, {});
  const double f = run(loop, course, 0.0115, 200).z();
  loop.stop();
  EXPECT_NE(loop.failure().find("too deep"), std::string::npos);
  EXPECT_GT(f, 4);
}

}  // namespace
}  // namespace hapsim
