// Two ends and a bad network between them, on a clock of the test's own.
#include "link/telepresence.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>

#include "base/random.h"
#include "effects/catalogue.h"
#include "estimate/lag.h"
#include "link/impaired_channel.h"
#include "realtime/force_loop.h"
#include "support/allocations.h"
#include "support/block_mesh.h"

namespace hapsim {
namespace {

Model model_of(double E, double E1) {
  Model model;
  model.parameters = effect_rows(*find_effect("elastic"), 1, {E, 0.45});
  if (E1 > 0)
    for (const Parameter& p : effect_rows(*find_effect("viscoelastic"), 1, {E1, 0.1}))
      model.parameters.push_back(p);
  return model;
}

const PreparedBody& body(const Model& model) {
  static std::vector<std::unique_ptr<PreparedBody>> kept;
  PreparedBodyOptions options;
  options.tool_radius = 0.004;
  options.most_samples = 16;
  options.rim_edge = 0.5;  // no test of it: quick
  kept.push_back(std::make_unique<PreparedBody>(test::block_mesh({0.08, 0.08, 0.04}, 4, 4, 3, 1),
                                                model, options));
  return *kept.back();
}

MotionLine motion(int i, double peak = 0.003) {
  MotionLine line;
  line.t = 1e-3 * i;
  line.point = {0.04, 0.04, 0.04};
  const double s = std::sin(2.5 * line.t);
  line.u = {5e-4 * std::sin(3 * line.t) * s, 0, -peak * s * s};
  return line;
}

constexpr Secret kSharedKey{1, 2, 3};
constexpr std::int64_t kMillisecond = 1'000'000;

Terms agreed_terms() {
  Terms t;
  t.tool_radius = 0.004;
  t.high = {0.08, 0.08, 0.04};
  return t;
}
SafetyLimits wide() {
  SafetyLimits limits;
  limits.force = 100;
  limits.rate = 1e5;
  limits.power = 1e5;
  limits.hold = 0.8;  // beyond what the network here takes
  return of_any_energy(limits);
}

// Both ends for `samples` ms, once they have shaken hands; `meddle` may do something at each.
struct TwoEnds {
  explicit TwoEnds(const Impairment& bad, int samples,
                   const std::function<void(int, TwoEnds&)>& meddle = {},
                   const SafetyLimits& limits = wide(), double peak = 0.003) {
    OperatorOptions options;
    options.samples = 1500;
    options.limits = limits;
    near = std::make_unique<Operator>(response, options);
    restart_far(limits);
    ImpairedChannel out(bad, 1), back(bad, 2);
    Datagram datagram, reply;
    int moved = 0;
    for (int i = 0; moved < samples + 600 && i < samples + 20000; ++i) {
      const std::int64_t now = kMillisecond * (i + 1000);
      if (near_end.tick(now, datagram)) out.push(now, datagram);
      if (near_end.is_linked() || moved > 0) {
        if (moved < samples) {
          const Packet packet = near->move(now, motion(moved, peak));
          felt.push_back(near->felt());
          if (near_end.write(packet, datagram)) out.push(now, datagram);
        }
        ++moved;
      }
      while (out.pop(now, datagram)) {
        if (!far) continue;
        const auto got = far_end->receive(now, {}, datagram.view(), reply);
        if (got.reply) back.push(now, reply);
        Packet answer;
        if (got.received && far->press(now, *got.received, answer) && far_end->write(answer, reply))
          back.push(now, reply);
      }
      if (far) far->idle(now);
      while (back.pop(now, datagram))
        if (const auto got = near_end.receive(now, datagram.view())) near->receive(now, *got);
      if (meddle && moved > 0) meddle(moved, *this);
    }
  }
  void restart_far(const SafetyLimits& limits) {
    far_end = std::make_unique<TeleoperatorEnd>(kSharedKey, agreed_terms());
    far = std::make_unique<Teleoperator>(hidden, limits, agreed_terms().low, agreed_terms().high);
  }
  ForceLoop hidden{body(model_of(2.2e4, 6e3))};
  UnitResponse response{body(model_of(1, 0)), {0.1}};
  OperatorEnd near_end{kSharedKey, agreed_terms()};
  std::unique_ptr<TeleoperatorEnd> far_end;
  std::unique_ptr<Operator> near;
  std::unique_ptr<Teleoperator> far;
  std::vector<SafeSample> felt;
};

TEST(Telepresence, FeelsLateForcesThenTheIdentifiedBodyAtOnce) {
  const TwoEnds run({0.15, 0.025, 0.05, 0.02, 0.02}, 8000);
  ASSERT_TRUE(run.near->predicts());
  const auto at = static_cast<std::size_t>(run.near->identified_at());
  const FeltQuality before = felt_quality(run.near->record(), 0, at, 1000);
  const FeltQuality after = felt_quality(run.near->record(), at + 300, 8000, 1000);
  EXPECT_GT(before.force_lag, 0.28);
  EXPECT_LT(before.force_lag, 0.4);
  EXPECT_GT(before.rms, 0.1 * before.peak);
  EXPECT_LT(std::abs(after.force_lag), 0.002);
  EXPECT_LT(after.rms, 0.01 * after.peak);
  EXPECT_NEAR(run.near->estimate().moduli[0], 2.2e4, 50);
  EXPECT_NEAR(run.near->estimate().moduli[1], 6e3, 50);
  EXPECT_GT(run.far_end->counts().stale, 0);
  // The change is let in without a jump: no step beyond those of the motion.
  double largest = 0, usual = 0;
  for (std::size_t i = at - 20; i < at + 300; ++i) {
    const auto& r = run.near->record();
    largest = std::max(largest, (r[i].felt - r[i - 1].felt).norm());
  }
  for (std::size_t i = 1; i < at; ++i)
    usual = std::max(usual, (run.near->record()[i].felt - run.near->record()[i - 1].felt).norm());
  EXPECT_LT(largest, 3 * usual);
}

TEST(Telepresence, APeerThatDiesAndReturnsIsServedAgain) {
  SafetyLimits limits = wide();
  limits.hold = 0.1;
  limits.ramp = 0.2;
  const TwoEnds run(
      {0.01, 0, 0, 0, 0}, 6000,
      [&](int i, TwoEnds& ends) {
        if (i == 1000) ends.far.reset();
        if (i == 1800) ends.restart_far(limits);
      },
      limits);
  EXPECT_EQ(run.near_end.counts().sessions, 2);
  EXPECT_TRUE(run.near->record()[900].answered);
  EXPECT_FALSE(run.near->record()[1500].answered);
  EXPECT_TRUE(run.near->record()[4500].answered);
  // Without a peer there is no force after hold and ramp, and each sample says so.
  EXPECT_NE(run.felt[1200].flags & kSafeRamped, 0);
  for (std::size_t i = 1321; i < 1800; ++i) EXPECT_EQ(run.felt[i].force, Vec3(0, 0, 0)) << i;
  EXPECT_GT(run.felt[5900].force.norm() + run.felt[5200].force.norm(), 0.1) << "it comes back";
  EXPECT_EQ(run.near->losses(), 1);
}

TEST(Telepresence, WhatTheHandFeelsStaysWithinItsLimits) {
  SafetyLimits limits;
  limits.force = 2;
  limits.rate = 40;
  const TwoEnds run({0.05, 0.02, 0.2, 0.02, 0.02}, 6000, {}, limits, 0.012);
  Vec3 before = Vec3::Zero();
  double most = 0, asked = 0;
  for (const SafeSample& s : run.felt) {
    most = std::max(most, s.force.norm());
    asked = std::max(asked, s.unlimited.norm());
    EXPECT_LE((s.force - before).norm(), 40e-3 * (1 + 1e-9));
    before = s.force;
  }
  EXPECT_LE(most, 2);
  EXPECT_GT(most, 1.9);
  EXPECT_GE(asked, most);
}

TEST(Telepresence, LateForcesGiveNoMoreEnergyThanAllowed) {
  SafetyLimits limits = wide();
  limits.energy = 0.001;
  const Impairment late{0.15, 0.025, 0.2, 0, 0};
  const TwoEnds free(late, 2500), bounded(late, 2500, {}, limits);
  ASSERT_FALSE(free.near->predicts());
  const auto gained = [](const TwoEnds& run) {
    double work = 0, most = 0;
    for (std::size_t i = 1; i < run.felt.size(); ++i) {
      const Vec3 way = motion(static_cast<int>(i)).u - motion(static_cast<int>(i) - 1).u;
      work += run.felt[i - 1].force.dot(way) - 1e3 * way.squaredNorm();  // less what 1 N s/m took
      most = std::max(most, work);
    }
    return most;
  };
  EXPECT_GT(gained(free), 2 * limits.energy);
  EXPECT_LE(gained(bounded), limits.energy);
  EXPECT_NEAR(bounded.near->most_given(), gained(bounded), 2e-4);
  long flagged = 0;
  for (const SafeSample& s : bounded.felt) {
    flagged += (s.flags & kSafeEnergy) != 0;
    if (s.flags == 0) {
      EXPECT_EQ(s.force, s.unlimited);
    }
  }
  EXPECT_GT(flagged, 100);
  EXPECT_LT(flagged, 2400);
  // The far side counts what the body has taken.
  EXPECT_GT(bounded.near->energy_there(), 0);
  EXPECT_NEAR(bounded.near->energy_there(), free.near->energy_there(), 1e-3);
}

TEST(Teleoperator, MakesNoImpossibleMotionAndTakesTheToolBack) {
  ForceLoop hidden(body(model_of(2e4, 6e3)));
  Teleoperator far(hidden, {}, agreed_terms().low, agreed_terms().high);
  Received got;
  got.is_newest = got.is_anew = true;
  got.packet.first = {0.04, 0.04, 0.04};
  Packet answer;
  const auto send = [&](std::int64_t now, double u) {
    ++got.packet.number;
    got.packet.t = 1e-9 * static_cast<double>(now);
    got.packet.second = {0, 0, u};
    const bool taken = far.press(now, got, answer);
    got.is_anew = false;
    return taken;
  };
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(send(kMillisecond * i, -2e-5 * i));
  const double pressed = answer.first.z();
  EXPECT_GT(pressed, 0.5);
  // Through the body, by nearly ten metres: not made.
  ASSERT_TRUE(send(kMillisecond * 100, -9.9));
  EXPECT_EQ(answer.first.z(), pressed) << "held";
  EXPECT_NE(answer.flags & kSafeInvalid, 0);
  EXPECT_EQ(far.impossible(), 1);
  // A leap within the body is made at 1 m/s.
  ASSERT_TRUE(send(kMillisecond * 101, -0.03));
  EXPECT_NEAR(far.displacement().z(), -2e-5 * 99 - 2e-3, 1e-6);
  EXPECT_NE(answer.flags & kSafeRate, 0);
  --got.packet.number;
  --got.packet.number;
  EXPECT_FALSE(send(kMillisecond * 102, -1e-3)) << "an old number is not pressed again";
  // The operator is gone: held for 0.1 s, back within 0.2 s.
  const double held = far.displacement().z();
  for (int ms = 102; ms < 200; ms += 2) far.idle(kMillisecond * ms);
  EXPECT_EQ(far.displacement().z(), held);
  for (int ms = 202; ms < 290; ms += 2) far.idle(kMillisecond * ms);
  EXPECT_LT(far.displacement().z(), 0);
  EXPECT_GT(far.displacement().z(), held);
  for (int ms = 290; ms < 410; ms += 2) far.idle(kMillisecond * ms);
  EXPECT_EQ(far.displacement(), Vec3(0, 0, 0));
  EXPECT_EQ(far.losses(), 1);
}

TEST(Operator, FeelsNoAnswerOfAnotherPress) {
  UnitResponse response(body(model_of(1, 0)), {});
  Operator near(response, {});
  Received force;
  force.is_newest = true;
  force.packet.kind = Packet::Kind::kForce;
  const auto answer = [&](std::uint64_t motion, double f) {
    ++force.packet.number;
    force.packet.answers = motion;
    force.packet.first = {0, 0, f};
    near.receive(kMillisecond, force);
  };
  for (int i = 0; i < 20; ++i) near.move(kMillisecond * i, motion(i));
  answer(10, 0.5);
  EXPECT_EQ(near.measured().z(), 0.5);
  MotionLine other = motion(21);
  other.press = 2;
  near.move(kMillisecond * 21, other);
  EXPECT_EQ(near.measured().z(), 0) << "a new press begins without force";
  answer(15, 0.9);
  EXPECT_EQ(near.measured().z(), 0) << "of the press before";
  answer(21, 0.2);
  EXPECT_EQ(near.measured().z(), 0.2);
}

TEST(Operator, TakesNoMemoryHoweverLongItRuns) {
  UnitResponse response(body(model_of(1, 0)), {});
  OperatorOptions options;
  options.remember = 2;
  Operator near(response, options);
  Received force;
  force.is_newest = true;
  force.packet.kind = Packet::Kind::kForce;
  long taken = 0;
  for (int i = 0; i < 20'000; ++i) {
    if (i == 100) taken = test::allocations;
    const Packet sent = near.move(kMillisecond * i, motion(i % 5000));
    ++force.packet.number;
    force.packet.answers = sent.number;
    near.receive(kMillisecond * i, force);
  }
  EXPECT_EQ(test::allocations - taken, 0);
  EXPECT_EQ(near.record().size(), 20'000u);
  EXPECT_EQ(near.record().first(), 18'000u);
}

TEST(ImpairedChannel, DelaysLosesDoublesAndReordersAsAsked) {
  ImpairedChannel channel({0.1, 0.02, 0.1, 0.05, 0.2}, 3);
  Datagram bytes;
  bytes.size = sizeof(int);
  long got = 0, early = 0, overtaken = 0;
  int newest = -1;
  for (int i = 0; i < 50'000; ++i) {
    const std::int64_t now = 1'000'000LL * i;
    std::copy_n(reinterpret_cast<const unsigned char*>(&i), sizeof i, bytes.bytes.begin());
    channel.push(now, bytes);
    Datagram out;
    while (channel.pop(now, out)) {
      int number = 0;
      std::copy_n(out.bytes.begin(), sizeof number, reinterpret_cast<unsigned char*>(&number));
      ++got;
      early += now - 1'000'000LL * number < 100'000'000 ? 1 : 0;
      overtaken += number < newest ? 1 : 0;
      newest = std::max(newest, number);
    }
  }
  EXPECT_EQ(early, 0);
  EXPECT_NEAR(static_cast<double>(got), 50'000 * 0.9 * 1.05, 600);
  EXPECT_GT(overtaken, 1000);
}

TEST(OnlineIdentification, KeepsModuliAtZeroOrAbove) {
  Random random(2);
  OnlineIdentification identification(3);
  for (int i = 0; i < 4000; ++i) {
    UnitForces unit(3, 3);
    for (int k = 0; k < 9; ++k) unit(k % 3, k / 3) = random.normal();
    Vec3 force = 5 * unit.col(0) - 0.5 * unit.col(1) + 2 * unit.col(2);
    for (int k = 0; k < 3; ++k) force[k] += 0.1 * random.normal();
    identification.add(unit, force);
  }
  const OnlineEstimate found = identification.estimate();
  EXPECT_EQ(found.moduli[1], 0);
  EXPECT_NEAR(found.moduli[0], 5, 4 * found.error[0]);
  EXPECT_NEAR(found.moduli[2], 2, 4 * found.error[2]);
  EXPECT_LT(found.error[0], 0.01);
}

TEST(Lag, IsFoundToAPartOfASample) {
  std::vector<double> x, y;
  for (int i = 0; i < 3000; ++i) {
    x.push_back(std::sin(0.01 * i) + 0.3 * std::sin(0.037 * i));
    y.push_back(2 * std::sin(0.01 * (i - 30.4)) + 0.6 * std::sin(0.037 * (i - 30.4)) + 1);
  }
  EXPECT_NEAR(lag_between(x, y, 100), 30.4, 0.1);
  EXPECT_NEAR(lag_between(y, x, 100), -30.4, 0.1);
  EXPECT_TRUE(std::isnan(lag_between(x, std::vector<double>(3000, 1.0), 100)));
}

}  // namespace
}  // namespace hapsim
