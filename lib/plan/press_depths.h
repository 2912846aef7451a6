// How deep the next presses go.
#pragma once

#include <string>

#include "mesh/signed_distance.h"
#include "recording/recording.h"

namespace hapsim {

// Error(kBadInput) with the line: a contact point farther off the surface than three radii of the
// tool (of 1 cm at least), which no tool that fits could be pressed at.
void require_on_body(const SignedDistance& surface, const Recording& recording);

// How far presses so far went into the surface, along its normals [m]; 0: none did. Sideways and in
// the air is no depth.
double deepest_so_far(const SignedDistance& surface, const Recording& so_far);

// The deepest that a press of a plan goes: as asked for, no more than half of the way through the
// body where it is pressed; otherwise as deep as presses so far went into the surface, at first
// 1.125 radii of the tool and 0.15 of the body's least extent at most, and no more than a third of
// the way.
class PressDepths {
 public:
  // `asked` [m]; 0: not. Keeps `surface`.
  PressDepths(const SignedDistance& surface, const Recording& so_far, double asked);
  double deepest() const { return deepest_; }  // anywhere [m]
  // Of the deepest path at a place of the surface with that outward normal.
  double deepest_at(const Vec3& point, const Vec3& normal) const;
  // Of a full press there, which press_paths() goes beyond.
  double full_at(const Vec3& point, const Vec3& normal) const;
  // What is said of a place where the body is too thin for the deepest; "" elsewhere.
  std::string shallower_words(const Vec3& point) const;

 private:
  const SignedDistance& surface_;
  double deepest_, share_;
};

}  // namespace hapsim
