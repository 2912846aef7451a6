// The derivatives of a whole model's forces against central differences.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "experiment/experiment.h"
#include "experiment/forces.h"

namespace hapsim::test {

// About the model's own material; or about `known`, where it is given.
inline void expect_derivatives(const Experiment& w, const Model& model, const Selection& selection,
                               Linearisation known = {}) {
  if (known.empty()) known = w.places.solve(material_of(model));
  const Signal signal = model_forces(model, w, known, selection, true);
  const std::vector<int> free = model.free_parameters();
  for (std::size_t c = 0; c < free.size(); ++c) {
    const double value = model.parameters[free[c]].value;
    // Small against lengths of millimetres as well.
    const double step = 1e-5 * (value != 0 ? std::abs(value) : 1e-2);
    const auto forces = [&](double change) {
      Model other = model;
      other.parameters[free[c]].value += change;
      return model_forces(other, w, known, selection, false).f;
    };
    const Eigen::VectorXd difference = (forces(step) - forces(-step)) / (2 * step);
    EXPECT_LT((signal.df.col(static_cast<Eigen::Index>(c)) - difference).norm(),
              1e-5 * difference.norm() + 1e-12)
        << model.parameters[free[c]].name;
  }
}

}  // namespace hapsim::test
