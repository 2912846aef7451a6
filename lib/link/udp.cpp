#include "link/udp.h"

#include <arpa/inet.h>
#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <memory>

#include "base/error.h"
#include "io/number.h"

namespace hapsim {
namespace {

constexpr std::array<unsigned char, 12> kIpv4{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xff, 0xff};

UdpAddress ipv4(const in_addr& host, std::uint16_t port) {
  UdpAddress address;
  std::copy(kIpv4.begin(), kIpv4.end(), address.host.begin());
  std::memcpy(address.host.data() + 12, &host, 4);
  address.port = port;
  return address;
}

UdpAddress ipv6(const sockaddr_in6& a) {
  UdpAddress address;
  std::memcpy(address.host.data(), &a.sin6_addr, 16);
  address.port = ntohs(a.sin6_port);
  address.scope = a.sin6_scope_id;
  return address;
}

UdpAddress cooked(const sockaddr_storage& a) {
  if (a.ss_family == AF_INET6) return ipv6(reinterpret_cast<const sockaddr_in6&>(a));
  const auto& four = reinterpret_cast<const sockaddr_in&>(a);
  return ipv4(four.sin_addr, ntohs(four.sin_port));
}

// For a socket of IPv4, or of IPv6.
socklen_t raw(const UdpAddress& address, bool four, sockaddr_storage& a) {
  a = {};
  if (four) {
    auto& to = reinterpret_cast<sockaddr_in&>(a);
    to.sin_family = AF_INET;
    std::memcpy(&to.sin_addr, address.host.data() + 12, 4);
    to.sin_port = htons(address.port);
    return sizeof to;
  }
  auto& to = reinterpret_cast<sockaddr_in6&>(a);
  to.sin6_family = AF_INET6;
  std::memcpy(&to.sin6_addr, address.host.data(), 16);
  to.sin6_port = htons(address.port);
  to.sin6_scope_id = address.scope;
  return sizeof to;
}

std::uint16_t port_of(const std::string& text, const std::string& whole) {
  double number = 0;
  if (!parse_number(text, number) || number < 0 || number > 65535 || number != std::floor(number))
    fail_usage(shown(whole) + " is not an address",
               "give HOST:PORT: 127.0.0.1:9000, [::1]:9000, lab-robot:9000");
  return static_cast<std::uint16_t>(number);
}

}  // namespace

bool UdpAddress::is_ipv4() const {
  return std::equal(kIpv4.begin(), kIpv4.end(), host.begin());
}

bool UdpAddress::is_loopback() const {
  if (is_ipv4()) return host[12] == 127;
  return std::all_of(host.begin(), host.end() - 1, [](unsigned char b) { return b == 0; }) &&
         host[15] == 1;
}

UdpAddress parse_address(const std::string& text) {
  const std::size_t colon = text.rfind(':');
  std::string host = colon == text.npos ? "127.0.0.1" : text.substr(0, colon);
  const std::uint16_t port = port_of(colon == text.npos ? text : text.substr(colon + 1), text);
  if (host.size() > 2 && host.front() == '[' && host.back() == ']')
    host = host.substr(1, host.size() - 2);
  else if (host.empty() || host.find_first_of("[]:") != host.npos)
    fail_usage(shown(text) + " is not an address",
               "give HOST:PORT: 127.0.0.1:9000, [::1]:9000, lab-robot:9000");
  addrinfo hints{};
  hints.ai_family = AF_UNSPEC;
  hints.ai_socktype = SOCK_DGRAM;
  addrinfo* raw_list = nullptr;
  const int code = getaddrinfo(host.c_str(), nullptr, &hints, &raw_list);
  const std::unique_ptr<addrinfo, void (*)(addrinfo*)> list(raw_list, freeaddrinfo);
  if (code != 0)
    fail_io(text, std::string("this host is not found: ") + gai_strerror(code),
            "check its name, or give its address in numbers");
  const addrinfo* best = nullptr;
  for (const addrinfo* one = list.get(); one != nullptr; one = one->ai_next)
    if (best == nullptr || (best->ai_family != AF_INET && one->ai_family == AF_INET)) best = one;
  sockaddr_storage a{};
  std::memcpy(&a, best->ai_addr, std::min<std::size_t>(best->ai_addrlen, sizeof a));
  UdpAddress address = cooked(a);
  address.port = port;
  return address;
}

std::string to_text(const UdpAddress& address) {
  char text[INET6_ADDRSTRLEN] = "";
  if (address.is_ipv4()) {
    inet_ntop(AF_INET, address.host.data() + 12, text, sizeof text);
    return std::string(text) + ":" + std::to_string(address.port);
  }
  inet_ntop(AF_INET6, address.host.data(), text, sizeof text);
  return "[" + std::string(text) + "]:" + std::to_string(address.port);
}

UdpAddress any_port_towards(const UdpAddress& peer) {
  UdpAddress address = peer;
  address.port = 0;
  if (peer.is_loopback()) return address;
  if (peer.is_ipv4())
    std::fill(address.host.begin() + 12, address.host.end(), 0);
  else
    address = {};
  return address;
}

UdpSocket::UdpSocket(const UdpAddress& bind_to) : ipv4_(bind_to.is_ipv4()) {
  const auto fail = [&](const char* what) {
    const std::string why = std::strerror(errno);
    if (fd_ >= 0) close(fd_);
    fail_io(to_text(bind_to), std::string(what) + ": " + why, "choose another address or port");
  };
  fd_ = socket(ipv4_ ? AF_INET : AF_INET6, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (fd_ < 0) fail("no socket");
  if (const int off = 0; !ipv4_) setsockopt(fd_, IPPROTO_IPV6, IPV6_V6ONLY, &off, sizeof off);
  sockaddr_storage a;
  const socklen_t size = raw(bind_to, ipv4_, a);
  if (bind(fd_, reinterpret_cast<const sockaddr*>(&a), size) != 0) fail("cannot be bound");
}

UdpSocket::~UdpSocket() {
  if (fd_ >= 0) close(fd_);
}

UdpAddress UdpSocket::address() const {
  sockaddr_storage a{};
  socklen_t size = sizeof a;
  getsockname(fd_, reinterpret_cast<sockaddr*>(&a), &size);
  return cooked(a);
}

void UdpSocket::send(const UdpAddress& to, std::span<const unsigned char> bytes) noexcept {
  sockaddr_storage a;
  const socklen_t size = raw(to, ipv4_, a);
  sendto(fd_, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&a), size);
}

std::size_t UdpSocket::receive(std::span<unsigned char> buffer, UdpAddress& from) noexcept {
  sockaddr_storage a{};
  socklen_t size = sizeof a;
  const ssize_t got =
      recvfrom(fd_, buffer.data(), buffer.size(), 0, reinterpret_cast<sockaddr*>(&a), &size);
  if (got <= 0) return 0;
  from = cooked(a);
  return static_cast<std::size_t>(got);
}

void UdpSocket::wait(std::int64_t until, int also) noexcept {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  const std::int64_t left =
      until - (std::int64_t{1'000'000'000} * now.tv_sec + static_cast<std::int64_t>(now.tv_nsec));
  timespec rest{};
  rest.tv_sec = static_cast<time_t>(std::max<std::int64_t>(left, 0) / 1'000'000'000);
  rest.tv_nsec = static_cast<long>(std::max<std::int64_t>(left, 0) % 1'000'000'000);
  std::array<pollfd, 2> ready{{{fd_, POLLIN, 0}, {also, POLLIN, 0}}};
  ppoll(ready.data(), ready.size(), &rest, nullptr);
}

}  // namespace hapsim
