// Bytes between two processes of one program: what both sides have the same layout of.
#pragma once

#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstdint>

namespace hapsim {

// One end of a connected pair of sockets, which stays the caller's to close. All or nothing: false
// where the other side is gone, without a signal. A call that is interrupted goes on.
class ByteStream {
 public:
  explicit ByteStream(int socket) : socket_(socket) {}

  bool put(const void* from, std::size_t size) const {
    for (const char* at = static_cast<const char*>(from); size > 0;) {
      const ssize_t n = send(socket_, at, size, MSG_NOSIGNAL);
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) return false;
      at += n;
      size -= static_cast<std::size_t>(n);
    }
    return true;
  }
  bool get(void* to, std::size_t size) const {
    for (char* at = static_cast<char*>(to); size > 0;) {
      const ssize_t n = read(socket_, at, size);
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) return false;
      at += n;
      size -= static_cast<std::size_t>(n);
    }
    return true;
  }
  // A list of what is copied byte by byte, after its length.
  template <class List>
  bool put_all(const List& list) const {
    const std::uint64_t count = list.size();
    return put(&count, sizeof count) && put(list.data(), count * sizeof list[0]);
  }
  template <class List>
  bool get_all(List& list) const {
    std::uint64_t count = 0;
    if (!get(&count, sizeof count)) return false;
    list.resize(count);
    return get(list.data(), count * sizeof list[0]);
  }

 private:
  int socket_;
};

}  // namespace hapsim
