#include "link/session.h"

#include <limits>

#include "link/bytes.h"
#include "link/handshake.h"

namespace hapsim {
namespace {

constexpr std::array<unsigned char, 4> kMagic{'H', 'S', 'L', '2'};

}  // namespace

Message message_of(Bytes bytes) noexcept {
  if (bytes.size() < kHeaderBytes || std::memcmp(bytes.data(), kMagic.data(), 4) != 0 ||
      bytes[5] != 0 || bytes[6] != 0 || bytes[7] != 0)
    return Message::kNone;
  const auto message = static_cast<Message>(bytes[4]);
  switch (message) {
    case Message::kHello:
    case Message::kWelcome:
      return bytes.size() == kHandshakeBytes ? message : Message::kNone;
    case Message::kPacket:
      return bytes.size() == kSealedBytes ? message : Message::kNone;
    default:
      return Message::kNone;
  }
}

void put_header(unsigned char* at, Message message, std::uint64_t number) noexcept {
  put(at, kMagic);
  put(at, std::array<unsigned char, 4>{static_cast<unsigned char>(message)});
  put(at, number);
}

bool Session::write(const Packet& packet, Datagram& datagram) noexcept {
  if (next_ == std::numeric_limits<std::uint64_t>::max()) return false;
  const PacketBytes text = write_packet(packet);
  put_header(datagram.bytes.data(), Message::kPacket, next_);
  seal(send_, next_, {datagram.bytes.data(), kHeaderBytes}, text,
       datagram.bytes.data() + kHeaderBytes);
  datagram.size = kSealedBytes;
  ++next_;
  return true;
}

Session::Result Session::read(Bytes bytes, Packet& packet, bool& is_newest) noexcept {
  if (message_of(bytes) != Message::kPacket) return Result::kForeign;
  const unsigned char* at = bytes.data() + 8;
  const auto number = take<std::uint64_t>(at);
  // Before the seal is looked at, which costs more: a flood of repeated ones is cheap to refuse.
  if (!window_.is_new(number)) return Result::kRepeated;
  PacketBytes text;
  if (!open_seal(receive_, number, bytes.first(kHeaderBytes), bytes.subspan(kHeaderBytes),
                 text.data()))
    return Result::kForeign;
  // It is the peer's: whatever it holds, it is not taken again.
  is_newest = number > window_.newest();
  window_.take(number);
  return read_packet(text, packet) ? Result::kTaken : Result::kMalformed;
}

}  // namespace hapsim
