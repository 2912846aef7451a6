// One tool on a prepared body: the force of every sample within microseconds.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "effects/effect_step.h"
#include "realtime/prepared_body.h"
#include "realtime/tool_loop.h"

namespace hapsim {

// All that a loop remembers: plain data, to be stored and gone on from.
struct ForceLoopState {
  ToolState tool;
  StepPlace place;         // contact point on the surface, and what is known of the body there
  bool placed = false;     // there was one
  double uncertainty = 0;  // FieldEntry::uncertainty
  bool sampled = true;     // not kBeyondPlaces
  double t = 0;            // of the last sample [s]
  double press = 0, session = 0;  // when this press and the whole began [s]
  int number = 0;                 // of the press, from 1; 0: there was no sample yet
  bool begun = false;             // the press has had a sample
  // Where regions relax each in its own way: of the Maxwell elements the force that each remembers
  // of and what it remembers [N], and their stiffnesses there [N/m].
  std::array<Vec3, PreparedBody::kMostTerms> driver = {}, h = {};
  std::array<Eigen::Matrix3d, PreparedBody::kMostTerms> maxwell = {};
  std::vector<double> memory;  // of the effects' steps, then of large strain and of its slip
  // Of large strain: the axes in which that is [1].
  Eigen::Matrix3d frame = Eigen::Matrix3d::Identity();
};

// The batch mode (experiment/forces.h) sample by sample: the motion effects, f = -K u, then the
// other effects in the order of their stages, each by its own step (EffectStep). Where regions
// relax each in its own way f = -K u + sum_j h_j, h_j the memory of -K_j u (RelaxationSpectrum).
// Exact for motion that is straight between samples, for any time steps. Away from the body it
// exerts nothing, and the sensor has its errors. `body` must outlive the loop.
class ForceLoop : public ToolLoop {
 public:
  explicit ForceLoop(const PreparedBody& body, const ToolLoopOptions& options = {});

  ForceLoopState state() const;
  // Of a loop on the same body with the same options.
  void restore(const ForceLoopState& state) noexcept;
  // From the next sample on: a factor of the body's force, and factors of the Maxwell elements'
  // moduli beside that and of their times.
  void set_body(double stiffness, double moduli, double times) noexcept {
    stiffness_ = stiffness, moduli_ = moduli, times_ = times;
  }

 protected:
  void take_place(const Place& place) noexcept override;
  void forget() noexcept override { state_.begun = false; }
  Vec3 advance(double t, const Vec3& u) noexcept override { return advance(t, u, false); }
  Vec3 advance_in_air(double t, const Vec3& u) noexcept override { return advance(t, u, true); }

 private:
  struct Running {
    std::unique_ptr<EffectStep> step;
    Stage stage;
    std::size_t memory;  // where its own begins
  };
  static std::vector<Running> steps_of(const PreparedBody& body, const ToolLoopOptions& options);
  ForceLoop(const PreparedBody& body, const ToolLoopOptions& options, std::vector<Running> steps);
  Vec3 body_force(const StepSample& sample, const Vec3& u, double& doubt) noexcept;
  StepSample next_sample(double t, const Vec3& u, bool in_air) noexcept;
  Vec3 regional_memory(const StepSample& sample, const Vec3& u) noexcept;
  void strain_memory(const StepSample& sample, const Vec3& u, LargeStrain::Force& f) noexcept;
  // What moves a tool that holds, by sampled elements.
  LargeStrain::Force strained(const StepSample& sample, const Vec3& u) noexcept;
  // The same of a tool that slips, |f_t| <= mu f_n: rings that slip (rim_slip.h), by what moves a
  // tool that holds.
  LargeStrain::Force slide(const StepSample& sample, const Vec3& u) noexcept;
  void take_strain(const Vec3& before) noexcept;
  Vec3 advance(double t, const Vec3& u, bool in_air) noexcept;

  const PreparedBody& body_;
  std::vector<Running> steps_;
  ForceLoopState state_;
  LargeStrain::Place strain_;       // of state_.place
  LargeStrain::Memory remembered_;  // where the body relaxes too
  std::size_t strain_memory_ = 0;   // where its own begins in state_.memory
  std::size_t slip_memory_ = 0;     // and where that of slip does
  std::vector<double> before_;      // strain's own, while slip is found
  bool touches_otherwise_ = false;  // than what was pressed beforehand (large_strain.h)
  double stiffness_ = 1, moduli_ = 1, times_ = 1;
};

}  // namespace hapsim
