// How the measured force usually stands to the model's.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "base/vec3.h"

namespace hapsim {

struct UsualStiffness {
  double factor = 1;  // of the model's stiffness, that the measured forces show
  double error = 0;   // its standard error; the share where too few presses tell
  double share = 0;   // of the force, by which a press's is off beside that and off_at
  // By how much of its size the force was off beside the factor, at the places of the presses.
  std::vector<std::pair<Vec3, Vec3>> off;

  // The same at a place of the body: a mesh is too stiff here more than there, and to one side.
  Vec3 off_at(const Vec3& place) const;
};

// Press by press, measured against model. A press counts when the next begins.
class PressFactors {
 public:
  // The next sample of a press at a place of the body, which began at sample `begun` of the stream.
  void add(std::int32_t press, std::size_t begun, const Vec3& place, const Vec3& model,
           const Vec3& measured);
  // From the presses that began before sample `before`; `share` of the force where they are few.
  UsualStiffness usual(std::size_t before, double share) const;

  void clear() { presses_.clear(); }

 private:
  struct Sums {
    std::int32_t press = 0;
    std::size_t begun = 0;
    Vec3 place = Vec3::Zero();
    double mm = 0, fm = 0;
    Vec3 m = Vec3::Zero(), f = Vec3::Zero();  // sums over the size of the model's force
  };
  std::vector<Sums> presses_;
};

}  // namespace hapsim
