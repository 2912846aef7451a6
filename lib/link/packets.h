// What an operator and a teleoperator send each other.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "base/vec3.h"

namespace hapsim {

// 96 bytes, little-endian, without padding; i: 32 bits, l: 64 bits, the rest IEEE 754 of 64 bits:
//   i magic "HSL1", i kind (1: motion, 2: force), l sender (drawn at its start), i number (from 1),
//   i press, i contact (0: in the air), i answers (of a force: the motion's number), t,
//   x y z (motion: contact point; force: fx fy fz), ux uy uz (force: zero), l check: FNV-1a of the
//   bytes before it.
struct Packet {
  enum class Kind : std::int32_t { kMotion = 1, kForce = 2 };
  Kind kind = Kind::kMotion;
  std::uint64_t sender = 0;
  std::uint32_t number = 0;
  std::int32_t press = 0;
  bool in_air = false;
  std::uint32_t answers = 0;
  double t = 0;                // of the motion, by the operator's clock [s]
  Vec3 first = Vec3::Zero();   // contact point [m], or force [N]
  Vec3 second = Vec3::Zero();  // displacement [m]
};
constexpr std::size_t kPacketBytes = 96;
using PacketBytes = std::array<unsigned char, kPacketBytes>;
PacketBytes write_packet(const Packet& packet) noexcept;

enum class PacketFault {
  kNone,
  kForeign,    // not one of ours: size or magic
  kMalformed,  // ours, but damaged or out of all bounds
};
// Never throws, reads no byte beyond; `packet` is set only without fault.
PacketFault read_packet(std::span<const unsigned char> bytes, Packet& packet) noexcept;

}  // namespace hapsim
