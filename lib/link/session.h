// Packets of one session, sealed by its own keys: nobody else can read, make or repeat one.
#pragma once

#include "link/packets.h"
#include "link/replay_window.h"
#include "link/seal.h"

namespace hapsim {

enum class Side { kOperator, kTeleoperator };

// 128 bytes: "HSL2", the byte 3, three of zero, the number (64 bits), the packet sealed.
constexpr std::size_t kHeaderBytes = 16;
constexpr std::size_t kSealedBytes = kHeaderBytes + kPacketBytes + kSealBytes;
enum class Message : unsigned char { kNone = 0, kHello = 1, kWelcome = 2, kPacket = 3 };
// What a datagram says that it is, by its first bytes and its size.
Message message_of(Bytes bytes) noexcept;
void put_header(unsigned char* at, Message message, std::uint64_t number) noexcept;

class Session {
 public:
  // `first`: the number of its first packet, for tests of what happens near the last one.
  Session(const SessionKeys& keys, Side side, std::uint64_t first = 1)
      : send_(side == Side::kOperator ? keys.to_teleoperator : keys.to_operator),
        receive_(side == Side::kOperator ? keys.to_operator : keys.to_teleoperator),
        next_(first) {}

  // False where the numbers are used up: shake hands again. (A thousand a second last for 500
  // million years.)
  bool write(const Packet& packet, Datagram& datagram) noexcept;

  enum class Result { kTaken, kForeign, kRepeated, kMalformed };
  // `is_newest`: none with a higher number has come before.
  Result read(Bytes bytes, Packet& packet, bool& is_newest) noexcept;

 private:
  Secret send_, receive_;
  std::uint64_t next_;
  ReplayWindow window_;
};

}  // namespace hapsim
