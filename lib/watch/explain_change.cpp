#include "watch/explain_change.h"

#include <algorithm>
#include <cmath>

#include "estimate/information.h"
#include "watch/material_fit.h"
#include "watch/shift_fit.h"

namespace hapsim {
namespace {

constexpr double kExplained = 9;  // chi-square a component above which nothing explains

struct Hypothesis {
  Change change;
  Correction correction;
  std::size_t parameters;
  ShiftFit fit = {};
  Eigen::VectorXd residual = {};  // of the counted samples, over the usual size
};

void fit_bias(const std::vector<WatchedSample>& window, const std::vector<Vec3>& forces,
              Correction& c) {
  Vec3 mean = Vec3::Zero();
  double weights = 0;
  for (std::size_t i = 0; i < window.size(); ++i) {
    if (!window[i].counted) continue;
    const double weight = 1 / (window[i].size * window[i].size);
    mean += weight * (window[i].measured - forces[i]);
    weights += weight;
  }
  c.bias += mean / weights;
}

// Of the presses, as far as they are counted.
std::vector<Eigen::Index> counted_lengths(const std::vector<WatchedSample>& window) {
  const std::vector<std::size_t> press = press_indices(window);
  std::vector<Eigen::Index> lengths(press.back() + 1, 0);
  for (std::size_t i = 0; i < window.size(); ++i)
    if (window[i].counted) ++lengths[press[i]];
  return lengths;
}

Eigen::VectorXd counted_residuals(const std::vector<WatchedSample>& window,
                                  const std::vector<Vec3>& forces) {
  Eigen::VectorXd r(3 * static_cast<Eigen::Index>(window.size()));
  Eigen::Index n = 0;
  for (std::size_t i = 0; i < window.size(); ++i)
    if (window[i].counted)
      r.segment<3>(3 * n++) = (window[i].measured - forces[i]) / window[i].size;
  r.conservativeResize(3 * n);
  return r;
}

// By one factor; or those that relax and their times each by their own.
std::vector<Hypothesis> materials(const PreparedBody& body, const SurfaceOffsets& offsets,
                                  const std::vector<WatchedSample>& window,
                                  const Correction& known) {
  std::vector<Hypothesis> all;
  Correction c = known;
  if (fit_stiffness(body, offsets, window, c)) all.push_back({Change::kMaterial, c, 1});
  c = known;
  if (!body.terms().empty() && fit_relaxation(body, offsets, window, c))
    all.push_back({Change::kMaterial, c, 3});
  return all;
}

// The one with the least criterion.
Explanation judge(const PreparedBody& body, const SurfaceOffsets& offsets,
                  const std::vector<WatchedSample>& window, std::vector<Hypothesis>& all) {
  const std::vector<Eigen::Index> lengths = counted_lengths(window);
  const Hypothesis* least = nullptr;
  for (Hypothesis& h : all) {
    h.residual = counted_residuals(window, corrected_forces(body, offsets, window, h.correction));
    if (least == nullptr || h.residual.squaredNorm() < least->residual.squaredNorm()) least = &h;
  }
  // As in the diagnosis of few presses: what no hypothesis explains must not decide by its size,
  // and neighbouring samples err together.
  const auto n = static_cast<double>(least->residual.size());
  const double scale = std::max(1.0, least->residual.squaredNorm() / n);
  const double memory = autocorrelation_time(least->residual, lengths);
  const double independent = independent_samples(least->residual, memory);
  const Hypothesis* believed = nullptr;
  double first = 1e300;
  for (const Hypothesis& h : all) {
    const double criterion =
        information_criterion(h.residual.squaredNorm() / scale, memory, independent, h.parameters);
    if (criterion < first) first = criterion, believed = &h;
  }
  const double squares = believed->residual.squaredNorm();
  Explanation best{believed->change, believed->correction, believed->fit.std_error,
                   believed->fit.force_error, squares / n};
  best.margin = 1e300;
  for (const Hypothesis& h : all)
    if (h.change != believed->change)
      best.margin = std::min(best.margin, (h.residual.squaredNorm() - squares) / scale / memory);
  best.error = error_of(window, corrected_forces(body, offsets, window, best.correction));
  if (best.chi >= kExplained) best.change = Change::kUnexplained;
  return best;
}

}  // namespace

std::string change_name(Change change) {
  switch (change) {
    case Change::kMoved:
      return "moved";
    case Change::kGone:
      return "gone";
    case Change::kMaterial:
      return "material";
    case Change::kSensor:
      return "sensor";
    case Change::kUnexplained:
      return "unexplained";
    default:
      return "none";
  }
}

Explanation explain_change(const PreparedBody& body, const SurfaceOffsets& offsets,
                           const std::vector<WatchedSample>& window, const Correction& known,
                           const UsualStiffness& usual) {
  Correction there = known;  // what was gone may be back
  there.gone = false;
  std::vector<Hypothesis> all = materials(body, offsets, window, there);
  Correction c = there;
  fit_bias(window, corrected_forces(body, offsets, window, there), c);
  all.push_back({Change::kSensor, c, 3});
  c = known;
  c.gone = true;
  all.push_back({Change::kGone, c, 0});
  const ShiftFit moved = fit_shift(body, offsets, window, there, there.shift, usual, true);
  c = there;
  c.shift = moved.shift;
  c.stiffness = moved.stiffness;
  all.push_back({Change::kMoved, c, 4, moved});
  return judge(body, offsets, window, all);
}

Explanation explain_material(const PreparedBody& body, const SurfaceOffsets& offsets,
                             const std::vector<WatchedSample>& window, const Correction& known) {
  Correction there = known;
  there.gone = false;
  std::vector<Hypothesis> all = materials(body, offsets, window, there);
  if (all.empty()) all.push_back({Change::kMaterial, there, 0});
  return judge(body, offsets, window, all);
}

}  // namespace hapsim
