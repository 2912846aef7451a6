// How two sides with the same key come to a session: each proves that it has the key, for this
// session alone, before anything that it says counts.
#pragma once

#include <optional>

#include "link/session.h"
#include "link/terms.h"

namespace hapsim {

// Hello, of the operator, and welcome, of the teleoperator, are of one form, so that no answer is
// longer than what it answers: 216 bytes
//   header (number 0); verdict (32 bits: Verdict; of a hello zero), 4 zero bytes; name of the hello
//   (16 random bytes, in the welcome those that it answers); X25519 key (32); Terms (112);
//   tag (32): HMAC-SHA-512-256 of all before it, of a welcome also of the hello's tag, by the keys
//   1 and 2 derived from the link's.
// Session keys: BLAKE2b by the derived key 3 of the shared X25519 secret, the hello's tag and the
// welcome's (a handshake of Noise's pattern NNpsk0). Keys of past sessions cannot be had from the
// link's key.
constexpr std::size_t kHandshakeBytes = kHeaderBytes + 8 + 16 + 32 + Terms::kBytes + 32;

enum class Verdict : std::uint32_t {
  kWelcome = 0,
  kMismatch = 1,  // of the Terms
  kBusy = 2       // another operator is being served
};

struct HandshakeMessage {
  std::uint32_t verdict = 0;
  std::array<unsigned char, 16> name{};
  Secret open{};
  Terms terms;
  Tag tag{};
};
// The content of a hello or welcome of the right size and header, without looking at its tag.
HandshakeMessage read_handshake(Bytes bytes) noexcept;

// The operator's: a hello, and what its welcome leads to.
class OperatorHandshake {
 public:
  OperatorHandshake(const Secret& key, const Terms& terms);
  const Datagram& hello() const { return hello_; }
  // Whether it is the teleoperator's answer to this hello; its verdict and terms then.
  bool read_welcome(Bytes bytes, HandshakeMessage& welcome) const noexcept;
  std::optional<SessionKeys> keys(const HandshakeMessage& welcome) const noexcept;

 private:
  Secret key_;
  Exchange exchange_;
  Datagram hello_;
  Tag tag_{};
};

// The teleoperator's: whether a datagram is a hello of somebody with the key, and the welcome to
// it.
class TeleoperatorHandshake {
 public:
  TeleoperatorHandshake(const Secret& key, const Terms& terms) : key_(key), terms_(terms) {}
  bool read_hello(Bytes bytes, HandshakeMessage& hello) const noexcept;
  // Keys where the verdict is kWelcome and the other's key is good.
  std::optional<SessionKeys> welcome(const HandshakeMessage& hello, Verdict verdict,
                                     Datagram& welcome) const noexcept;
  const Terms& terms() const { return terms_; }

 private:
  Secret key_;
  Terms terms_;
};

}  // namespace hapsim
