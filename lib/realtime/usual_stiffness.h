// How the measured force usually stands to the model's.
#pragma once

#include <cstdint>
#include <vector>

#include "base/vec3.h"

namespace hapsim {

struct UsualStiffness {
  double factor = 1;  // of the model's stiffness, that the measured forces show
  double error = 0;   // its standard error; the share where too few presses tell
  double share = 0;   // of the force, by which a press's is off beside that
};

// Press by press, measured against model. A press counts when the next begins.
class PressFactors {
 public:
  // The next sample of a press, which began at sample `begun` of the stream.
  void add(std::int32_t press, std::size_t begun, const Vec3& model, const Vec3& measured);
  // From the presses that began before sample `before`; `share` of the force where they are few,
  // and at most.
  UsualStiffness usual(std::size_t before, double share) const;

  void clear() { presses_.clear(); }

 private:
  struct Sums {
    std::int32_t press = 0;
    std::size_t begun = 0;
    double mm = 0, fm = 0;
  };
  std::vector<Sums> presses_;
};

}  // namespace hapsim
