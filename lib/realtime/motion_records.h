// Motion in and forces out as records of fixed size.
#pragma once

#include "io/stream.h"
#include "realtime/motion_source.h"

namespace hapsim {

// Little-endian, without padding or header; integers of 32 bits, numbers of 64 (IEEE 754), SI:
//   tip in      32 bytes: t, x, y, z
//   press in    64 bytes: press, contact (integers), t, x, y, z, ux, uy, uz
//   force out   88 bytes: press, contact (integers), t, x, y, z, ux, uy, uz, fx, fy, fz
// contact: 0 in the air; 1 in contact, and 2 for kBeyondDepth, 4 for kBeyondHeld, 8 for
// kBeyondPlaces beside it, other bits of Beyond not; of a force for a hand 256 times its Safety
// besides.
class MotionRecords : public MotionSource {
 public:
  enum class Kind { kTip, kPress };
  static constexpr std::size_t kTipBytes = 32, kPressBytes = 64, kForceBytes = 88;

  MotionRecords(Input& input, Kind kind) : input_(input), kind_(kind) {}
  bool has_contact_point() const override { return kind_ == Kind::kPress; }
  // Also Error(kBadInput): a record that is not finite, or ends early.
  bool next(MotionLine& line) override;
  void write_force(std::string& buffer, const MotionLine& line, const Vec3& force) const override;
  void write_hand_force(std::string& buffer, const MotionLine& line, const Vec3& force, int safety,
                        const Vec3& asked) const override;

 private:
  Input& input_;
  Kind kind_;
  long record_ = 0;
};

}  // namespace hapsim
