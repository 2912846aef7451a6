// Who is answered, who is served, and what a stranger can do.
#include "link/ends.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <vector>

#include "expect_error.h"
#include "link/key_file.h"

namespace hapsim {
namespace {

constexpr Secret kKey{7, 7, 7}, kOther{8};
constexpr std::int64_t kMs = 1'000'000;

Terms terms() {
  Terms t;
  t.tool_radius = 0.004;
  t.high = {0.06, 0.05, 0.04};
  return t;
}

UdpAddress port(std::uint16_t number) {
  UdpAddress a;
  a.port = number;
  return a;
}

Packet motion(std::uint64_t number) {
  Packet p;
  p.number = number;
  return p;
}

struct Link {
  explicit Link(const Secret& near_key = kKey, const Terms& near_terms = terms())
      : near(near_key, near_terms), far(kKey, terms()) {}
  // A hello and its welcome; whether there was an answer.
  bool greet(OperatorEnd& who, std::int64_t now, std::uint16_t from = 1) {
    Datagram hello, welcome;
    if (!who.tick(now, hello)) return false;
    kept_hello = hello;
    const bool answered = far.receive(now, port(from), hello.view(), welcome).reply;
    if (answered) {
      EXPECT_LE(welcome.size, hello.size) << "no more than was asked";
      kept_welcome = welcome;
      who.receive(now, welcome.view());
    }
    return answered;
  }
  // Whether a motion is taken.
  bool move(OperatorEnd& who, std::int64_t now, std::uint64_t number, std::uint16_t from = 1) {
    Datagram d, out;
    if (!who.write(motion(number), d)) return false;
    kept = d;
    return far.receive(now, port(from), d.view(), out).received.has_value();
  }
  OperatorEnd near;
  TeleoperatorEnd far;
  Datagram kept_hello, kept_welcome, kept;
};

TEST(Ends, ShakeHandsAndExchange) {
  Link link;
  ASSERT_TRUE(link.greet(link.near, kMs));
  EXPECT_TRUE(link.near.is_linked());
  EXPECT_FALSE(link.far.is_linked()) << "not before the operator has spoken by the new keys";
  EXPECT_TRUE(link.move(link.near, 2 * kMs, 1));
  EXPECT_TRUE(link.far.is_linked());
  Packet force = motion(1);
  force.kind = Packet::Kind::kForce;
  force.answers = 1;
  Datagram d;
  ASSERT_TRUE(link.far.write(force, d));
  const auto got = link.near.receive(3 * kMs, d.view());
  ASSERT_TRUE(got);
  EXPECT_TRUE(got->is_anew);
  EXPECT_FALSE(link.near.receive(3 * kMs, d.view())) << "once";
  EXPECT_EQ(link.near.counts().stale, 1);
}

TEST(Ends, NobodyIsAnsweredWithoutTheKey) {
  Link link(kOther);
  for (int i = 1; i < 100; ++i) EXPECT_FALSE(link.greet(link.near, 200 * kMs * i));
  EXPECT_FALSE(link.near.is_linked());
  EXPECT_EQ(link.far.counts().foreign, 99);
  Datagram out;
  for (const std::size_t size : {0, 1, 15, 16, 128, 216, 256}) {
    const std::vector<unsigned char> zeros(size);
    EXPECT_FALSE(link.far.receive(0, port(1), zeros, out).reply);
  }
}

TEST(Ends, TermsThatDifferAreRefusedInWords) {
  const auto refusal = [](const std::function<void(Terms&)>& change) {
    Terms t = terms();
    change(t);
    Link link(kKey, t);
    EXPECT_TRUE(link.greet(link.near, kMs));
    EXPECT_FALSE(link.near.is_linked());
    EXPECT_FALSE(link.far.refusal().empty());
    return link.near.refusal();
  };
  EXPECT_EQ(refusal([](Terms& t) { t.version = 3; }), "its link has version 2 and this one 3");
  EXPECT_EQ(refusal([](Terms& t) { t.units[0] = 'k'; }), "its units are m,N,s and these k,N,s");
  EXPECT_EQ(refusal([](Terms& t) { t.tool_radius = 0.005; }),
            "its tool has a radius of 4 mm and this one 5 mm");
  EXPECT_NE(refusal([](Terms& t) { t.high.z() = 0.06; }).find("its body is another"),
            std::string::npos);
  EXPECT_NE(refusal([](Terms& t) { t.low.x() = std::nan(""); }).find("its body is another"),
            std::string::npos);
  Terms a = terms(), b = terms();
  a.model[0] = 1;
  EXPECT_EQ(mismatch(a, b), Mismatch::kNone) << "of no importance to one side";
  b.model[0] = 2;
  EXPECT_EQ(mismatch(a, b), Mismatch::kModel);
  b = terms();
  b.high.z() += 0.002;
  EXPECT_EQ(mismatch(terms(), b), Mismatch::kNone) << "a scan of the same body";
}

TEST(Ends, ARepeatedHelloOrPacketChangesNothing) {
  Link link;
  link.greet(link.near, kMs);
  link.move(link.near, 2 * kMs, 1);
  const Datagram hello = link.kept_hello, packet = link.kept;
  Datagram out;
  for (int i = 0; i < 1000; ++i) {
    EXPECT_FALSE(link.far.receive(3 * kMs, port(666), hello.view(), out).reply);
    EXPECT_FALSE(link.far.receive(3 * kMs, port(666), packet.view(), out).received);
  }
  EXPECT_EQ(link.far.peer().port, 1) << "nor does the address";
  EXPECT_TRUE(link.move(link.near, 4 * kMs, 2));
}

TEST(Ends, ALostWelcomeIsGivenAgain) {
  Link link;
  Datagram hello, welcome, again;
  link.near.tick(kMs, hello);
  EXPECT_TRUE(link.far.receive(kMs, port(1), hello.view(), welcome).reply);
  EXPECT_TRUE(link.near.tick(150 * kMs, hello));
  EXPECT_TRUE(link.far.receive(150 * kMs, port(1), hello.view(), again).reply);
  EXPECT_EQ(welcome.bytes, again.bytes);
  link.near.receive(151 * kMs, again.view());
  EXPECT_TRUE(link.move(link.near, 152 * kMs, 1));
}

TEST(Ends, TheAddressChangesAfterProofAlone) {
  Link link;
  link.greet(link.near, kMs);
  link.move(link.near, 2 * kMs, 1);
  EXPECT_TRUE(link.move(link.near, 3 * kMs, 2, 99));
  EXPECT_EQ(link.far.peer().port, 99);
  // An old packet that arrives late from where it was sent does not turn it back.
  Datagram late, newer, out;
  link.near.write(motion(3), late);
  link.near.write(motion(4), newer);
  link.far.receive(4 * kMs, port(99), newer.view(), out);
  EXPECT_TRUE(link.far.receive(4 * kMs, port(1), late.view(), out).received);
  EXPECT_EQ(link.far.peer().port, 99);
}

TEST(Ends, ASecondOperatorWaitsForTheFirstToBeSilent) {
  Link link;
  OperatorEnd second(kKey, terms());
  link.greet(link.near, kMs);
  link.move(link.near, 2 * kMs, 1);
  EXPECT_TRUE(link.greet(second, 10 * kMs, 2));
  EXPECT_FALSE(second.is_linked());
  EXPECT_EQ(link.far.refusal(), "another operator is served");
  EXPECT_TRUE(second.refusal().empty()) << "it may ask again";
  EXPECT_TRUE(link.move(link.near, 300 * kMs, 2));
  link.greet(second, 310 * kMs, 2);
  EXPECT_FALSE(second.is_linked());
  link.greet(second, 900 * kMs, 2);
  ASSERT_TRUE(second.is_linked());
  EXPECT_TRUE(link.move(second, 901 * kMs, 1, 2));
  EXPECT_FALSE(link.move(link.near, 902 * kMs, 3)) << "the first is out";
  EXPECT_EQ(link.far.counts().sessions, 2);
}

TEST(Ends, ARestartOfEitherSideIsANewSession) {
  Link link;
  link.greet(link.near, kMs);
  link.move(link.near, 2 * kMs, 1);
  link.far = TeleoperatorEnd(kKey, terms());
  EXPECT_FALSE(link.move(link.near, 3 * kMs, 2)) << "it knows no session";
  Datagram none;
  EXPECT_FALSE(link.near.tick(100 * kMs, none)) << "heard a moment ago";
  EXPECT_TRUE(link.greet(link.near, 2000 * kMs));
  EXPECT_TRUE(link.move(link.near, 2001 * kMs, 3));
  link.near = OperatorEnd(kKey, terms());
  EXPECT_TRUE(link.greet(link.near, 2600 * kMs));
  EXPECT_TRUE(link.move(link.near, 2601 * kMs, 1));
}

TEST(Ends, WhenNumbersAreUsedUpHandsAreShakenAgain) {
  Link link;
  link.near = OperatorEnd(kKey, terms(), std::numeric_limits<std::uint64_t>::max() - 3);
  link.greet(link.near, kMs);
  std::int64_t now = 2 * kMs;
  int taken = 0;
  for (int i = 1; i < 1000; ++i, now += kMs) {
    taken += link.move(link.near, now, static_cast<std::uint64_t>(i));
    if (!link.near.is_linked()) link.greet(link.near, now);
  }
  EXPECT_GT(taken, 300) << "after the silence that lets another session begin";
  EXPECT_EQ(link.far.counts().sessions, 2);
}

TEST(Ends, HellosOfOldAreSparse) {
  std::vector<Datagram> old;
  for (int i = 0; i < 50; ++i) old.push_back(OperatorHandshake(kKey, terms()).hello());
  Link link;
  link.greet(link.near, kMs);
  link.move(link.near, 2 * kMs, 1);
  Datagram out;
  int answered = 0;
  for (int i = 0; i < 1000; ++i)
    answered +=
        link.far.receive(5 * kMs, port(666), old[static_cast<std::size_t>(i % 50)].view(), out)
            .reply;
  EXPECT_LE(answered, 1);
  EXPECT_TRUE(link.move(link.near, 6 * kMs, 2)) << "who is served goes on";
}

TEST(KeyFile, IsMadeOnceAndReadBack) {
  const std::string path = ::testing::TempDir() + "hapsim-link.key";
  std::filesystem::remove(path);
  make_key(path);
  const Secret key = read_key(path);
  EXPECT_NE(key, public_key());
  EXPECT_NE(error_of([&] { make_key(path); }, ExitCode::kIo).find("is there already"),
            std::string::npos);
  EXPECT_EQ(read_key(path), key);
  std::filesystem::permissions(path, std::filesystem::perms::group_read,
                               std::filesystem::perm_options::add);
  EXPECT_NE(error_of([&] { read_key(path); }, ExitCode::kIo).find("chmod 600"), std::string::npos);
  std::filesystem::remove(path);
  const std::vector<std::string> bad{"",
                                     "abc",
                                     std::string(64, '0'),
                                     std::string(63, 'a'),
                                     std::string(63, 'a') + "g",
                                     std::string(70, 'a')};
  for (const std::string& text : bad) {
    std::ofstream(path) << text;
    std::filesystem::permissions(path, std::filesystem::perms::owner_read);
    EXPECT_NE(error_of([&] { read_key(path); }).find("this is no key"), std::string::npos) << text;
    std::filesystem::remove(path);
  }
}

}  // namespace
}  // namespace hapsim
