#include "realtime/explain_change.h"

#include <algorithm>
#include <cmath>

#include "realtime/shift_fit.h"

namespace hapsim {
namespace {

constexpr double kNothing = 0.05;  // a body that has lost all but this is gone
constexpr double kTogether = 20;   // samples that err together
constexpr double kExplained = 9;   // chi-square a component above which nothing explains

struct Hypothesis {
  Change change;
  Correction correction;
  int parameters;
  ShiftFit fit = {};
};

// Factor of all moduli, in closed form; false where too little is left.
bool fit_stiffness(const std::vector<WatchedSample>& window, const std::vector<Vec3>& forces,
                   Correction& c) {
  double fm = 0, ff = 0;
  for (std::size_t i = 0; i < window.size(); ++i) {
    if (!window[i].counted) continue;
    const Vec3 body = forces[i] - c.bias;
    const double weight = 1 / (window[i].size * window[i].size);
    fm += weight * body.dot(window[i].measured - c.bias);
    ff += weight * body.squaredNorm();
  }
  if (ff <= 0 || fm <= kNothing * ff) return false;
  c.stiffness *= fm / ff;
  return true;
}

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
  std::vector<Hypothesis> all;
  const std::vector<Vec3> f = corrected_forces(body, offsets, window, there);
  Correction c = there;
  if (fit_stiffness(window, f, c)) all.push_back({Change::kMaterial, c, 1});
  c = there;
  fit_bias(window, f, c);
  all.push_back({Change::kSensor, c, 3});
  c = known;
  c.gone = true;
  all.push_back({Change::kGone, c, 0});
  const ShiftFit moved = fit_shift(body, offsets, window, there, there.shift, usual, true);
  c = there;
  c.shift = moved.shift;
  c.stiffness = moved.stiffness;
  all.push_back({Change::kMoved, c, 4, moved});

  const double n =
      3 * static_cast<double>(std::count_if(window.begin(), window.end(),
                                            [](const WatchedSample& s) { return s.counted; }));
  Explanation best;
  double least = 1e300, next = 1e300;
  for (const Hypothesis& h : all) {
    const std::vector<Vec3> forces = corrected_forces(body, offsets, window, h.correction);
    const double x = chi_square(window, forces);
    // The log of the mean square, so that an error of the model that is common to all does not
    // decide by its size.
    const double criterion = n * std::log(x / n) + h.parameters * std::log(n);
    if (criterion >= least) {
      next = std::min(next, criterion);
      continue;
    }
    next = least;
    least = criterion;
    best = {h.change, h.correction, h.fit.std_error, h.fit.force_error, x / n};
    double squares = 0;
    for (std::size_t i = 0; i < window.size(); ++i)
      if (window[i].counted) squares += (window[i].measured - forces[i]).squaredNorm();
    best.error = std::sqrt(squares / n);
  }
  best.margin = (next - least) / kTogether;
  if (best.chi >= kExplained) best.change = Change::kUnexplained;
  return best;
}

}  // namespace hapsim
