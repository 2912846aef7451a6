#include "volume/gunzip.h"

#include <zlib.h>

#include <algorithm>

#include "base/error.h"

namespace hapsim {

bool is_gzip(const std::string& bytes) {
  return bytes.size() > 2 && bytes[0] == '\x1f' && bytes[1] == '\x8b';
}

std::string gunzip(const std::string& bytes, std::size_t most, const std::string& name) {
  constexpr std::size_t kStep = 1u << 20;
  z_stream stream = {};
  if (inflateInit2(&stream, 15 + 16) != Z_OK)
    fail_numerics(name, "zlib does not start", "free memory");
  std::string result;
  std::size_t taken = 0;
  int state = Z_OK;
  while (state == Z_OK && result.size() < most) {
    // Input and output in steps that fit zlib's 32 bits.
    const std::size_t in = std::min(kStep, bytes.size() - taken);
    const std::size_t before = result.size(), out = std::min(kStep, most - before);
    result.resize(before + out);
    // zlib does not write to its input.
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data() + taken));
    stream.avail_in = static_cast<uInt>(in);
    stream.next_out = reinterpret_cast<Bytef*>(result.data() + before);
    stream.avail_out = static_cast<uInt>(out);
    state = inflate(&stream, Z_NO_FLUSH);
    taken += in - stream.avail_in;
    result.resize(before + out - stream.avail_out);
    if (state == Z_BUF_ERROR && in == 0) break;  // truncated
    if (state == Z_BUF_ERROR) state = Z_OK;
  }
  inflateEnd(&stream);
  if (state == Z_DATA_ERROR || state == Z_STREAM_ERROR || state == Z_NEED_DICT) {
    fail_input(name, "the packed data are damaged", "copy or export the file again");
  }
  return result;
}

}  // namespace hapsim
