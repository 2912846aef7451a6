#include "link/handshake.h"

#include "link/bytes.h"

namespace hapsim {
namespace {

constexpr std::size_t kTagged = kHandshakeBytes - sizeof(Tag);
enum Derived : std::uint64_t { kOfHello = 1, kOfWelcome = 2, kOfSession = 3 };

// Without its tag.
void write_handshake(Datagram& datagram, Message message, const HandshakeMessage& m) noexcept {
  unsigned char* at = datagram.bytes.data();
  put_header(at, message, 0);
  at += kHeaderBytes;
  put(at, m.verdict);
  put(at, std::uint32_t{0});
  put(at, m.name);
  put(at, m.open);
  m.terms.write(at);
  datagram.size = kHandshakeBytes;
}

Tag tag_of_welcome(const Secret& key, Bytes welcome, const Tag& hello) noexcept {
  std::array<unsigned char, kTagged + sizeof(Tag)> text;
  std::copy_n(welcome.begin(), kTagged, text.begin());
  std::copy_n(hello.begin(), hello.size(), text.begin() + kTagged);
  return tag_of(derive(key, kOfWelcome), text);
}

std::optional<SessionKeys> keys_of(const Secret& key, const Exchange& own, const Secret& theirs,
                                   const Tag& hello, const Tag& welcome) noexcept {
  std::array<unsigned char, 2 * sizeof(Tag)> said;
  std::copy_n(hello.begin(), hello.size(), said.begin());
  std::copy_n(welcome.begin(), welcome.size(), said.begin() + hello.size());
  return session_keys(derive(key, kOfSession), own, theirs, said);
}

}  // namespace

HandshakeMessage read_handshake(Bytes bytes) noexcept {
  const unsigned char* at = bytes.data() + kHeaderBytes;
  HandshakeMessage m;
  m.verdict = take<std::uint32_t>(at);
  take<std::uint32_t>(at);
  m.name = take<std::array<unsigned char, 16>>(at);
  m.open = take<Secret>(at);
  m.terms = Terms::read(at);
  at += Terms::kBytes;
  m.tag = take<Tag>(at);
  return m;
}

OperatorHandshake::OperatorHandshake(const Secret& key, const Terms& terms)
    : key_(key), exchange_(Exchange::draw()) {
  HandshakeMessage m;
  draw_random(m.name);
  m.open = exchange_.open;
  m.terms = terms;
  write_handshake(hello_, Message::kHello, m);
  tag_ = tag_of(derive(key_, kOfHello), hello_.view().first(kTagged));
  std::copy_n(tag_.begin(), tag_.size(), hello_.bytes.begin() + kTagged);
}

bool OperatorHandshake::read_welcome(Bytes bytes, HandshakeMessage& welcome) const noexcept {
  if (message_of(bytes) != Message::kWelcome) return false;
  const HandshakeMessage m = read_handshake(bytes);
  if (m.name != read_handshake(hello_.view()).name) return false;
  std::array<unsigned char, kTagged + sizeof(Tag)> text;
  std::copy_n(bytes.begin(), kTagged, text.begin());
  std::copy_n(tag_.begin(), tag_.size(), text.begin() + kTagged);
  if (!is_tag_of(m.tag, derive(key_, kOfWelcome), text)) return false;
  welcome = m;
  return true;
}

std::optional<SessionKeys> OperatorHandshake::keys(const HandshakeMessage& welcome) const noexcept {
  return keys_of(key_, exchange_, welcome.open, tag_, welcome.tag);
}

bool TeleoperatorHandshake::read_hello(Bytes bytes, HandshakeMessage& hello) const noexcept {
  if (message_of(bytes) != Message::kHello) return false;
  const HandshakeMessage m = read_handshake(bytes);
  if (!is_tag_of(m.tag, derive(key_, kOfHello), bytes.first(kTagged))) return false;
  hello = m;
  return true;
}

std::optional<SessionKeys> TeleoperatorHandshake::welcome(const HandshakeMessage& hello,
                                                          Verdict verdict,
                                                          Datagram& welcome) const noexcept {
  const Exchange exchange = Exchange::draw();
  HandshakeMessage m;
  m.verdict = static_cast<std::uint32_t>(verdict);
  m.name = hello.name;
  m.open = exchange.open;
  m.terms = terms_;
  write_handshake(welcome, Message::kWelcome, m);
  m.tag = tag_of_welcome(key_, welcome.view(), hello.tag);
  std::copy_n(m.tag.begin(), m.tag.size(), welcome.bytes.begin() + kTagged);
  if (verdict != Verdict::kWelcome) return std::nullopt;
  return keys_of(key_, exchange, hello.open, hello.tag, m.tag);
}

}  // namespace hapsim
