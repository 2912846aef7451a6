#include "link/ends.h"

#include <fmt/format.h>

#include <utility>

#include "base/counted.h"

namespace hapsim {

std::string PacketCounts::summary() const {
  std::string text = fmt::format("{} taken, {} stale, {} foreign, {} malformed, {}", taken, stale,
                                 foreign, malformed, counted(sessions, "session", "sessions"));
  if (refused > 0) text += ", " + counted(refused, "hello refused", "hellos refused");
  return text;
}

namespace {

// Counts what a session says of a datagram; the packet where it is one to take.
std::optional<Received> take_packet(Session& session, Bytes bytes, PacketCounts& counts,
                                    Session::Result& result) noexcept {
  Received received;
  result = session.read(bytes, received.packet, received.is_newest);
  switch (result) {
    case Session::Result::kTaken:
      ++counts.taken;
      return received;
    case Session::Result::kRepeated:
      ++counts.stale;
      break;
    case Session::Result::kMalformed:
      ++counts.malformed;
      break;
    case Session::Result::kForeign:
      break;  // another session may know it
  }
  return std::nullopt;
}

}  // namespace

OperatorEnd::OperatorEnd(const Secret& key, const Terms& terms, std::uint64_t first_number)
    : key_(key), ours_(terms), first_number_(first_number), handshake_(key, terms) {}

bool OperatorEnd::tick(std::int64_t now, Datagram& out) noexcept {
  if (session_ && now - heard_ < kSilence) return false;
  if (spoken_ != 0 && now - spoken_ < kAgain) return false;
  // A hello that was answered once, or by nobody for long, is not said again.
  if (!fresh_ || (drawn_ != 0 && now - drawn_ > kOneHello)) {
    handshake_ = OperatorHandshake(key_, ours_);
    fresh_ = true;
    drawn_ = 0;
  }
  if (drawn_ == 0) drawn_ = now;
  spoken_ = now;
  out = handshake_.hello();
  return true;
}

std::optional<Received> OperatorEnd::receive(std::int64_t now, Bytes bytes) noexcept {
  switch (message_of(bytes)) {
    case Message::kPacket: {
      Session::Result result = Session::Result::kForeign;
      std::optional<Received> received;
      if (session_) received = take_packet(*session_, bytes, counts_, result);
      if (result == Session::Result::kForeign) ++counts_.foreign;
      if (result == Session::Result::kTaken || result == Session::Result::kMalformed) heard_ = now;
      if (received && received->packet.kind != Packet::Kind::kForce) {
        --counts_.taken;
        ++counts_.malformed;
        return std::nullopt;
      }
      if (received) received->is_anew = std::exchange(anew_, false);
      return received;
    }
    case Message::kWelcome: {
      HandshakeMessage welcome;
      if (!fresh_ || !handshake_.read_welcome(bytes, welcome)) {
        ++counts_.foreign;
        return std::nullopt;
      }
      theirs_ = welcome.terms;
      const Mismatch apart = mismatch(ours_, theirs_);
      if (welcome.verdict == static_cast<std::uint32_t>(Verdict::kMismatch) ||
          apart != Mismatch::kNone) {
        ++counts_.refused;
        refusal_ = words_of(apart, ours_, theirs_);
        return std::nullopt;
      }
      if (welcome.verdict != static_cast<std::uint32_t>(Verdict::kWelcome)) {
        ++counts_.refused;  // busy: asked again
        return std::nullopt;
      }
      const auto keys = handshake_.keys(welcome);
      if (!keys) {
        ++counts_.malformed;
        return std::nullopt;
      }
      session_.emplace(*keys, Side::kOperator, first_number_);
      fresh_ = false;
      anew_ = true;
      heard_ = now;
      ++counts_.sessions;
      return std::nullopt;
    }
    default:
      ++counts_.foreign;
      return std::nullopt;
  }
}

bool OperatorEnd::write(const Packet& packet, Datagram& out) noexcept {
  if (!session_) return false;
  if (session_->write(packet, out)) return true;
  session_.reset();  // its numbers are used up: tick() shakes hands again
  first_number_ = 1;
  return false;
}

TeleoperatorEnd::TeleoperatorEnd(const Secret& key, const Terms& terms, std::uint64_t first_number)
    : handshake_(key, terms), first_number_(first_number) {}

TeleoperatorEnd::Answer TeleoperatorEnd::greet(std::int64_t now, const HandshakeMessage& hello,
                                               Datagram& out) noexcept {
  // The same again: its welcome may have been lost. One whose session was begun is an old one that
  // somebody has kept.
  if (hello.tag == over_) return ++counts_.stale, Answer{};
  if (coming_ && hello.tag == hello_) {
    out = welcome_;
    return {std::nullopt, true};
  }
  // Each costs some 0.1 ms: who repeats old ones must not take the time of the one that is served.
  if (has_greeted_ && now - greeted_ < kSparse) return ++counts_.refused, Answer{};
  has_greeted_ = true;
  greeted_ = now;
  const Mismatch apart = mismatch(handshake_.terms(), hello.terms);
  Verdict verdict = Verdict::kWelcome;
  if (apart != Mismatch::kNone)
    verdict = Verdict::kMismatch;
  else if (is_served(now))
    verdict = Verdict::kBusy;
  const auto keys = handshake_.welcome(hello, verdict, out);
  if (verdict != Verdict::kWelcome || !keys) {
    ++counts_.refused;
    refusal_ = apart == Mismatch::kNone ? "another operator is served"
                                        : words_of(apart, handshake_.terms(), hello.terms);
    return {std::nullopt, true};
  }
  refusal_.clear();
  coming_.emplace(*keys, Side::kTeleoperator, first_number_);
  hello_ = hello.tag;
  welcome_ = out;
  return {std::nullopt, true};
}

TeleoperatorEnd::Answer TeleoperatorEnd::receive(std::int64_t now, const UdpAddress& from,
                                                 Bytes bytes, Datagram& out) noexcept {
  switch (message_of(bytes)) {
    case Message::kHello: {
      HandshakeMessage hello;
      if (!handshake_.read_hello(bytes, hello)) return ++counts_.foreign, Answer{};
      return greet(now, hello, out);
    }
    case Message::kPacket: {
      Session::Result result = Session::Result::kForeign;
      std::optional<Received> received;
      // The first that is sealed by the new keys proves that it is no hello of old. It is asked
      // before the session that was: that one may have had the same number.
      if (coming_ && !is_served(now)) {
        received = take_packet(*coming_, bytes, counts_, result);
        if (result == Session::Result::kTaken || result == Session::Result::kMalformed) {
          session_ = std::exchange(coming_, std::nullopt);
          over_ = hello_;
          ++counts_.sessions;
          if (received) received->is_anew = true;
        }
      }
      if (result == Session::Result::kForeign && session_)
        received = take_packet(*session_, bytes, counts_, result);
      if (result == Session::Result::kForeign) ++counts_.foreign;
      if (received && received->packet.kind != Packet::Kind::kMotion) {
        --counts_.taken;
        ++counts_.malformed;
        received.reset();
      }
      if (received) {
        heard_ = now;
        if (received->is_newest) peer_ = from;  // proved by the seal
      }
      return {received, false};
    }
    default:
      return ++counts_.foreign, Answer{};
  }
}

bool TeleoperatorEnd::write(const Packet& packet, Datagram& out) noexcept {
  return session_ && session_->write(packet, out);
}

}  // namespace hapsim
