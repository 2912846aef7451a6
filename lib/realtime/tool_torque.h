// The torque on a tool in time: what the body gives at once, and what its Maxwell elements
// remember.
#pragma once

#include <algorithm>
#include <array>

#include "material/maxwell_memory.h"
#include "realtime/prepared_body.h"

namespace hapsim {

class ToolTorque {
 public:
  explicit ToolTorque(const PreparedBody& body) : body_(body) {}

  // From here on of this place, whose stiffness is `K`: where regions relax apart, an element's
  // share is that of the force there.
  void take_place(int face, const Vec3& point, const Eigen::Matrix3d& K) noexcept {
    if (!body_.is_regional()) return;
    std::array<Eigen::Matrix3d, PreparedBody::kMostTerms> element;
    body_.maxwell_at(face, point, element.data());
    for (std::size_t i = 0; i < body_.terms().size(); ++i)
      share_[i] = element[i].trace() / K.trace();
  }
  void forget() noexcept { begun_ = false; }  // relaxed from here on

  // Of the elastic torque at t [s], straight since the last sample.
  Vec3 advance(double t, const Vec3& elastic) noexcept {
    Vec3 torque = elastic;
    for (std::size_t i = 0; i < std::min(body_.terms().size(), memory_.size()); ++i) {
      const MaxwellTerm& term = body_.terms()[i];
      if (begun_) {
        const MemoryStep s = memory_step(std::max(0.0, t - t_), term.tau);
        memory_[i] = s.a * memory_[i] + s.c * (elastic - elastic_);
      } else {
        memory_[i] = elastic;
      }
      torque += (body_.is_regional() ? share_[i] : term.share) * memory_[i];
    }
    begun_ = true;
    t_ = t;
    elastic_ = elastic;
    return torque;
  }

 private:
  const PreparedBody& body_;
  std::array<double, PreparedBody::kMostTerms> share_{};
  std::array<Vec3, PreparedBody::kMostTerms> memory_{};
  Vec3 elastic_ = Vec3::Zero();
  double t_ = 0;
  bool begun_ = false;
};

}  // namespace hapsim
