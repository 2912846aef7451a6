// One tool on a prepared body: the force of every sample within microseconds.
#pragma once

#include <array>

#include "geometry/tool_contact.h"
#include "realtime/prepared_body.h"

namespace hapsim {

struct ForceLoopOptions {
  ToolContactOptions contact;  // of step(): radius, release, sliding
  bool relaxed = true;         // the body is relaxed before each contact; false: it remembers
};

// All that a loop remembers: plain data, to be stored and gone on from.
struct ForceLoopState {
  ToolState tool;
  Vec3 anchor = Vec3::Zero();                   // contact point on the surface [m]
  Vec3 normal = Vec3::UnitZ();                  // outward there
  Eigen::Matrix3d K = Eigen::Matrix3d::Zero();  // stiffness there [N/m]
  double t = 0;                                 // of the last sample [s]
  bool begun = false;                           // there was a sample
  // Of the Maxwell elements: the force that each remembers of and what it remembers [N]; where
  // regions relax each in its own way, their stiffnesses there [N/m].
  std::array<Vec3, PreparedBody::kMostTerms> driver = {}, h = {};
  std::array<Eigen::Matrix3d, PreparedBody::kMostTerms> maxwell = {};
};

// f = f_e + sum_i (E_i/E) h_i with f_e = -K u, h_i the memory of f_e: the step of the batch mode
// (viscoelastic effect, memory.h), exact for motion that is straight between samples, for any time
// steps. Where regions relax each in its own way f = f_e + sum_j h_j, h_j the memory of -K_j u
// (RelaxationSpectrum). step() and
// press() allocate nothing, lock nothing, throw nothing and make no system call. `body` must
// outlive the loop. Not to be shared between threads; one loop a tool.
class ForceLoop {
 public:
  explicit ForceLoop(const PreparedBody& body, const ForceLoopOptions& options = {});

  // The tool at `tool` [m] at time t [s], anywhere: finds whether and where it touches. Force of
  // the body on the tool [N], zero away from it. A sample that is not finite repeats the last
  // position; time that runs backwards counts as no time.
  Vec3 step(double t, const Vec3& tool) noexcept;

  // A recorded motion instead, whose contact point is known: begin() at each new press, then its
  // displacements u [m] from that point. `in_air`: no contact.
  void begin(const Vec3& contact) noexcept;
  Vec3 press(double t, const Vec3& u, bool in_air = false) noexcept;

  const ForceLoopState& state() const { return state_; }
  void restore(const ForceLoopState& state) noexcept;

 private:
  void take_stiffness(int face) noexcept;  // at the anchor
  Vec3 advance(double t, const Vec3& u) noexcept;

  const PreparedBody& body_;
  ForceLoopOptions options_;
  ToolContact contact_;
  ForceLoopState state_;
};

}  // namespace hapsim
