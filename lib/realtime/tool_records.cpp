#include "realtime/tool_records.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "base/error.h"

namespace hapsim {
namespace {

static_assert(std::endian::native == std::endian::little, "records are little-endian");
constexpr char kToolMagic[] = "hapsimIO";
constexpr int kBeyondSinceFour = kBeyondFitted | kBeyondSpeed | kBeyondLaw;

template <class T>
T taken(const char*& from) {
  T value;
  std::memcpy(&value, from, sizeof value);
  from += sizeof value;
  return value;
}
Vec3 taken_vector(const char*& from) {
  Vec3 v;
  for (int k = 0; k < 3; ++k) v[k] = taken<double>(from);
  return v;
}
template <class T>
void add_to(std::string& to, T value) {
  char bytes[sizeof value];
  std::memcpy(bytes, &value, sizeof value);
  to.append(bytes, sizeof value);
}
void add_vector(std::string& to, const Vec3& v) {
  for (int k = 0; k < 3; ++k) add_to(to, v[k] == 0 ? 0.0 : v[k]);  // no minus zero
}

}  // namespace

ToolRecords::ToolRecords(Input& input) : input_(input) {
  char bytes[kHeaderBytes];
  input.stream().read(bytes, kHeaderBytes);
  const std::string mend = "begin with 8 bytes hapsimIO, version, size; see hs-simulate(1)";
  if (input.stream().gcount() != kHeaderBytes || std::memcmp(bytes, kToolMagic, 8) != 0)
    fail_input(input.name(), "the records have no header", mend);
  const char* from = bytes + 8;
  const auto version = taken<std::uint32_t>(from), size = taken<std::uint32_t>(from);
  const auto tools = taken<std::uint32_t>(from), kind = taken<std::uint32_t>(from);
  if (version < kFirstVersion)
    fail_input(input.name(), fmt::format("its header asks for version {}", version),
               fmt::format("records with a header are of version {} or later", kFirstVersion));
  if (tools < 1 || tools > kMostTools)
    fail_input(input.name(), fmt::format("its header is of {} tools", tools),
               fmt::format("from 1 to {} press a body at once", kMostTools));
  if (kind > 1)
    fail_input(input.name(), fmt::format("its kind is {}", kind), "0: tips, 1: presses");
  const std::size_t least = kStepBytes + kPoseBytes * tools;
  if (size < least || size > 65536)
    fail_input(input.name(), fmt::format("its records have {} bytes", size),
               fmt::format("of {} tools they have {} or more", tools, least));
  tools_ = tools;
  version_ = std::min(version, kVersion);
  presses_ = kind == 1;
  bytes_ = size;
  text_.resize(size);
}

std::string ToolRecords::header() const {
  std::string header(kToolMagic, 8);
  add_to(header, version_);
  const std::size_t feel = kFeelBytes + (version_ >= 3 ? kAskedBytes : 0);
  add_to(header, static_cast<std::uint32_t>(kStepBytes + feel * tools_));
  add_to(header, static_cast<std::uint32_t>(tools_));
  add_to(header, std::uint32_t{presses_ ? 1U : 0U});
  header.resize(kHeaderBytes, '\0');
  return header;
}

bool ToolRecords::next(ToolStep& step) {
  if (input_.ended_by_signal()) return false;
  input_.stream().read(text_.data(), static_cast<std::streamsize>(bytes_));
  const auto got = static_cast<std::size_t>(input_.stream().gcount());
  if (got == 0 || (got < bytes_ && input_.ended_by_signal())) return false;
  ++record_;
  const auto where = [this] { return input_.name() + ": record " + std::to_string(record_); };
  if (got < bytes_)
    fail_input(where(), fmt::format("it has {} bytes of {}", got, bytes_),
               "send whole records; see hs-simulate(1)");
  const char* from = text_.data();
  step.t = taken<double>(from);
  step.temperature = taken<double>(from);
  bool finite = std::isfinite(step.t) && !std::isinf(step.temperature);
  step.present.fill(0);
  for (std::size_t k = 0; k < tools_; ++k) {
    ToolPose& pose = step.pose[k];
    step.present[k] = 1;
    pose.press = taken<std::int32_t>(from);
    pose.in_air = taken<std::int32_t>(from) == 0;
    pose.point = taken_vector(from);
    pose.u = taken_vector(from);
    pose.turn = taken_vector(from);
    if (!presses_) pose.u.setZero();
    finite = finite && pose.point.allFinite() && pose.u.allFinite() && pose.turn.allFinite();
  }
  if (!finite)
    fail_input(where(), "a number is not finite", "check the order of bytes and the record's size");
  for (std::size_t k = 0; k < tools_; ++k) check(k, step, where);
  return true;
}

void ToolRecords::write(std::string& buffer, const ToolStep& step,
                        std::span<const ToolFeel> feel) const {
  buffer.clear();
  add_to(buffer, step.t);
  add_to(buffer, step.temperature);
  for (const ToolFeel& f : feel) {
    const int beyond = version_ >= 4 ? f.beyond : f.beyond & ~kBeyondSinceFour;
    for (const int i : {f.press, f.in_air ? 0 : 1, beyond, f.safety})
      add_to(buffer, static_cast<std::int32_t>(i));
    for (const Vec3* v : {&f.point, &f.u, &f.turn, &f.force, &f.torque}) add_vector(buffer, *v);
    add_to(buffer, f.uncertainty);
  }
  if (version_ < 3) return;
  for (const ToolFeel& f : feel)
    for (const Vec3* v : {&f.asked_force, &f.asked_torque}) add_vector(buffer, *v);
}

}  // namespace hapsim
