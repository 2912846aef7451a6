// Motions of one or more tools as records that say which version they are of, and how large.
#pragma once

#include <cstdint>

#include "io/stream.h"
#include "realtime/tool_source.h"

namespace hapsim {

// Little-endian, without padding; i: 32 bits, the others IEEE 754 of 64 bits, SI. Both directions
// begin with a header of 32 bytes:
//   8 bytes "hapsimIO", i version, i bytes of a record, i tools, i kind (0: tips, 1: presses), and
//   8 bytes of 0
// Who asks says the newest version that it knows and the size of its records; the answer's header
// says the version that is spoken, at most that, and the size of the records of the answers. Of a
// record that is longer than its version's the rest is passed over, so fields can be added at the
// end of a later version without a change to older programs. Version 2 (1 are MotionRecords):
//   asked, 16 + 80 tools bytes: t, temp (NaN: not known); of each tool i press, i contact (0: in
//   the
//     air), x y z, ux uy uz, thx thy thz; of tips press, contact and u are passed over
//   answered, 16 + 144 tools bytes: t, temp; of each tool i press, i contact, i beyond, i safety (0
//     where there is no hand), x y z, ux uy uz, thx thy thz, fx fy fz, tqx tqy tqz, standard
//     uncertainty of the force (NaN: unknown)
// Version 3 asks as 2 does, answers 16 + 192 tools bytes: those of version 2, then of each tool ax
// ay az, atqx atqy atqz: the force and torque that were asked for. While no motion comes, for a
// hand, answers come that nobody has asked for; bit 512 of their safety says so. To version 2 none
// does. Version 4 is as 3, with bits from kBeyondFitted to kBeyondLaw in beyond; earlier ones have
// none of these.
class ToolRecords : public ToolSource {
 public:
  static constexpr std::uint32_t kVersion = 4, kFirstVersion = 2;
  static constexpr std::size_t kHeaderBytes = 32, kStepBytes = 16, kPoseBytes = 80,
                               kFeelBytes = 144, kAskedBytes = 48;
  // Reads the header. Error(kBadInput): it is none, a version or size that cannot be served, a
  // number of tools other than 1 to kMostTools.
  explicit ToolRecords(Input& input);

  std::size_t tools() const override { return tools_; }
  bool has_contact_point() const override { return presses_; }
  bool takes_unasked() const override { return version_ >= 3; }
  std::string header() const;  // of the answers
  // Also Error(kBadInput): a record that is not finite, or ends early.
  bool next(ToolStep& step) override;
  void write(std::string& buffer, const ToolStep& step,
             std::span<const ToolFeel> feel) const override;

 private:
  Input& input_;
  std::size_t tools_ = 1, bytes_ = 0;
  std::uint32_t version_ = kVersion;  // that is spoken
  bool presses_ = false;
  std::string text_;  // of a record
  long record_ = 0;
};

}  // namespace hapsim
