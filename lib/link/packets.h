// What an operator and a teleoperator send each other, once they have shaken hands.
#pragma once

#include <array>
#include <cstdint>

#include "base/vec3.h"
#include "link/datagram.h"

namespace hapsim {

// Sealed as a whole (link/session.h): 96 bytes, little-endian, without padding; i: 32 bits, l: 64
// bits, the rest IEEE 754 of 64 bits:
//   i kind (1: motion, 2: force), i press, i contact (0: in the air), i flags (of a force: Safety
//   at the teleoperator), l number (from 1), l answers (of a force: the motion's number), t,
//   x y z (motion: contact point; force: fx fy fz), ux uy uz (of a force: the unlimited one),
//   energy (that has gone in at this side) [J].
struct Packet {
  enum class Kind : std::int32_t { kMotion = 1, kForce = 2 };
  Kind kind = Kind::kMotion;
  std::int32_t press = 0;
  bool in_air = false;
  std::int32_t flags = 0;
  std::uint64_t number = 0, answers = 0;
  double t = 0;                // of the motion, by the operator's clock [s]
  Vec3 first = Vec3::Zero();   // contact point [m], or force [N]
  Vec3 second = Vec3::Zero();  // displacement [m], or unlimited force [N]
  double energy = 0;
};
constexpr std::size_t kPacketBytes = 96;
using PacketBytes = std::array<unsigned char, kPacketBytes>;
PacketBytes write_packet(const Packet& packet) noexcept;
// False where it is damaged or a number is out of all bounds, not finite or not in its range: none
// of them passes, in any field. Never throws; `packet` is set only when true.
bool read_packet(Bytes bytes, Packet& packet) noexcept;

}  // namespace hapsim
