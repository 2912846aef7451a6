// Two ends and a bad network between them, on a clock of the test's own.
#include "link/telepresence.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"
#include "effects/catalogue.h"
#include "estimate/lag.h"
#include "link/impaired_channel.h"
#include "realtime/force_loop.h"
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
  kept.push_back(std::make_unique<PreparedBody>(test::block_mesh({0.08, 0.08, 0.04}, 4, 4, 3, 1),
                                                model, options));
  return *kept.back();
}

MotionLine motion(int i) {
  MotionLine line;
  line.t = 1e-3 * i;
  line.point = {0.04, 0.04, 0.04};
  const double s = std::sin(2.5 * line.t);
  line.u = {5e-4 * std::sin(3 * line.t) * s, 0, -0.003 * s * s};
  return line;
}

// Both ends for `samples` ms; `meddle` may do something to the teleoperator at each.
struct TwoEnds {
  explicit TwoEnds(
      const Impairment& bad, int samples,
      const std::function<void(int, std::unique_ptr<Teleoperator>&, ToolLoop&)>& meddle = {}) {
    OperatorOptions options;
    options.samples = 1500;
    near = std::make_unique<Operator>(response, 17, options, static_cast<std::size_t>(samples));
    far = std::make_unique<Teleoperator>(hidden, 99);
    ImpairedChannel out(bad, 1), back(bad, 2);
    PacketBytes bytes;
    Packet answer;
    for (int i = 0; i < samples + 600; ++i) {
      const std::int64_t now = 1'000'000LL * i;
      if (i < samples) out.push(now, write_packet(near->move(motion(i))));
      while (out.pop(now, bytes))
        if (far && far->receive(now, bytes, answer)) back.push(now, write_packet(answer));
      while (back.pop(now, bytes)) near->receive(bytes);
      if (meddle) meddle(i, far, hidden);
    }
  }
  ForceLoop hidden{body(model_of(2.2e4, 6e3))};
  UnitResponse response{body(model_of(1, 0)), {0.1}};
  std::unique_ptr<Operator> near;
  std::unique_ptr<Teleoperator> far;
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
  EXPECT_GT(run.far->counts().stale, 0);
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
  const TwoEnds run({0.01, 0, 0, 0, 0}, 4000,
                    [](int i, std::unique_ptr<Teleoperator>& far, ToolLoop& hidden) {
                      if (i == 1000) far.reset();
                      if (i == 1800) far = std::make_unique<Teleoperator>(hidden, 100);
                    });
  EXPECT_EQ(run.near->counts().peers, 2);
  EXPECT_TRUE(run.near->predicts());
  EXPECT_TRUE(run.near->record()[900].answered);
  EXPECT_FALSE(run.near->record()[1500].answered);
  EXPECT_TRUE(run.near->record()[2500].answered);
}

TEST(Teleoperator, ServesOneOperatorUntilItIsSilent) {
  ForceLoop hidden(body(model_of(2e4, 0)));
  Teleoperator far(hidden, 1);
  Packet motion_packet, answer;
  motion_packet.sender = 5;
  motion_packet.number = 1;
  motion_packet.first = {0.04, 0.04, 0.04};
  EXPECT_TRUE(far.receive(0, write_packet(motion_packet), answer));
  EXPECT_FALSE(far.receive(0, write_packet(motion_packet), answer));  // again
  motion_packet.sender = 6;
  EXPECT_FALSE(far.receive(Teleoperator::kSilence / 2, write_packet(motion_packet), answer));
  EXPECT_TRUE(far.receive(Teleoperator::kSilence, write_packet(motion_packet), answer));
  EXPECT_EQ(far.counts().stale, 1);
  EXPECT_EQ(far.counts().foreign, 1);
  EXPECT_EQ(far.counts().peers, 2);
}

TEST(Packets, AreReadAsTheyAreWritten) {
  Packet p;
  p.kind = Packet::Kind::kForce;
  p.sender = 0x1234567890ABCDEF;
  p.number = 7;
  p.press = -3;
  p.in_air = true;
  p.answers = 5;
  p.t = 1.25;
  p.first = {1, -2, 3};
  p.second = {0.1, 0.2, -0.3};
  Packet back;
  ASSERT_EQ(read_packet(write_packet(p), back), PacketFault::kNone);
  EXPECT_EQ(back.kind, p.kind);
  EXPECT_EQ(back.sender, p.sender);
  EXPECT_EQ(back.number, p.number);
  EXPECT_EQ(back.press, p.press);
  EXPECT_EQ(back.in_air, p.in_air);
  EXPECT_EQ(back.answers, p.answers);
  EXPECT_EQ(back.t, p.t);
  EXPECT_EQ(back.first, p.first);
  EXPECT_EQ(back.second, p.second);
  p.first.x() = std::nan("");
  EXPECT_EQ(read_packet(write_packet(p), back), PacketFault::kMalformed);
}

// A million damaged packets: bits turned, cut, prolonged, noise. None counts as one, and neither
// end changes.
TEST(Packets, AMillionDamagedOnesChangeNothing) {
  ForceLoop hidden(body(model_of(2e4, 0)));
  Teleoperator far(hidden, 1);
  UnitResponse response(body(model_of(1, 0)), {});
  Operator near(response, 17, {}, 10);
  Packet answer;
  const PacketBytes first = write_packet(near.move(motion(300)));
  ASSERT_TRUE(far.receive(0, first, answer));
  near.receive(write_packet(answer));
  const Vec3 measured = near.measured();
  Random random(11);
  std::array<unsigned char, 128> bytes{};
  long taken = 0;
  for (int i = 0; i < 1'000'000; ++i) {
    answer.number = static_cast<std::uint32_t>(i + 2);
    const PacketBytes good = i % 2 == 0 ? first : write_packet(answer);
    std::copy(good.begin(), good.end(), bytes.begin());
    std::size_t size = good.size();
    const auto kind = random.integer(4);
    if (kind == 0) size = random.integer(bytes.size());
    if (kind == 1)
      for (std::size_t k = 4; k < size; ++k)
        bytes[k] = static_cast<unsigned char>(random.integer(256));
    if (size == good.size())
      for (std::uint64_t k = 0; k <= random.integer(6); ++k)
        bytes[random.integer(size)] ^= static_cast<unsigned char>(1U << random.integer(8));
    if (size == good.size() && std::equal(good.begin(), good.end(), bytes.begin())) continue;
    Packet ignored;
    taken += far.receive(0, {bytes.data(), size}, ignored) ? 1 : 0;
    near.receive({bytes.data(), size});
  }
  EXPECT_EQ(taken, 0);
  EXPECT_EQ(far.counts().taken, 1);
  EXPECT_EQ(near.counts().taken, 1);
  EXPECT_EQ(near.measured(), measured);
  EXPECT_GT(far.counts().malformed, 100'000);
  EXPECT_GT(far.counts().foreign, 100'000);
}

TEST(ImpairedChannel, DelaysLosesDoublesAndReordersAsAsked) {
  ImpairedChannel channel({0.1, 0.02, 0.1, 0.05, 0.2}, 3);
  PacketBytes bytes{};
  long got = 0, early = 0, overtaken = 0;
  int newest = -1;
  for (int i = 0; i < 50'000; ++i) {
    const std::int64_t now = 1'000'000LL * i;
    std::copy_n(reinterpret_cast<const unsigned char*>(&i), sizeof i, bytes.begin());
    channel.push(now, bytes);
    PacketBytes out;
    while (channel.pop(now, out)) {
      int number = 0;
      std::copy_n(out.begin(), sizeof number, reinterpret_cast<unsigned char*>(&number));
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
