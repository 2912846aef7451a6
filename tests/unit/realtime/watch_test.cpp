// A changed world is noticed, named and learned; an unchanged one gives no alarm.
#include "realtime/watch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "base/random.h"
#include "effects/catalogue.h"
#include "support/block_mesh.h"

namespace hapsim {
namespace {

// A dome: a block whose top is bent down towards its edges.
TetMesh dome(int cells) {
  TetMesh mesh = test::block_mesh({0.08, 0.08, 0.04}, cells, cells, (2 * cells + 2) / 3, 1);
  for (Vec3& p : mesh.nodes)
    p.z() *= 1 - 0.4 * (Vec3(p.x() - 0.04, p.y() - 0.04, 0).squaredNorm()) / (0.04 * 0.04);
  return mesh;
}

std::unique_ptr<PreparedBody> body(int cells) {
  Model model;
  model.parameters = effect_rows(*find_effect("elastic"), 1, {2e4, 0.45});
  for (const Parameter& p : effect_rows(*find_effect("viscoelastic"), 1, {6e3, 0.15}))
    model.parameters.push_back(p);
  PreparedBodyOptions options;
  options.tool_radius = 0.004;
  return std::make_unique<PreparedBody>(dome(cells), model, options);
}

struct World {
  double stiffness = 1;
  Vec3 bias = Vec3::Zero(), shift = Vec3::Zero();
  bool gone = false;
};

// Presses of 1 s at random places, air between them; the world changes at `when` [s].
class Stream {
 public:
  Stream(const PreparedBody& truth, std::uint64_t seed)
      : loop_(truth), random_(seed), truth_(truth) {}
  World before, after;
  double when = 1e9;

  std::pair<MotionLine, Vec3> next() {
    const double in_press = 1e-3 * (count_ % 1000);
    if (count_ % 1000 == 0) {
      const Vec3 above(0.02 + 0.04 * random_.uniform(), 0.02 + 0.04 * random_.uniform(), 0.06);
      const SurfaceSide side = truth_.distance().at(above);
      place_ = side.point;
      normal_ = side.normal;
      side_ = 0.3 * (random_.uniform() - 0.5);
      depth_ = 0.003 + 0.003 * random_.uniform();
      ++press_;
    }
    const double t = 1e-3 * static_cast<double>(count_++);
    const World& world = t < when ? before : after;
    MotionLine line;
    line.press = press_;
    line.t = t;
    line.point = place_;
    line.in_air = in_press > 0.8;
    const double s = line.in_air ? 0 : std::pow(std::sin(3.1416 * in_press / 0.8), 2);
    line.u = depth_ * s * (side_ * Vec3(1, 0.5, 0) - normal_);
    if (line.in_air) line.u = 0.012 * normal_;  // clear of the body, moved or not
    Vec3 f = Vec3::Zero();
    if (!world.gone) f = world.stiffness * loop_.step(t, line.point + line.u - world.shift);
    f += world.bias;
    for (int k = 0; k < 3; ++k) f[k] += 0.015 * random_.normal();
    return {line, f};
  }

 private:
  ForceLoop loop_;
  Random random_;
  const PreparedBody& truth_;
  long count_ = 0;
  int press_ = 0;
  Vec3 place_, normal_;
  double side_ = 0, depth_ = 0;
};

TEST(ModelWatch, NamesWhatHasChangedAndLearnsIt) {
  const auto truth = body(7), known = body(5);  // the model's mesh is another
  int right = 0, all = 0;
  for (const Change change : {Change::kMoved, Change::kMaterial, Change::kSensor, Change::kGone}) {
    int named = 0, quick = 0, mended = 0;
    const int draws = 3;
    for (int draw = 0; draw < draws; ++draw) {
      Random random(static_cast<std::uint64_t>(100 + draw));
      Stream stream(*truth, static_cast<std::uint64_t>(draw + 1));
      stream.when = 32 + 3 * random.uniform();
      Vec3 way(random.normal(), random.normal(), random.normal());
      way.normalize();
      if (change == Change::kMoved) stream.after.shift = 0.005 * way;
      if (change == Change::kMaterial) stream.after.stiffness = 0.7;
      if (change == Change::kSensor) stream.after.bias = 0.1 * way;
      if (change == Change::kGone) stream.after.gone = true;
      WatchOptions options;
      options.learning = 20;  // presses enough to know the usual error everywhere
      ModelWatch watch(*known, options);
      // Errors over the force: a body that has come nearer is pressed harder.
      double squares = 0, usual = 0, last = 0, n = 1e-12, m = 0;
      double largest = 0;
      for (int i = 0; i < 48'000; ++i) {
        const auto [line, f] = stream.next();
        const Vec3 model = watch.step(line, f);
        if (line.t > 26 && line.t < stream.when)
          usual += (f - model).squaredNorm(), m += f.squaredNorm();
        if (line.t > 43)  // a shift may have taken a second look
          squares += (f - model).squaredNorm(), n += f.squaredNorm();
        if (!watch.events().empty() && line.t - watch.events().front().named < 0.06)
          largest = std::max(largest, std::abs(model.norm() - last));
        last = model.norm();
      }
      ASSERT_FALSE(watch.events().empty()) << change_name(change) << " draw " << draw;
      const WatchEvent& event = watch.events().front();
      EXPECT_GT(event.alarm, stream.when) << "a false alarm";
      quick += event.alarm - stream.when < 2 ? 1 : 0;
      const bool same =
          event.change == change || (change == Change::kMoved && event.change == Change::kGone &&
                                     way.z() < -0.5);  // out of reach
      named += same ? 1 : 0;
      const double with = change == Change::kGone ? std::sqrt(squares) : std::sqrt(squares / n);
      const double limit = change == Change::kGone ? 1e9
                           : change == Change::kMoved
                               ? 3 * std::sqrt(usual / m)  // where it is not pressed
                               : 1.3 * std::sqrt(usual / m);
      if (change == Change::kMoved)
        printf("  draw %d: %.2f of the former error\n", draw, with / std::sqrt(usual / m));
      mended += with < limit ? 1 : 0;
      EXPECT_LT(largest, 0.25) << "a jump in the force";
      if (!same)
        printf("%s draw %d: named %s, stiffness %g bias %g shift %g %g %g\n",
               change_name(change).c_str(), draw, change_name(event.change).c_str(),
               event.correction.stiffness, event.correction.bias.norm(), event.correction.shift.x(),
               event.correction.shift.y(), event.correction.shift.z());
    }
    printf("%s: noticed within 2 s %d, named rightly %d, error mended %d of %d\n",
           change_name(change).c_str(), quick, named, mended, draws);
    EXPECT_EQ(quick, draws) << change_name(change);
    right += named;
    all += draws;
    EXPECT_GE(mended, draws - 1) << change_name(change);
  }
  EXPECT_GE(right, all - 1);
}

TEST(ModelWatch, GivesNoAlarmWhileNothingChanges) {
  const auto truth = body(7), known = body(5);
  Stream stream(*truth, 77);
  WatchOptions options;
  options.false_alarms = 0.1;
  options.learning = 30;
  ModelWatch watch(*known, options);
  for (long i = 0; i < 1'200'000; ++i) {  // twenty minutes
    const auto [line, f] = stream.next();
    watch.step(line, f);
  }
  EXPECT_TRUE(watch.learned());
  EXPECT_LE(watch.events().size(), 1u);
}

// Siegmund's formula against a simulation of unit normal values.
TEST(ModelWatch, TheLimitKeepsTheRate) {
  const auto known = body(3);
  WatchOptions options;
  options.block = 1;
  options.false_alarms = 3600 / 500.0;  // one in 500 values
  const double h = ModelWatch(*known, options).limit();
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
