// Datagrams between two processes.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>

namespace hapsim {

// An IPv4 address and port, as a key to compare.
struct UdpAddress {
  std::uint32_t host = 0;  // in the machine's order
  std::uint16_t port = 0;
  bool operator==(const UdpAddress&) const = default;
  bool operator<(const UdpAddress& o) const {
    return host != o.host ? host < o.host : port < o.port;
  }
};

// "127.0.0.1:9000"; a port alone is of this machine (127.0.0.1). Error(kUsage).
UdpAddress parse_address(const std::string& text);
std::string to_text(const UdpAddress& address);

// A socket that never blocks. Error(kIo) at the start only: what a network loses is not an error.
class UdpSocket {
 public:
  // Port 0: any free one.
  explicit UdpSocket(const UdpAddress& bind);
  ~UdpSocket();
  UdpSocket(const UdpSocket&) = delete;
  UdpSocket& operator=(const UdpSocket&) = delete;
  UdpAddress address() const;  // where it is bound
  void send(const UdpAddress& to, std::span<const unsigned char> bytes) noexcept;
  // The bytes of the next datagram that waits, cut to the buffer; 0: none (or an empty one).
  std::size_t receive(std::span<unsigned char> buffer, UdpAddress& from) noexcept;
  // Waits for a datagram, at most until the monotonic clock shows `until` [ns].
  void wait(std::int64_t until) noexcept;

 private:
  int fd_ = -1;
};

}  // namespace hapsim
