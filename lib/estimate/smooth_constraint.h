// A constraint between unknowns.
#pragma once

#include <functional>

#include "estimate/expression.h"

namespace hapsim {

struct SmoothConstraint {
  std::function<Taylor(const Eigen::VectorXd& x)> at;  // g, by all unknowns
  bool equality = false;                               // g = 0; else g >= 0
};

}  // namespace hapsim
