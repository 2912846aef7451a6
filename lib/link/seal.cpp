#include "link/seal.h"

#include <sodium.h>

#include "base/error.h"

namespace hapsim {
namespace {

// Before main() every use of it is safe, from any thread.
const bool kReady = sodium_init() >= 0;

std::array<unsigned char, crypto_aead_chacha20poly1305_ietf_NPUBBYTES> nonce_of(
    std::uint64_t number) {
  std::array<unsigned char, crypto_aead_chacha20poly1305_ietf_NPUBBYTES> nonce{};
  for (std::size_t i = 0; i < 8; ++i)
    nonce[4 + i] = static_cast<unsigned char>(number >> (8 * i) & 0xff);
  return nonce;
}

static_assert(crypto_auth_hmacsha512256_BYTES == sizeof(Tag) && crypto_scalarmult_BYTES == 32 &&
              crypto_kdf_KEYBYTES == 32 && crypto_aead_chacha20poly1305_ietf_KEYBYTES == 32 &&
              crypto_aead_chacha20poly1305_ietf_ABYTES == kSealBytes);

}  // namespace

void draw_random(std::span<unsigned char> bytes) noexcept {
  (void)kReady;
  randombytes_buf(bytes.data(), bytes.size());
}

Tag tag_of(const Secret& key, Bytes text) noexcept {
  Tag tag;
  crypto_auth_hmacsha512256(tag.data(), text.data(), text.size(), key.data());
  return tag;
}

bool is_tag_of(Bytes tag, const Secret& key, Bytes text) noexcept {
  return tag.size() == sizeof(Tag) &&
         crypto_auth_hmacsha512256_verify(tag.data(), text.data(), text.size(), key.data()) == 0;
}

Secret derive(const Secret& key, std::uint64_t which) noexcept {
  Secret derived;
  crypto_kdf_derive_from_key(derived.data(), derived.size(), which, "hapsimL2", key.data());
  return derived;
}

Exchange Exchange::draw() noexcept {
  Exchange exchange;
  crypto_box_keypair(exchange.open.data(), exchange.secret.data());
  return exchange;
}

std::optional<SessionKeys> session_keys(const Secret& key, const Exchange& own,
                                        const Secret& theirs, Bytes said) noexcept {
  Secret shared;
  if (crypto_scalarmult(shared.data(), own.secret.data(), theirs.data()) != 0) return std::nullopt;
  crypto_generichash_state state;
  crypto_generichash_init(&state, key.data(), key.size(), 64);
  crypto_generichash_update(&state, shared.data(), shared.size());
  crypto_generichash_update(&state, said.data(), said.size());
  std::array<unsigned char, 64> both;
  crypto_generichash_final(&state, both.data(), both.size());
  SessionKeys keys;
  std::copy_n(both.begin(), 32, keys.to_teleoperator.begin());
  std::copy_n(both.begin() + 32, 32, keys.to_operator.begin());
  sodium_memzero(both.data(), both.size());
  sodium_memzero(shared.data(), shared.size());
  return keys;
}

void seal(const Secret& key, std::uint64_t number, Bytes header, Bytes text,
          unsigned char* sealed) noexcept {
  crypto_aead_chacha20poly1305_ietf_encrypt(sealed, nullptr, text.data(), text.size(),
                                            header.data(), header.size(), nullptr,
                                            nonce_of(number).data(), key.data());
}

bool open_seal(const Secret& key, std::uint64_t number, Bytes header, Bytes sealed,
               unsigned char* text) noexcept {
  return crypto_aead_chacha20poly1305_ietf_decrypt(text, nullptr, nullptr, sealed.data(),
                                                   sealed.size(), header.data(), header.size(),
                                                   nonce_of(number).data(), key.data()) == 0;
}

Fingerprint fingerprint_of(Bytes text) noexcept {
  Fingerprint print;
  crypto_generichash(print.data(), print.size(), text.data(), text.size(), nullptr, 0);
  return print;
}

}  // namespace hapsim
