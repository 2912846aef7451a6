// The derivatives of a whole model's forces against central differences.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "experiment/forces.h"
#include "experiment/workspace.h"

namespace hapsim::test {

inline void expect_derivatives(const Workspace& w, const Model& model, const Selection& selection) {
  const Signal signal = model_forces(model, w.dataset, selection, *w.body, true);
  const std::vector<int> free = model.free_parameters();
  for (std::size_t c = 0; c < free.size(); ++c) {
    const double value = model.parameters[free[c]].value;
    // Small against lengths of millimetres as well.
    const double step = 1e-5 * (value != 0 ? std::abs(value) : 1e-2);
    const auto forces = [&](double change) {
      Model other = model;
      other.parameters[free[c]].value += change;
      return model_forces(other, w.dataset, selection, *w.body, false).f;
    };
    const Eigen::VectorXd difference = (forces(step) - forces(-step)) / (2 * step);
    EXPECT_LT((signal.df.col(static_cast<Eigen::Index>(c)) - difference).norm(),
              1e-5 * difference.norm() + 1e-12)
        << model.parameters[free[c]].name;
  }
}

}  // namespace hapsim::test
