#include "link/packets.h"

#include <bit>
#include <cmath>
#include <cstring>

namespace hapsim {
namespace {

static_assert(std::endian::native == std::endian::little, "packets are little-endian");
constexpr std::array<unsigned char, 4> kMagic{'H', 'S', 'L', '1'};
constexpr double kLongest = 10, kStrongest = 1e5, kLatest = 1e9;  // [m], [N], [s]

// Fowler, Noll and Vo, 64 bits.
std::uint64_t check_of(const unsigned char* bytes, std::size_t size) noexcept {
  std::uint64_t hash = 14695981039346656037ULL;
  for (std::size_t i = 0; i < size; ++i) hash = (hash ^ bytes[i]) * 1099511628211ULL;
  return hash;
}

template <class T>
void put(unsigned char*& at, T value) noexcept {
  std::memcpy(at, &value, sizeof value);
  at += sizeof value;
}
template <class T>
void take(const unsigned char*& at, T& value) noexcept {
  std::memcpy(&value, at, sizeof value);
  at += sizeof value;
}

}  // namespace

PacketBytes write_packet(const Packet& packet) noexcept {
  PacketBytes bytes{};
  unsigned char* at = bytes.data();
  for (const unsigned char c : kMagic) put(at, c);
  put(at, static_cast<std::int32_t>(packet.kind));
  put(at, packet.sender);
  put(at, packet.number);
  put(at, packet.press);
  put(at, std::int32_t{packet.in_air ? 0 : 1});
  put(at, packet.answers);
  put(at, packet.t);
  for (const Vec3* v : {&packet.first, &packet.second})
    for (int k = 0; k < 3; ++k) put(at, (*v)[k]);
  put(at, check_of(bytes.data(), static_cast<std::size_t>(at - bytes.data())));
  return bytes;
}

PacketFault read_packet(std::span<const unsigned char> bytes, Packet& packet) noexcept {
  if (bytes.size() != kPacketBytes || std::memcmp(bytes.data(), kMagic.data(), 4) != 0)
    return PacketFault::kForeign;
  const unsigned char* at = bytes.data() + 4;
  Packet p;
  std::int32_t kind = 0, contact = 0;
  std::uint64_t check = 0;
  take(at, kind);
  take(at, p.sender);
  take(at, p.number);
  take(at, p.press);
  take(at, contact);
  take(at, p.answers);
  take(at, p.t);
  for (Vec3* v : {&p.first, &p.second})
    for (int k = 0; k < 3; ++k) take(at, (*v)[k]);
  const auto covered = static_cast<std::size_t>(at - bytes.data());
  take(at, check);
  if (check != check_of(bytes.data(), covered)) return PacketFault::kMalformed;
  const double most = kind == 1 ? kLongest : kStrongest;
  if ((kind != 1 && kind != 2) || (contact != 0 && contact != 1) || p.number == 0 ||
      !(std::abs(p.t) < kLatest) || !(p.first.cwiseAbs().maxCoeff() < most) ||
      !(p.second.cwiseAbs().maxCoeff() < kLongest))
    return PacketFault::kMalformed;
  p.kind = static_cast<Packet::Kind>(kind);
  p.in_air = contact == 0;
  packet = p;
  return PacketFault::kNone;
}

}  // namespace hapsim
