// Datagrams between two processes, over IPv4 or IPv6.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>

namespace hapsim {

// An address and port, as a key to compare; IPv4 as IPv6 has it (::ffff:127.0.0.1).
struct UdpAddress {
  std::array<unsigned char, 16> host{};  // in the network's order
  std::uint16_t port = 0;
  std::uint32_t scope = 0;  // the interface of a link-local address
  bool operator==(const UdpAddress&) const = default;
  bool is_ipv4() const;
  bool is_loopback() const;  // 127.0.0.0/8 or ::1
};

// "127.0.0.1:9000", "[::1]:9000", "lab-robot:9000"; a port alone is of this machine (127.0.0.1). Of
// a name with several addresses an IPv4 one is taken, where there is one. Error(kUsage): it is no
// address; Error(kIo): nobody knows the name.
UdpAddress parse_address(const std::string& text);
std::string to_text(const UdpAddress& address);

// A socket that never blocks. Error(kIo) at the start only: what a network loses is not an error.
class UdpSocket {
 public:
  // Port 0: any free one. Bound to "[::]" it serves IPv4 as well.
  explicit UdpSocket(const UdpAddress& bind);
  ~UdpSocket();
  UdpSocket(const UdpSocket&) = delete;
  UdpSocket& operator=(const UdpSocket&) = delete;
  UdpAddress address() const;  // where it is bound
  void send(const UdpAddress& to, std::span<const unsigned char> bytes) noexcept;
  // The bytes of the next datagram that waits, cut to the buffer; 0: none (or an empty one).
  std::size_t receive(std::span<unsigned char> buffer, UdpAddress& from) noexcept;
  // Waits for a datagram, or for `also` to be readable (-1: nothing), at most until the monotonic
  // clock shows `until` [ns].
  void wait(std::int64_t until, int also = -1) noexcept;

 private:
  int fd_ = -1;
  bool ipv4_;
};

// The address on this side for a socket that speaks to `peer`, with any free port: of this machine
// alone where the peer is.
UdpAddress any_port_towards(const UdpAddress& peer);

}  // namespace hapsim
