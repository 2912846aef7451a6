#include "realtime/motion_records.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>

#include "base/error.h"
#include "realtime/tool_loop.h"

namespace hapsim {
namespace {

static_assert(std::endian::native == std::endian::little, "records are little-endian");

// The bits that these records have had from the first: they have no version to tell of more.
constexpr int kBeyondInRecords = kBeyondDepth | kBeyondHeld | kBeyondPlaces;

template <class T>
T take(const char*& from) {
  T value;
  std::memcpy(&value, from, sizeof value);
  from += sizeof value;
  return value;
}
Vec3 take_vector(const char*& from) {
  Vec3 v;
  for (int k = 0; k < 3; ++k) v[k] = take<double>(from);
  return v;
}
template <class T>
void put(std::string& to, T value) {
  char bytes[sizeof value];
  std::memcpy(bytes, &value, sizeof value);
  to.append(bytes, sizeof value);
}

}  // namespace

bool MotionRecords::next(MotionLine& line) {
  std::array<char, kPressBytes> bytes;
  if (input_.ended_by_signal()) return false;
  const std::size_t size = kind_ == Kind::kTip ? kTipBytes : kPressBytes;
  input_.stream().read(bytes.data(), static_cast<std::streamsize>(size));
  const auto got = static_cast<std::size_t>(input_.stream().gcount());
  if (got == 0 || (got < size && input_.ended_by_signal())) return false;
  ++record_;
  const auto where = [this] { return input_.name() + ": record " + std::to_string(record_); };
  if (got < size)
    fail_input(where(), "it has " + std::to_string(got) + " bytes of " + std::to_string(size),
               "send whole records; see hs-simulate(1)");
  const char* from = bytes.data();
  line = {};
  line.has_contact_point = kind_ == Kind::kPress;
  if (line.has_contact_point) {
    line.press = take<std::int32_t>(from);
    line.in_air = take<std::int32_t>(from) == 0;
  }
  line.t = take<double>(from);
  line.point = take_vector(from);
  if (line.has_contact_point) line.u = take_vector(from);
  if (!std::isfinite(line.t) || !line.point.allFinite() || !line.u.allFinite())
    fail_input(where(), "a number is not finite", "check the order of bytes and the record's kind");
  check_.check(line, where);
  return true;
}

void MotionRecords::write_force(std::string& buffer, const MotionLine& line,
                                const Vec3& force) const {
  write_hand_force(buffer, line, force, 0, force);
}

void MotionRecords::write_hand_force(std::string& buffer, const MotionLine& line, const Vec3& force,
                                     int safety, const Vec3&) const {
  buffer.clear();
  put(buffer, static_cast<std::int32_t>(line.press));
  put(buffer,
      static_cast<std::int32_t>(line.in_air ? 0 : 1 + 2 * (line.beyond & kBeyondInRecords)) |
          safety << 8);
  put(buffer, line.t);
  for (const Vec3* v : {&line.point, &line.u, &force})
    for (int k = 0; k < 3; ++k) put(buffer, (*v)[k] == 0 ? 0.0 : (*v)[k]);  // no minus zero
}

}  // namespace hapsim
