#include "link/udp.h"

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>

#include "base/error.h"
#include "io/number.h"

namespace hapsim {
namespace {

sockaddr_in raw(const UdpAddress& address) {
  sockaddr_in a{};
  a.sin_family = AF_INET;
  a.sin_addr.s_addr = htonl(address.host);
  a.sin_port = htons(address.port);
  return a;
}

UdpAddress cooked(const sockaddr_in& a) {
  return {ntohl(a.sin_addr.s_addr), ntohs(a.sin_port)};
}

}  // namespace

UdpAddress parse_address(const std::string& text) {
  const std::size_t colon = text.rfind(':');
  const std::string host = colon == text.npos ? "127.0.0.1" : text.substr(0, colon);
  const std::string port = colon == text.npos ? text : text.substr(colon + 1);
  in_addr address{};
  double number = 0;
  if (inet_pton(AF_INET, host.c_str(), &address) != 1 || !parse_number(port, number) ||
      number < 0 || number > 65535 || number != std::floor(number))
    fail_usage(shown(text) + " is not an address", "give HOST:PORT in numbers: 127.0.0.1:9000");
  return {ntohl(address.s_addr), static_cast<std::uint16_t>(number)};
}

std::string to_text(const UdpAddress& address) {
  char text[INET_ADDRSTRLEN] = "";
  const in_addr host{htonl(address.host)};
  inet_ntop(AF_INET, &host, text, sizeof text);
  return std::string(text) + ":" + std::to_string(address.port);
}

UdpSocket::UdpSocket(const UdpAddress& bind_to) {
  const auto fail = [&](const char* what) {
    const std::string why = std::strerror(errno);
    if (fd_ >= 0) close(fd_);
    fail_io(to_text(bind_to), std::string(what) + ": " + why, "choose another address or port");
  };
  fd_ = socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (fd_ < 0) fail("no socket");
  const sockaddr_in a = raw(bind_to);
  if (bind(fd_, reinterpret_cast<const sockaddr*>(&a), sizeof a) != 0) fail("cannot be bound");
}

UdpSocket::~UdpSocket() {
  if (fd_ >= 0) close(fd_);
}

UdpAddress UdpSocket::address() const {
  sockaddr_in a{};
  socklen_t size = sizeof a;
  getsockname(fd_, reinterpret_cast<sockaddr*>(&a), &size);
  return cooked(a);
}

void UdpSocket::send(const UdpAddress& to, std::span<const unsigned char> bytes) noexcept {
  const sockaddr_in a = raw(to);
  sendto(fd_, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&a), sizeof a);
}

std::size_t UdpSocket::receive(std::span<unsigned char> buffer, UdpAddress& from) noexcept {
  sockaddr_in a{};
  socklen_t size = sizeof a;
  const ssize_t got =
      recvfrom(fd_, buffer.data(), buffer.size(), 0, reinterpret_cast<sockaddr*>(&a), &size);
  if (got <= 0) return 0;
  from = cooked(a);
  return static_cast<std::size_t>(got);
}

void UdpSocket::wait(std::int64_t until) noexcept {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  const std::int64_t left =
      until - (std::int64_t{1'000'000'000} * now.tv_sec + static_cast<std::int64_t>(now.tv_nsec));
  timespec rest{};
  rest.tv_sec = static_cast<time_t>(std::max<std::int64_t>(left, 0) / 1'000'000'000);
  rest.tv_nsec = static_cast<long>(std::max<std::int64_t>(left, 0) % 1'000'000'000);
  pollfd ready{fd_, POLLIN, 0};
  ppoll(&ready, 1, &rest, nullptr);
}

}  // namespace hapsim
