// A changed world is noticed, named and learned; an unchanged one gives no alarm.
#include "watch/watch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <memory>

#include "support/changing_world.h"

namespace hapsim {
namespace {

// Prepared once for all tests.
const PreparedBody& dome(int cells) {
  static std::map<int, std::unique_ptr<PreparedBody>> kept;
  std::unique_ptr<PreparedBody>& body = kept[cells];
  if (!body) body = test::prepared_dome(cells);
  return *body;
}

struct Seen {
  WatchEvent event;
  std::size_t events = 0;
  double error = 0;  // from 1 s after the update on, over the former one
  double jump = 0;   // of the model's force within a millisecond as the correction takes over [N]
};

// The stream changes at 35 s, and is followed for 10 s after the model has been updated.
Seen follow(const PreparedBody& known, test::PressStream& stream) {
  stream.when = 35.3;
  WatchOptions options;
  options.test.learning = 10;  // presses enough to know the usual error everywhere
  ModelWatch watch(known, options);
  double usual = 0, after = 0, n = 0, m = 0;
  Seen seen;
  Vec3 last = Vec3::Zero();
  for (int i = 0; i < 62'000; ++i) {
    const auto [line, f] = stream.next();
    const Vec3 model = watch.step(line, f);
    if (line.t > 15 && line.t < stream.when) usual += (f - model).squaredNorm(), ++n;
    if (!watch.events().empty()) {
      const WatchEvent& e = watch.events().front();
      if (line.t - e.named < 0.06) seen.jump = std::max(seen.jump, (model - last).norm());
      if (e.updated >= 0 && line.t > e.updated + 1 && line.t < e.updated + 10)
        after += (f - model).squaredNorm(), ++m;
    }
    last = model;
  }
  if (!watch.events().empty()) seen.event = watch.events().front();
  seen.events = watch.events().size();
  if (m > 0) seen.error = std::sqrt(after / m / (usual / n));
  return seen;
}

TEST(ModelWatch, NamesWhatHasChangedAndLearnsIt) {
  const PreparedBody &truth = dome(7), &known = dome(5);  // another mesh
  for (const Change change : {Change::kMoved, Change::kMaterial, Change::kSensor, Change::kGone})
    for (const std::uint64_t draw : {1, 2}) {
      SCOPED_TRACE(change_name(change) + ' ' + std::to_string(draw));
      test::PressStream stream(truth, draw);
      const Vec3 way = Vec3(draw == 1 ? 0.8 : -0.5, 0.5, -0.3).normalized();
      if (change == Change::kMoved) stream.after.shift = 0.005 * way;
      if (change == Change::kMaterial) stream.after.stiffness = 0.7;
      if (change == Change::kSensor) stream.after.bias = 0.1 * way;
      if (change == Change::kGone) stream.after.gone = true;
      const Seen seen = follow(known, stream);
      ASSERT_EQ(seen.events, 1u);
      EXPECT_GT(seen.event.alarm, stream.when);
      EXPECT_LT(seen.event.alarm, stream.when + 2);
      EXPECT_EQ(seen.event.change, change) << change_name(seen.event.change);
      EXPECT_GT(seen.event.updated, 0);
      EXPECT_LT(seen.event.updated, stream.when + 8);  // presses
      EXPECT_LT(seen.error, 1.3);
      EXPECT_LT(seen.jump, 0.25) << "a jump in the force";
      const Correction& c = seen.event.correction;
      if (change == Change::kMoved) {
        EXPECT_LT((c.shift - stream.after.shift).norm(), 2.5 * seen.event.shift_error.norm());
        EXPECT_LT(seen.event.shift_error.norm(), 5e-4);
      }
      if (change == Change::kSensor) {
        EXPECT_LT((c.bias - stream.after.bias).norm(), 0.02);
      }
    }
}

// A body that dries: stiffness and relaxation change each in its own way.
TEST(ModelWatch, IdentifiesTheRelaxationAnew) {
  const PreparedBody &truth = dome(7), &known = dome(5);
  const auto dry = test::prepared_dome(7, 1.6e4, 1.44e4, 0.3);
  for (const std::uint64_t draw : {1, 2, 3}) {
    SCOPED_TRACE(draw);
    test::PressStream stream(truth, draw);
    stream.becomes(*dry);
    const Seen seen = follow(known, stream);
    ASSERT_EQ(seen.events, 1u);
    EXPECT_EQ(seen.event.change, Change::kMaterial) << change_name(seen.event.change);
    const Correction& c = seen.event.correction;
    EXPECT_NEAR(c.slowness, 2, 0.5);
    EXPECT_NEAR(c.relaxation, 3, 0.75);
    EXPECT_NEAR(c.stiffness, 0.8, 0.08);
    EXPECT_LT(seen.error, 1.3);  // as before the change
    EXPECT_LT(seen.jump, 0.25);
  }
}

TEST(ModelWatch, GivesNoAlarmWhileNothingChanges) {
  const PreparedBody &truth = dome(7), &known = dome(5);
  std::size_t alarms = 0;
  for (const std::uint64_t draw : {77, 1, 2, 3, 4, 5, 6, 7, 8, 9}) {
    test::PressStream stream(truth, draw);
    WatchOptions options;
    options.test.false_alarms = 0.1;
    options.test.learning = 30;
    ModelWatch watch(known, options);
    for (long i = 0; i < 1'200'000; ++i) {  // twenty minutes
      const auto [line, f] = stream.next();
      watch.step(line, f);
    }
    EXPECT_TRUE(watch.learned());
    alarms += watch.events().size();
  }
  EXPECT_LE(alarms, 2u);  // in more than three hours
}

// Siegmund's formula against a simulation of unit normal values.
TEST(ModelWatch, TheLimitKeepsTheRate) {
  const double h = change_limit(500);
  Random random(5);
  double sum = 0;
  long alarms = 0;
  const long n = 2'000'000;
  for (long i = 0; i < n; ++i) {
    sum = std::max(0.0, sum + random.normal() - 0.5);
    if (sum > h) ++alarms, sum = 0;
  }
  EXPECT_NEAR(static_cast<double>(n) / static_cast<double>(alarms), 500, 35);
}

}  // namespace
}  // namespace hapsim
