// The two ends of a closed link: datagrams in and out, packets of the one peer that has proved
// itself. Times are of any one clock that nobody sets [ns]; addresses are whatever the caller takes
// for one. Nothing allocates, throws or asks the system, but for random bytes of a handshake.
#pragma once

#include <optional>
#include <string>

#include "link/handshake.h"
#include "link/udp.h"

namespace hapsim {

// What came in, and what was dropped.
struct PacketCounts {
  long taken = 0;
  long stale = 0;      // repeated, or older than what is there already
  long foreign = 0;    // of nobody with the key, or of no session
  long malformed = 0;  // of the peer, and impossible
  long refused = 0;    // hellos of somebody with the key: busy, or other terms
  long sessions = 0;   // that were begun: a peer that returns is one more
  std::string summary() const;
};

struct Received {
  Packet packet;
  bool is_newest = false;  // none of a higher number has come before
  bool is_anew = false;    // the first of a new session
};

// Speaks first, and again whenever nothing is heard, until there is a session.
class OperatorEnd {
 public:
  OperatorEnd(const Secret& key, const Terms& terms, std::uint64_t first_number = 1);

  // To be called about every millisecond: whether `out` is to be sent now.
  bool tick(std::int64_t now, Datagram& out) noexcept;
  // A datagram from the teleoperator's address.
  std::optional<Received> receive(std::int64_t now, Bytes bytes) noexcept;
  // A motion as a datagram; false without a session.
  bool write(const Packet& packet, Datagram& out) noexcept;

  bool is_linked() const { return session_.has_value(); }
  // The teleoperator has the key and refuses for good: what keeps the sides apart; else empty.
  const std::string& refusal() const { return refusal_; }
  const Terms& theirs() const { return theirs_; }
  const PacketCounts& counts() const { return counts_; }
  std::int64_t heard() const { return heard_; }  // when, of a sealed packet

  static constexpr std::int64_t kAgain = 100'000'000;       // between two hellos
  static constexpr std::int64_t kSilence = 1'500'000'000;   // after which it speaks again
  static constexpr std::int64_t kOneHello = 5'000'000'000;  // then another one: the way may be long

 private:
  Secret key_;
  Terms ours_, theirs_;
  std::uint64_t first_number_;
  OperatorHandshake handshake_;
  std::optional<Session> session_;
  bool fresh_ = true, anew_ = false;  // the hello has not been answered; nothing came since
  std::int64_t heard_ = 0, spoken_ = 0, drawn_ = 0;
  std::string refusal_;
  PacketCounts counts_;
};

// Answers hellos of those with the key, and serves one of them at a time.
class TeleoperatorEnd {
 public:
  TeleoperatorEnd(const Secret& key, const Terms& terms, std::uint64_t first_number = 1);

  struct Answer {
    std::optional<Received> received;
    bool reply = false;  // `out` goes back to where this came from, at once
  };
  Answer receive(std::int64_t now, const UdpAddress& from, Bytes bytes, Datagram& out) noexcept;
  // An answer to the peer; false where there is none.
  bool write(const Packet& packet, Datagram& out) noexcept;
  // Where the peer's newest packet came from.
  const UdpAddress& peer() const { return peer_; }
  bool is_linked() const { return session_.has_value(); }
  std::int64_t heard() const { return heard_; }
  const PacketCounts& counts() const { return counts_; }
  // Why the last hello of somebody with the key was refused; empty where it was not.
  const std::string& refusal() const { return refusal_; }

  static constexpr std::int64_t kSilence = 500'000'000;  // then another operator is served
  static constexpr std::int64_t kSparse = 2'000'000;     // between two handshakes

 private:
  bool is_served(std::int64_t now) const { return session_ && now - heard_ < kSilence; }
  Answer greet(std::int64_t now, const HandshakeMessage& hello, Datagram& out) noexcept;

  TeleoperatorHandshake handshake_;
  std::uint64_t first_number_;
  std::optional<Session> session_, coming_;  // coming: its hello was answered, it has not spoken
  Tag hello_{}, over_{};                     // of the hello that was answered; of the session's
  Datagram welcome_;
  UdpAddress peer_;
  std::int64_t heard_ = 0, greeted_ = 0;
  bool has_greeted_ = false;
  std::string refusal_;
  PacketCounts counts_;
};

}  // namespace hapsim
