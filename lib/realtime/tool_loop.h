// A tool in contact, sample by sample, whatever model answers it.
#pragma once

#include "mesh/tool_contact.h"

namespace hapsim {

struct ToolLoopOptions {
  ToolContactOptions contact;  // of step(): radius, release, sliding
  bool relaxed = true;         // the body is relaxed before each contact; false: it remembers
};

// Finds the contact and hands displacements to a model. step(), begin() and press() allocate
// nothing, lock nothing, throw nothing and make no system call. Not to be shared between threads;
// one loop a tool.
class ToolLoop {
 public:
  // `surface` of the body, outlives the loop; null where only begin() and press() are used.
  ToolLoop(const SignedDistance* surface, const ToolLoopOptions& options);
  virtual ~ToolLoop() = default;

  // The tool at `tool` [m] at time t [s], anywhere: finds whether and where it touches. Force of
  // the body on the tool [N], zero away from it. A sample that is not finite repeats the last
  // position; time that runs backwards counts as no time.
  Vec3 step(double t, const Vec3& tool) noexcept;

  // A recorded motion instead, whose contact point is known: begin() at each new press, then its
  // displacements u [m] from that point. `in_air`: no contact.
  void begin(const Vec3& contact) noexcept;
  Vec3 press(double t, const Vec3& u, bool in_air = false) noexcept;

  const ToolState& tool() const { return contact_.state(); }

 protected:
  // Where the tool presses. Without a surface the normal is zero and the face -1.
  struct Place {
    Vec3 point = Vec3::Zero(), normal = Vec3::Zero();
    int face = -1;
  };
  virtual void take_place(const Place& place) noexcept = 0;
  virtual void forget() noexcept = 0;  // relaxed from here on
  virtual Vec3 advance(double t, const Vec3& u) noexcept = 0;

  void restore_tool(const ToolState& state) noexcept { contact_.restore(state); }

 private:
  const SignedDistance* surface_;
  ToolLoopOptions options_;
  ToolContact contact_;
};

}  // namespace hapsim
