// The loop beside the batch mode at places that were prepared for it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>

#include "experiment/forces.h"
#include "realtime/force_loop.h"
#include "support/every_effect.h"

namespace hapsim::test {

// Row `from` of the recording and those after it; `each` is told every force.
template <class Each>
void run_live(ForceLoop& loop, const Dataset& dataset, std::size_t from, const Each& each) {
  const Recording& r = dataset.recording;
  for (std::size_t i = from; i < r.rows(); ++i) {
    if (i == 0 || r.press[i] != r.press[i - 1]) loop.begin(r.position[i]);
    loop.set_temperature(r.temp[i]);
    each(i, loop.press(r.t[i], r.u[i], r.in_air(i)));
  }
}

inline Eigen::VectorXd batch_forces(const Model& model, const Experiment& experiment) {
  return solved_forces(model, experiment, all_episodes(experiment.dataset), false).f;
}

// The largest difference of the loop from the batch mode over the largest force.
inline double live_difference(const PreparedBody& body, const Experiment& experiment,
                              const Eigen::VectorXd& batch) {
  ForceLoop loop(body);
  double largest = 0;
  run_live(loop, experiment.dataset, 0, [&](std::size_t i, const Vec3& f) {
    largest = std::max(largest, (f - batch.segment<3>(3 * static_cast<Eigen::Index>(i))).norm());
  });
  return largest / batch.cwiseAbs().maxCoeff();
}

}  // namespace hapsim::test
