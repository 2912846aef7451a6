#include "link/packets.h"

#include <cmath>

#include "link/bytes.h"

namespace hapsim {
namespace {

constexpr double kLongest = 10, kStrongest = 1e5, kLatest = 1e9;  // [m], [N], [s]
constexpr double kMostEnergy = 1e9;                               // [J]

// False of what is no number, too.
bool within(const Vec3& v, double most) {
  return std::abs(v.x()) < most && std::abs(v.y()) < most && std::abs(v.z()) < most;
}

}  // namespace

PacketBytes write_packet(const Packet& packet) noexcept {
  PacketBytes bytes{};
  unsigned char* at = bytes.data();
  put(at, static_cast<std::int32_t>(packet.kind));
  put(at, packet.press);
  put(at, std::int32_t{packet.in_air ? 0 : 1});
  put(at, packet.flags);
  put(at, packet.number);
  put(at, packet.answers);
  put(at, packet.t);
  put_vector(at, packet.first);
  put_vector(at, packet.second);
  put(at, packet.energy);
  return bytes;
}

bool read_packet(Bytes bytes, Packet& packet) noexcept {
  if (bytes.size() != kPacketBytes) return false;
  const unsigned char* at = bytes.data();
  Packet p;
  const auto kind = take<std::int32_t>(at);
  p.press = take<std::int32_t>(at);
  const auto contact = take<std::int32_t>(at);
  p.flags = take<std::int32_t>(at);
  p.number = take<std::uint64_t>(at);
  p.answers = take<std::uint64_t>(at);
  p.t = take<double>(at);
  p.first = take_vector(at);
  p.second = take_vector(at);
  p.energy = take<double>(at);
  const bool force = kind == static_cast<std::int32_t>(Packet::Kind::kForce);
  if ((!force && kind != static_cast<std::int32_t>(Packet::Kind::kMotion)) ||
      (contact != 0 && contact != 1) || p.flags < 0 || p.number == 0 || (p.answers == 0) == force ||
      !(std::abs(p.t) < kLatest) || !within(p.first, force ? kStrongest : kLongest) ||
      !within(p.second, force ? kStrongest : kLongest) || !(std::abs(p.energy) < kMostEnergy))
    return false;
  p.kind = static_cast<Packet::Kind>(kind);
  p.in_air = contact == 0;
  packet = p;
  return true;
}

}  // namespace hapsim
