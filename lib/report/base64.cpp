#include "report/base64.h"

namespace hapsim {

std::string base64(const void* data, std::size_t size) {
  static constexpr char kLetters[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const auto* bytes = static_cast<const unsigned char*>(data);
  std::string out;
  out.reserve((size + 2) / 3 * 4);
  for (std::size_t i = 0; i < size; i += 3) {
    const unsigned a = bytes[i], b = i + 1 < size ? bytes[i + 1] : 0,
                   c = i + 2 < size ? bytes[i + 2] : 0;
    out += kLetters[a >> 2];
    out += kLetters[(a & 3) << 4 | b >> 4];
    out += i + 1 < size ? kLetters[(b & 15) << 2 | c >> 6] : '=';
    out += i + 2 < size ? kLetters[c & 63] : '=';
  }
  return out;
}

}  // namespace hapsim
