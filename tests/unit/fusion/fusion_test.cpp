// Fusing a fast source that errs with a slow one that comes late.
#include "fusion/fusion.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <sstream>

#include "base/error.h"
#include "base/random.h"
#include "fusion/fuse_recordings.h"
#include "fusion/fusion_file.h"

namespace hapsim {
namespace {

// Presses whose truth stiffens and drifts, a fast source 20 % off, slow forces every `every`
// samples.
struct Case {
  Recording exact, fast, slow;
};
Case presses(double rise, int every, double noise = 0) {
  Case c;
  Random random(2);
  for (Recording* r : {&c.exact, &c.fast, &c.slow}) r->name = "synthetic";
  for (int press = 1; press <= 3; ++press)
    for (int i = 0; i <= 3000 * rise; ++i) {
      const double t = 1e-3 * i;
      const double depth = (0.003 + 0.0005 * press) * std::pow(std::sin(1.0472 * t / rise), 2);
      const double f = 500 * depth * (1 + 60 * depth) + 0.05 * std::sin(t) * depth / 0.004;
      const auto add = [&](Recording& r, double force) {
        r.line.push_back(static_cast<long>(r.line.size()) + 2);
        r.press.push_back(press);
        r.t.push_back(t);
        r.position.push_back(Vec3::Zero());
        r.u.push_back({0, 0, -depth});
        r.f.push_back({0.1 * force, -0.05 * force, force});
        if (&r == &c.slow)
          for (int k = 0; k < 3; ++k) r.f.back()[k] += noise * random.normal();
      };
      add(c.exact, f);
      add(c.fast, 400 * depth);
      if (i % every == 0) add(c.slow, f);
    }
  return c;
}

TEST(Fusion, BeatsItsSourcesAndTheirExtrapolationAtSlowAndFastMotion) {
  const Case lesson = presses(0.2, 40);
  const LearnedFusion learned = learn_fusion(lesson.fast, {&lesson.slow, 0.04}, {});
  EXPECT_TRUE(learned.converged);
  for (const double rise : {0.1, 2.0}) {
    const Case c = presses(rise, 40);
    const FusedForces fused = fuse(c.fast, {&c.slow, 0.04}, learned.parameters);
    const auto rms = [&](const std::vector<Vec3>& f) {
      return force_quality(c.fast, f, c.exact.f).rms;
    };
    EXPECT_LT(rms(fused.force), rms(c.fast.f)) << rise;
    EXPECT_LT(rms(fused.force), rms(fused.held)) << rise;
    EXPECT_LT(rms(fused.force), rms(fused.extrapolated)) << rise;
    // No steps of the slow source.
    EXPECT_LT(force_quality(c.fast, fused.force, c.exact.f).largest_step,
              0.5 * force_quality(c.fast, fused.held, c.exact.f).largest_step);
  }
}

// The fast source's error turns its sign in just the time by which the slow one is late: what was
// missing then is wrong by now, and putting it in would double the error.
TEST(Fusion, IsNoWorseThanTheFastSourceWhereTheSlowOneComesTooLate) {
  Case c = presses(1, 20);
  c.fast.f = c.exact.f;
  for (std::size_t i = 0; i < c.fast.f.size(); ++i)
    c.fast.f[i] += Vec3(0, 0, 0.1 * std::sin(31.416 * c.fast.t[i]));
  const auto rms = [&](double delay, bool weighs = true) {
    FusionParameters p;
    p.weighs = weighs;
    return force_quality(c.fast, fuse(c.fast, {&c.slow, delay}, p).force, c.exact.f).rms;
  };
  const double alone = force_quality(c.fast, c.fast.f, c.exact.f).rms;
  EXPECT_LT(rms(0.1), 1.1 * alone);
  EXPECT_GT(rms(0.1, false), 1.3 * alone);
  EXPECT_LT(rms(0.005), 0.6 * alone);  // in time it is of use
}

// Learned at one pace and lateness, used at others.
TEST(Fusion, StatesItsOwnErrorAtAnyPaceAndLateness) {
  const Case lesson = presses(0.2, 20, 0.01);
  const LearnedFusion learned = learn_fusion(lesson.fast, {&lesson.slow, 0.02}, {});
  for (const double rise : {0.125, 0.3, 1.0})
    for (const int every : {10, 20, 60}) {
      const Case c = presses(rise, every, 0.01);
      for (const double delay : {0.01, 0.03, 0.06}) {
        SCOPED_TRACE(::testing::Message() << rise << ' ' << every << ' ' << delay);
        const FusionReport report = fuse(c.fast, {&c.slow, delay}, learned.parameters).report;
        EXPECT_GT(report.mean_nis(), report.band()[0]);
        EXPECT_LT(report.mean_nis(), report.band()[1]);
      }
    }
}

// The weight of a slow force: what is let in of a difference of one.
double weight(double rate) {
  FusionParameters p;
  p.blend = 0;
  for (AxisFusion& axis : p.axis) axis.walk_rate = 0.1;
  Fusion fusion(p);
  fusion.begin(0, Vec3::Zero());
  double before = 0;
  for (int i = 1; i <= 200; ++i) {
    before = fusion.step(1e-3 * i, {0, 0, -1e-3 * rate * i}, {0, 0, 1}).z();
    if (i < 200 && i % 20 == 0) fusion.observe(1e-3 * i, {0, 0, before});
  }
  fusion.observe(0.2, {0, 0, before + 1});
  return fusion.step(0.2, {0, 0, -0.2 * rate}, {0, 0, 1}).z() - before;
}

TEST(Fusion, TheFastSourceGainsWeightWithTheRateOfEitherSign) {
  EXPECT_GT(weight(0), 1.2 * weight(0.03));
  EXPECT_GT(weight(0.03), 1.2 * weight(0.1));
  EXPECT_NEAR(weight(0.03), weight(-0.03), 1e-12);
  EXPECT_GT(weight(0.1), 0);
}

TEST(Fusion, KnowsNothingBeforeItIsThere) {
  const Case c = presses(0.3, 20);
  const FusedForces late = fuse(c.fast, {&c.slow, 100}, {});
  for (std::size_t i = 0; i < late.force.size(); ++i) EXPECT_EQ(late.force[i], c.fast.f[i]);
  EXPECT_EQ(late.report.observations, 0);
}

// A slow source whose memory knows of its own steps alone: what a step of 0.1 s makes of a press of
// 0.1 s is large, and the fast source, which errs otherwise, shows it.
TEST(Fusion, TakesOffWhatSeldomStepsMakeOfABodyThatRelaxes) {
  const auto relaxing = [](double stiffness, int every) {
    Recording r;
    r.name = "relaxing";
    for (int press = 1; press <= 4; ++press) {
      double kept = 0, last = 0;
      for (int i = 0; i <= 400; i += every) {
        const double t = 1e-3 * i, step = 1e-3 * every;
        const double depth = 1e-3 * (3 + press) * std::pow(std::sin(15.708 * t), 2);
        const double a = std::exp(-step / 0.08);
        kept = i == 0 ? 0 : a * kept + (1 - a) * 0.08 / step * (depth - last);
        last = depth;
        r.line.push_back(static_cast<long>(r.line.size()) + 2);
        r.press.push_back(press);
        r.t.push_back(t);
        r.position.push_back(Vec3::Zero());
        r.u.push_back({0, 0, -depth});
        r.f.push_back({0, 0, stiffness * (depth + kept)});
      }
    }
    return r;
  };
  const Recording exact = relaxing(500, 1), fast = relaxing(450, 1);
  const Recording slow = relaxing(500, 70), stepped = relaxing(450, 70);
  // At its own times, where it is held at once, what is left is the share that the fast one misses.
  const auto worst = [&](const Recording* along) {
    const FusedForces fused = fuse(fast, {&slow, 0, along}, {});
    double error = 0;
    for (const Press& press : fast.presses())
      for (std::size_t k = 0; k < press.rows.size(); k += 70) {
        const auto i = static_cast<std::size_t>(press.rows[k]);
        error = std::max(error, (fused.held[i] - exact.f[i]).norm());
      }
    return error;
  };
  EXPECT_GT(worst(nullptr), 0.05);
  EXPECT_NEAR(worst(&stepped), 0.1 * worst(nullptr), 0.01 * worst(nullptr));
  const Recording other = relaxing(450, 60);
  EXPECT_THROW(fuse(fast, {&slow, 0, &other}, {}), Error);
}

// Corrections that were right at once and by half late, whatever the way.
TEST(CorrectionWorth, TellsWayFromAge) {
  CorrectionWorth worth;
  for (int i = 0; i < 20; ++i) {
    worth.add(1e-4, 0.005, 1, 1);
    worth.add(1e-4, 0.5, 0.5, 1);
    worth.add(2e-3, 0.005, 0.4, 1);
    worth.add(2e-3, 0.5, 0.2, 1);
    worth.add(-1, 0, 0.1, 1);
  }
  const CorrectionShares shares = worth.shares({});
  EXPECT_NEAR(shares.of_way(-1) * shares.of_age(-1, 3), 0.1, 1e-9);
  for (const auto& [moved, age, share] : {std::array{1e-4, 0.005, 1.0}, {1e-4, 0.5, 0.5}})
    EXPECT_NEAR(shares.way[way_band(moved)] * shares.age[age_band(age)], share, 1e-6);
  EXPECT_NEAR(shares.way[way_band(2e-3)] * shares.age[age_band(0.5)], 0.2, 1e-6);
  // Beyond what was seen as at the last that was.
  EXPECT_EQ(shares.way.back(), shares.way[way_band(2e-3)]);
  EXPECT_EQ(shares.age.back(), shares.age[age_band(0.5)]);
}

TEST(Fusion, RefusesWhatBelongsToNoSample) {
  Fusion fusion({}, 64);
  fusion.begin(1, Vec3::Zero());
  for (int i = 1; i <= 200; ++i) fusion.step(1 + 1e-3 * i, Vec3::Zero(), {0, 0, 1});
  EXPECT_FALSE(fusion.observe(0.5, {0, 0, 1}));    // before the contact
  EXPECT_FALSE(fusion.observe(1.001, {0, 0, 1}));  // forgotten
  EXPECT_FALSE(fusion.observe(3, {0, 0, 1}));      // to come
  EXPECT_FALSE(fusion.observe(1.19, {0, 0, std::nan("")}));
  EXPECT_TRUE(fusion.observe(1.19, {0, 0, 1}));
  EXPECT_EQ(fusion.report().refused, 4);
}

TEST(FusionParameters, AreReadAsTheyAreWritten) {
  FusionParameters p;
  p.axis[1].noise = 0.123;
  p.blend = 0.02;
  p.share.way[3] = 0.4;
  p.share.age[8] = 0.3;
  std::ostringstream out;
  write_fusion(out, p);
  Input in = Input::from_bytes(out.str(), "filter.csv");
  const FusionParameters back = read_fusion(in);
  EXPECT_EQ(back.axis[1].noise, 0.123);
  EXPECT_EQ(back.axis[2].noise, p.axis[2].noise);
  EXPECT_EQ(back.blend, 0.02);
  EXPECT_EQ(back.share.way[3], 0.4);
  EXPECT_EQ(back.share.age[8], 0.3);
  Input bad = Input::from_bytes("parameter,axis,value\nnoise,x,-1\n", "filter.csv");
  EXPECT_THROW(read_fusion(bad), Error);
}

}  // namespace
}  // namespace hapsim
