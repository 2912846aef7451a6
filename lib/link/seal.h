// The cryptography of a link, by libsodium: random bytes, tags, key exchange, sealed boxes.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "link/datagram.h"

namespace hapsim {

using Secret = std::array<unsigned char, 32>;
using Tag = std::array<unsigned char, 32>;
constexpr std::size_t kSealBytes = 16;  // that a sealed text is longer

void draw_random(std::span<unsigned char> bytes) noexcept;

// HMAC-SHA-512-256. Compared in constant time.
Tag tag_of(const Secret& key, Bytes text) noexcept;
bool is_tag_of(Bytes tag, const Secret& key, Bytes text) noexcept;

// One of many keys out of one (BLAKE2b).
Secret derive(const Secret& key, std::uint64_t which) noexcept;

// X25519, for one session.
struct Exchange {
  Secret secret{}, open{};
  static Exchange draw() noexcept;
};
// Of a session, from the shared secret of both exchanges, the link's own key and what was said in
// the handshake; none where `theirs` is no good point. Both sides get the same two.
struct SessionKeys {
  Secret to_teleoperator{}, to_operator{};
};
std::optional<SessionKeys> session_keys(const Secret& key, const Exchange& own,
                                        const Secret& theirs, Bytes said) noexcept;

// ChaCha20-Poly1305 (RFC 8439). A number is used once with a key. `header` is not sealed, but
// cannot be changed either.
void seal(const Secret& key, std::uint64_t number, Bytes header, Bytes text,
          unsigned char* sealed) noexcept;
bool open_seal(const Secret& key, std::uint64_t number, Bytes header, Bytes sealed,
               unsigned char* text) noexcept;

// A fingerprint of 16 bytes by which two sides tell whether they have the same (BLAKE2b).
using Fingerprint = std::array<unsigned char, 16>;
Fingerprint fingerprint_of(Bytes text) noexcept;

}  // namespace hapsim
