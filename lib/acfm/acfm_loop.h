// The forces of an analytical contact force model along a motion.
#pragma once

#include "acfm/acfm.h"
#include "realtime/tool_loop.h"

namespace hapsim {

// Exact for motion that is straight between samples, for any time steps: h(t + dt) = e^(-dt/tau) h
// + k (tau/dt) (1 - e^(-dt/tau)) du, as (3.54); the explicit step (4.39) is unstable for dt > 2
// tau. A contact that has no time (NaN) is of its springs alone. The sub-model is interpolated when
// the contact is taken. `model` must outlive the loop.
class AcfmLoop : public ToolLoop {
 public:
  // `surface` of the body, null where contact points are given; it gives the normals.
  explicit AcfmLoop(const Acfm& model, const SignedDistance* surface = nullptr,
                    const ToolLoopOptions& options = {});
  const SubModel& sub_model() const { return sub_; }

 protected:
  void take_place(const Place& place) noexcept override;
  void forget() noexcept override { begun_ = false; }
  Vec3 advance(double t, const Vec3& u) noexcept override;

 private:
  const Acfm& model_;
  SubModel sub_;
  Eigen::Matrix3d frame_ = Eigen::Matrix3d::Identity();
  std::array<Vec3, AcfmAxis::kMostTerms> h_;  // [N] over -1, along the frame's axes
  Vec3 u_ = Vec3::Zero();                     // q of the last sample, in the frame
  double t_ = 0;
  bool begun_ = false;
};

}  // namespace hapsim
