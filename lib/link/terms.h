// What both sides of a link must agree on before a force is felt.
#pragma once

#include <string>

#include "base/vec3.h"
#include "link/seal.h"

namespace hapsim {

constexpr std::uint32_t kLinkVersion = 2;

// 112 bytes, little-endian: version (32 bits), 4 zero bytes, units (text of 16), tool radius and
// the corners of the body's box (64-bit numbers), fingerprints of body and model.
struct Terms {
  static constexpr std::size_t kBytes = 112;
  std::uint32_t version = kLinkVersion;
  std::array<char, 16> units{'m', ',', 'N', ',', 's'};
  double tool_radius = 0;  // [m]
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();
  Fingerprint body{}, model{};  // zero: of no importance

  void write(unsigned char* at) const noexcept;
  static Terms read(const unsigned char* at) noexcept;
};

// What keeps the sides apart, from version to model.
enum class Mismatch : std::uint32_t { kNone, kVersion, kUnits, kTool, kBody, kModel };
// Bodies are the same where each corner of their boxes is within a tenth of their diagonal: the
// operator's is a scan of the one that is pressed. A fingerprint counts where both sides have one
// of the model. Numbers that are none agree with nothing.
Mismatch mismatch(const Terms& a, const Terms& b) noexcept;
// "the tool's radius is 4 mm here and 5 mm there".
std::string words_of(Mismatch mismatch, const Terms& here, const Terms& there);

}  // namespace hapsim
