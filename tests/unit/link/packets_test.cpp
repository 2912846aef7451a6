// Packets, their seal and their numbers.
#include "link/packets.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/random.h"
#include "link/session.h"

namespace hapsim {
namespace {

Packet any_packet() {
  Packet p;
  p.kind = Packet::Kind::kForce;
  p.number = (std::uint64_t{1} << 40) + 7;
  p.press = -3;
  p.in_air = true;
  p.flags = 5;
  p.answers = 5;
  p.t = 1.25;
  p.first = {1, -2, 3};
  p.second = {0.1, 0.2, -0.3};
  p.energy = 0.25;
  return p;
}

TEST(Packets, AreReadAsTheyAreWritten) {
  const Packet p = any_packet();
  Packet back;
  ASSERT_TRUE(read_packet(write_packet(p), back));
  EXPECT_EQ(write_packet(back), write_packet(p));
  EXPECT_EQ(back.number, p.number);
  EXPECT_EQ(back.first, p.first);
  EXPECT_EQ(back.energy, p.energy);
}

TEST(Packets, WhatIsNoNumberPassesInNoField) {
  const double inf = std::numeric_limits<double>::infinity();
  for (const auto kind : {Packet::Kind::kMotion, Packet::Kind::kForce})
    for (const double bad : {std::nan(""), inf, -inf, 1e300, -1e300})
      for (int field = 0; field < 8; ++field) {
        Packet p = any_packet(), back;
        p.kind = kind;
        if (kind == Packet::Kind::kMotion) p.answers = 0;
        ASSERT_TRUE(read_packet(write_packet(p), back));
        if (field < 3)
          p.first[field] = bad;
        else if (field < 6)
          p.second[field - 3] = bad;
        else
          (field == 6 ? p.t : p.energy) = bad;
        EXPECT_FALSE(read_packet(write_packet(p), back)) << "field " << field << " " << bad;
      }
}

struct Sealed {
  Sealed() {
    draw_random(keys.to_operator);
    draw_random(keys.to_teleoperator);
  }
  SessionKeys keys;
};

TEST(Session, APacketIsTakenOnceAndByItsPeerAlone) {
  const Sealed s, other;
  Session near(s.keys, Side::kOperator), far(s.keys, Side::kTeleoperator),
      stranger(other.keys, Side::kTeleoperator);
  Datagram d;
  ASSERT_TRUE(near.write(any_packet(), d));
  EXPECT_EQ(d.size, kSealedBytes);
  Packet back;
  bool newest = false;
  EXPECT_EQ(stranger.read(d.view(), back, newest), Session::Result::kForeign);
  EXPECT_EQ(near.read(d.view(), back, newest), Session::Result::kForeign) << "its own, sent back";
  EXPECT_EQ(far.read(d.view(), back, newest), Session::Result::kTaken);
  EXPECT_TRUE(newest);
  EXPECT_EQ(write_packet(back), write_packet(any_packet()));
  EXPECT_EQ(far.read(d.view(), back, newest), Session::Result::kRepeated);
}

TEST(Session, OvertakenPacketsAreTakenWithinTheWindow) {
  const Sealed s;
  Session near(s.keys, Side::kOperator), far(s.keys, Side::kTeleoperator);
  std::vector<Datagram> sent(3000);
  for (Datagram& d : sent) ASSERT_TRUE(near.write(any_packet(), d));
  Packet back;
  bool newest = false;
  EXPECT_EQ(far.read(sent[1500].view(), back, newest), Session::Result::kTaken);
  EXPECT_EQ(far.read(sent[1499].view(), back, newest), Session::Result::kTaken);
  EXPECT_FALSE(newest);
  EXPECT_EQ(far.read(sent[1500 - 1023].view(), back, newest), Session::Result::kTaken);
  EXPECT_EQ(far.read(sent[1500 - 1024].view(), back, newest), Session::Result::kRepeated);
  // All of them in any order, twice: each at most once.
  Random random(4);
  long taken = 0;
  for (int i = 0; i < 20000; ++i)
    taken += far.read(sent[random.integer(3000)].view(), back, newest) == Session::Result::kTaken;
  for (const Datagram& d : sent)
    taken += far.read(d.view(), back, newest) == Session::Result::kTaken;
  EXPECT_LE(taken, 3000 - 3);
  EXPECT_EQ(far.read(sent[2999].view(), back, newest), Session::Result::kRepeated);
}

TEST(Session, NumbersGoOnBeyond32BitsAndEndAtTheLast) {
  const Sealed s;
  const std::uint64_t last = std::numeric_limits<std::uint64_t>::max();
  for (const std::uint64_t first : {(std::uint64_t{1} << 32) - 3, last - 3}) {
    Session near(s.keys, Side::kOperator, first), far(s.keys, Side::kTeleoperator);
    Datagram d;
    Packet back;
    bool newest = false;
    int written = 0;
    for (; written < 8 && near.write(any_packet(), d); ++written)
      EXPECT_EQ(far.read(d.view(), back, newest), Session::Result::kTaken);
    EXPECT_EQ(written, first > last / 2 ? 3 : 8) << "no number is used twice";
  }
}

// A million damaged datagrams: bits turned, cut, prolonged, noise.
TEST(Session, AMillionDamagedDatagramsAreNone) {
  const Sealed s;
  Session near(s.keys, Side::kOperator), far(s.keys, Side::kTeleoperator);
  Random random(11);
  Datagram good;
  std::array<unsigned char, 160> bytes{};
  Packet back;
  bool newest = false;
  for (int i = 0; i < 1'000'000; ++i) {
    if (i % 1000 == 0) {
      ASSERT_TRUE(near.write(any_packet(), good));
    }
    std::copy_n(good.bytes.begin(), good.size, bytes.begin());
    std::size_t size = good.size;
    const auto kind = random.integer(4);
    if (kind == 0) size = random.integer(bytes.size());
    if (kind == 1)
      for (std::size_t k = 4; k < size; ++k)
        bytes[k] = static_cast<unsigned char>(random.integer(256));
    if (size == good.size)
      for (std::uint64_t k = 0; k <= random.integer(6); ++k)
        bytes[random.integer(size)] ^= static_cast<unsigned char>(1U << random.integer(8));
    if (size == good.size && std::equal(bytes.begin(), bytes.begin() + 128, good.bytes.begin()))
      continue;
    ASSERT_NE(far.read({bytes.data(), size}, back, newest), Session::Result::kTaken);
  }
  EXPECT_EQ(far.read(good.view(), back, newest), Session::Result::kTaken)
      << "and the true one is taken after all of them";
}

}  // namespace
}  // namespace hapsim
