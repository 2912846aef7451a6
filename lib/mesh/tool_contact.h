// A tool that moves about a body: when and where it touches.
#pragma once

#include "mesh/signed_distance.h"

namespace hapsim {

struct ToolContactOptions {
  double radius = 0;  // of a spherical tip about the tool's position [m]; 0: a point
  double release =
      0;  // a touching tool leaves at this distance outside [m]; noise must not part it
  // The contact point stays where the tool first touched (the measured presses of hapsim), or
  // follows the tool along the surface, over edges too.
  bool slides = false;
};

enum class ContactPhase { kAway, kBegan, kHeld, kEnded };

struct ToolState {
  ContactPhase phase = ContactPhase::kAway;
  int episode = 0;      // counts contacts from 1; 0: none yet
  SurfaceSide surface;  // nearest surface point of the tool now; distance less the tip's radius
  Vec3 anchor = Vec3::Zero();        // contact point on the undeformed surface, while touching [m]
  Vec3 displacement = Vec3::Zero();  // of the tip from there: (ux, uy, uz) of a recording [m]
  bool touching() const { return phase == ContactPhase::kBegan || phase == ContactPhase::kHeld; }
};

// Follows one tool by its positions, one a time step. update() allocates nothing and throws
// nothing; about a microsecond, so that a 1 kHz loop may call it. `body` must outlive it.
class ToolContact {
 public:
  explicit ToolContact(const SignedDistance& body, const ToolContactOptions& options = {})
      : body_(body), options_(options) {}
  const ToolState& update(const Vec3& tool) noexcept;
  const ToolState& state() const { return state_; }
  // Goes on from a stored state (of a contact with the same body and options).
  void restore(const ToolState& state) noexcept { state_ = state; }

 private:
  const SignedDistance& body_;
  ToolContactOptions options_;
  ToolState state_;
};

}  // namespace hapsim
