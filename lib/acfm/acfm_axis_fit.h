// One axis of an analytical model from what was recorded along it.
#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "acfm/acfm.h"
#include "experiment/dataset.h"

namespace hapsim {

using Episodes = std::vector<const Episode*>;

// What one axis saw: sample by sample, the presses one after the other.
struct AxisData {
  Eigen::VectorXd u, f;    // [m], [N]
  Eigen::VectorXd size;    // |u| of the whole displacement [m]
  std::vector<double> dt;  // [s] since the sample before; negative: a press begins
  double moved = 0;        // root of the sum of squares [m]
};

AxisData axis_data(const Dataset& dataset, const Episodes& episodes, const Vec3& direction);

// Of the relaxation times, one a Maxwell element: from, to [s].
using Windows = std::vector<std::pair<double, double>>;

// Times to start from: across `low` to `high` together, or, where windows are `given`, each in its
// own.
std::vector<std::vector<double>> time_starts(const Windows& windows, double low, double high,
                                             bool given);

struct AxisFit {
  AcfmAxis axis;
  bool undetermined = false;
};

// The best of fits from several times; `sorted`: the elements by their times. `noise` of the force
// [N], `stiffening`: springs stiffen with the displacement.
AxisFit fit_axis(const AxisData& data, const Windows& windows,
                 const std::vector<std::vector<double>>& times, bool sorted, double noise,
                 bool stiffening);

}  // namespace hapsim
