// What a fast source misses by law is learned from some presses and foretells others.
#include "fusion/taught_correction.h"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "base/random.h"
#include "fusion/fuse_recordings.h"
#include "fusion/fusion_file.h"

namespace hapsim {
namespace {

constexpr double kNoise = 1e-3;

// A press of sin^2 shape with a hold; the slow source has a law that the fast one has not: a
// product of depth and way, and a memory.
LessonPress lesson(double rise, double depth, double law, Random& random) {
  LessonPress press;
  press.contact = {0.01, 0, 0.05};
  double memory = 0, last = 0;
  for (int i = 0; i * 1e-3 < 2.5 * rise; ++i) {
    const double t = 1e-3 * i;
    const double s = t < rise         ? std::pow(std::sin(1.5708 * t / rise), 2)
                     : t < 1.5 * rise ? 1
                                      : std::pow(std::sin(1.5708 * (2.5 * rise - t) / rise), 2);
    const Vec3 u(0.2 * depth * s * std::sin(3 * t), 0, -depth * s);
    memory = std::exp(-1e-3 / 0.3) * memory + (depth * s - last);
    last = depth * s;
    press.t.push_back(t);
    press.u.push_back(u);
    press.fast.emplace_back(-300 * u.x(), 0, 400 * depth * s);
    if (i % 20 == 0) {
      press.slow_t.push_back(t);
      press.slow.push_back(press.fast.back() +
                           law * Vec3(2e4 * u.x() * u.z(), 0, 2e4 * u.z() * u.z() + 40 * memory) +
                           kNoise * Vec3(random.normal(), random.normal(), random.normal()));
    }
  }
  return press;
}

std::vector<LessonPress> lessons(double law) {
  Random random(3);
  std::vector<LessonPress> all;
  for (const auto& [rise, depth] : {std::pair{0.2, 0.006},
                                    {0.5, 0.008},
                                    {0.3, 0.004},
                                    {0.8, 0.007},
                                    {0.15, 0.008},
                                    {0.4, 0.005}})
    all.push_back(lesson(rise, depth, law, random));
  return all;
}

double rms(const std::vector<Vec3>& v) {
  double sum = 0;
  for (const Vec3& x : v) sum += x.squaredNorm();
  return std::sqrt(sum / (3 * static_cast<double>(v.size())));
}

TEST(TaughtCorrection, ForetellsAnUnseenPress) {
  const Taught taught = teach(lessons(1), 0.004);
  ASSERT_TRUE(taught.correction.taught());
  Random random(9);
  const LessonPress unseen = lesson(0.25, 0.007, 1, random);
  TaughtForce run(taught.correction);
  std::vector<Vec3> alone, corrected;
  std::size_t next = 0;
  for (std::size_t i = 0; i < unseen.t.size(); ++i) {
    const Vec3 added = run.step(i == 0 ? 0 : 1e-3, unseen.u[i]);
    if (next == unseen.slow_t.size() || unseen.t[i] < unseen.slow_t[next]) continue;
    alone.push_back(unseen.slow[next] - unseen.fast[i]);
    corrected.push_back(unseen.slow[next] - unseen.fast[i] - added);
    ++next;
  }
  EXPECT_GT(rms(alone), 50 * kNoise);
  EXPECT_LT(rms(corrected), 0.1 * rms(alone));
}

TEST(TaughtCorrection, TeachesNothingWhereThereIsNoLaw) {
  EXPECT_FALSE(teach(lessons(0), 0.004).correction.taught());
  std::vector<LessonPress> few = lessons(1);
  few.resize(3);
  const Taught taught = teach(few, 0.004);
  EXPECT_FALSE(taught.correction.taught());
  EXPECT_EQ(taught.by_others.size(), 3u);
}

TEST(TaughtCorrection, IsLevelBeyondItsLessonsAndBeginsRelaxed) {
  const TaughtCorrection c = teach(lessons(1), 0.004).correction;
  TaughtForce deep(c), deeper(c);
  const Vec3 at(0, 0, -c.scale.z()), beyond(0, 0, -3 * c.scale.z());
  EXPECT_EQ(deep.step(0, at), deeper.step(0, beyond));
  const Vec3 first = deep.step(0.01, 0.5 * at);
  deep.begin();
  deep.step(0, at);
  EXPECT_EQ(deep.step(0.01, 0.5 * at), first);
}

TEST(TaughtCorrection, HoldsWhereItsLessonsWere) {
  const TaughtCorrection c = teach(lessons(1), 0.004).correction;
  EXPECT_TRUE(c.holds_at({0.011, 0, 0.05}));
  EXPECT_FALSE(c.holds_at({0.02, 0, 0.05}));
  FusionParameters parameters;
  parameters.taught = c;
  Fusion fusion(parameters);
  const auto added = [&](const Vec3& contact) {
    fusion.begin(0, contact);
    return Vec3(fusion.step(0.01, {0, 0, -0.005}, {0, 0, 2}) - Vec3(0, 0, 2));
  };
  EXPECT_GT(added({0.01, 0, 0.05}).norm(), 0.05);
  EXPECT_EQ(added({0.02, 0, 0.05}).norm(), 0);
}

TEST(TaughtCorrection, IsReadAsItWasWritten) {
  FusionParameters parameters;
  parameters.taught = teach(lessons(1), 0.004).correction;
  std::ostringstream text;
  write_fusion(text, parameters);
  Input input = Input::from_bytes(text.str(), "filter.csv");
  const TaughtCorrection again = read_fusion(input).taught;
  EXPECT_EQ(again.scale, parameters.taught.scale);
  EXPECT_EQ(again.place, parameters.taught.place);
  EXPECT_EQ(again.reach, parameters.taught.reach);
  EXPECT_EQ(again.time, parameters.taught.time);
  EXPECT_EQ(again.weight, parameters.taught.weight);
}

}  // namespace
}  // namespace hapsim
