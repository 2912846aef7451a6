// What a stiffness and a law of each place's own could do.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "diagnose/trial_ground.h"
#include "fit/fit.h"

namespace hapsim {

// Where a model learns a field, each place has a stiffness and a power of the depth of its own, and
// whatever looks like them is no evidence for another effect. Nor is it known better where a press
// begins, which law the depth has, or what the body does sideways at its own place. So, axis by
// axis, a force that is constant in contact, or goes with the model's force |f| or with |f| times
// ln d or its square, tells of nothing but the place. The air does, well above the first touch, and
// a way out, speed, time, and presses of other directions there.
class PlaceFreedom {
 public:
  // Without a field that is learned: nothing, unless `asked` for.
  PlaceFreedom(const Fit& fitted, const TrialGround& ground, const Eigen::VectorXd& forces,
               const Weights& weights, bool asked = false);
  bool any() const { return !places_.empty(); }
  // Of whitened columns (stacked rows), in place.
  void take_out(Eigen::Ref<Eigen::MatrixXd> columns) const;

 private:
  struct Place {
    std::vector<Eigen::Index> rows;
    Eigen::MatrixXd Q;  // orthonormal
  };
  std::vector<Place> places_;
};

}  // namespace hapsim
