// Two regions whose boundary is any smooth curve, from what modulus each contact position asks for.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <vector>

#include "contact/contact_stiffness.h"
#include "regions/locations.h"
#include "regions/plan_level.h"

namespace hapsim {

struct RegionCurve {
  PlanLevel level;
  Eigen::VectorXd theta;        // of the level, which is positive on the stiffer side
  double log_gain[2] = {0, 0};  // of the modulus on either side, over the model's
  double bend = 0;              // standard deviation that each mode has before the data
  double criterion = 0;  // squares over the samples' errors, and log n for each parameter told
  int region(const Eigen::Vector2d& p) const { return level.value(p, theta) > 0 ? 1 : 0; }
};

// A priori every mode of the level varies as much (`bend`), which the evidence of the samples
// chooses (MacKay, Neural Computation 4, 1992): one that hardly varies is a straight line. As in
// find_boundary() a sample has the mean of log E weighted by its shares of the energy. Starts from
// where the samples' own values cross the middle, and from `side` (signs) where that is given.
// Nothing for fewer than six samples, for places on one line, or where one side has no sample.
std::optional<RegionCurve> find_curve(const std::vector<LocationSample>& samples,
                                      const std::vector<std::vector<float>>& share,
                                      const PlanGrid& grid,
                                      const std::function<int(const Eigen::Vector2d&)>& side = {});

// From 0 to 1 over `width` about 0, with a continuous slope; and that slope.
struct SmoothStep {
  double value = 0, slope = 0;
};
SmoothStep smooth_step(double distance, double width);

}  // namespace hapsim
