// One tool on a prepared body: the force of every sample within microseconds.
#pragma once

#include <array>

#include "realtime/prepared_body.h"
#include "realtime/tool_loop.h"

namespace hapsim {

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
// (RelaxationSpectrum). `body` must outlive the loop.
class ForceLoop : public ToolLoop {
 public:
  explicit ForceLoop(const PreparedBody& body, const ToolLoopOptions& options = {});

  ForceLoopState state() const;
  void restore(const ForceLoopState& state) noexcept;
  // From the next sample on: factors of the Maxwell elements' moduli and of their times.
  void set_relaxation(double moduli, double times) noexcept { moduli_ = moduli, times_ = times; }

 protected:
  void take_place(const Place& place) noexcept override;
  void forget() noexcept override { state_.begun = false; }
  Vec3 advance(double t, const Vec3& u) noexcept override;

 private:
  const PreparedBody& body_;
  ForceLoopState state_;
  double moduli_ = 1, times_ = 1;
};

}  // namespace hapsim
