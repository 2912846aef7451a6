#include "acfm/acfm_loop.h"

#include <cmath>

#include "material/maxwell_memory.h"

namespace hapsim {

AcfmLoop::AcfmLoop(const Acfm& model, const SignedDistance* surface, const ToolLoopOptions& options)
    : ToolLoop(surface, options), model_(model) {
  h_.fill(Vec3::Zero());
}

void AcfmLoop::take_place(const Place& place) noexcept {
  sub_ = model_.at(place.point);
  const Eigen::Matrix3d frame = acfm_frame(place.face >= 0 ? place.normal : sub_.normal);
  // What is remembered goes on when the contact slides.
  const Eigen::Matrix3d turn = frame.transpose() * frame_;
  u_ = turn * u_;
  for (Vec3& h : h_) h = turn * h;
  frame_ = frame;
}

Vec3 AcfmLoop::advance(double t, const Vec3& u) noexcept {
  Vec3 now = frame_.transpose() * u;
  const double size = u.norm();
  for (Eigen::Index a = 0; a < 3; ++a)
    now[a] *= stiffening_at(sub_.axis[static_cast<std::size_t>(a)].stiffening(), size).factor;
  const bool first = !begun_;
  const double dt = t > t_ ? t - t_ : 0;
  Vec3 force = Vec3::Zero();
  for (Eigen::Index a = 0; a < 3; ++a) {
    const AcfmAxis& axis = sub_.axis[static_cast<std::size_t>(a)];
    force[a] = axis.spring() * now[a];
    if (std::isnan(t)) continue;
    for (int i = 0; i < model_.terms; ++i) {
      double& h = h_[static_cast<std::size_t>(i)][a];
      if (first) {
        h = axis.k(i) * now[a];  // relaxed until now, then a jump
      } else {
        const MemoryStep s = memory_step(dt, axis.tau(i));
        h = s.a * h + s.c * axis.k(i) * (now[a] - u_[a]);
      }
      force[a] += h;
    }
  }
  u_ = now;
  if (first || t > t_) t_ = t;
  begun_ = true;
  return -(frame_ * force);
}

}  // namespace hapsim
