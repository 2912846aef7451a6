#include "fit/ridge.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "effects/catalogue.h"
#include "fit/fit_uncertainty.h"
#include "model/interval.h"
#include "model/model_edit.h"

namespace hapsim {
namespace {

// The way that a parameter has gone, in logarithms where it is stepped so.
double way(const Parameter& p, double to) {
  return is_logarithmic(p) && to > 0 ? std::log(to / p.value) : to - p.value;
}

std::string value_of(const Parameter& p, double value) {
  return fmt::format("{} {:.2g}{}", p.name, value, p.unit == "1" ? "" : " " + p.unit);
}

// "layer: thickness 0.00046 m with ratio 7.4 fits as thickness 0.0028 m with ratio 2.8 does".
std::string trade_words(const Model& model, const Ridge& ridge) {
  constexpr double kMoves = 0.1;  // of its logarithm
  const std::vector<int> free = model.free_parameters();
  const Parameter& own =
      model.parameters[static_cast<std::size_t>(free[static_cast<std::size_t>(ridge.which)])];
  const auto by_own = [&](const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
    return a[ridge.which] < b[ridge.which];
  };
  const auto [low, high] = std::minmax_element(ridge.along.begin(), ridge.along.end(), by_own);
  std::string one, other, names;
  for (std::size_t c = 0; c < free.size(); ++c) {
    const Parameter& p = model.parameters[static_cast<std::size_t>(free[c])];
    const auto k = static_cast<Eigen::Index>(c);
    if (k == ridge.which || p.effect != own.effect || !is_logarithmic(p)) continue;
    if (std::abs(std::log((*high)[k] / (*low)[k])) < kMoves) continue;
    names += " and " + p.name;
    one += " with " + value_of(p, (*low)[k]);
    other += " with " + value_of(p, (*high)[k]);
  }
  if (names.empty()) return "";
  return fmt::format("{} {}{} trade for each other: {}{} fits nearly as {}{} does", own.effect,
                     own.name, names, value_of(own, (*low)[ridge.which]), one,
                     value_of(own, (*high)[ridge.which]), other);
}

}  // namespace

bool may_have_ridge(const Parameter& p) {
  const Effect& effect = require_effect(p.effect);
  return effect.card().solved && parameter_card(effect, p.name)->logarithmic;
}

bool has_ridges(const Model& model) {
  return std::any_of(model.parameters.begin(), model.parameters.end(), [](const Parameter& p) {
    return p.state == ParameterState::kFree && may_have_ridge(p);
  });
}

void set_ridge_errors(Fit& fitted, const Ridge& ridge, const Eigen::MatrixXd& bread,
                      const Eigen::MatrixXd& covariance) {
  Model& model = fitted.model;
  const std::vector<int> free = model.free_parameters();
  const Eigen::Index w = ridge.which;
  for (std::size_t c = 0; c < free.size(); ++c) {
    Parameter& p = model.parameters[static_cast<std::size_t>(free[c])];
    const auto k = static_cast<Eigen::Index>(c);
    const double slope = is_logarithmic(p) ? p.value : 1;
    if (k == w) {
      const double half = std::max(std::log(ridge.high / p.value), std::log(p.value / ridge.low));
      // A fit on the way that has not come to its end rises too early: no shorter than the
      // parabola.
      if (const double error = p.value * half / kHalf95; !(error < p.std_error))
        p.std_error = error;
      if (!ridge.open_low || !ridge.open_high) continue;
      p.std_error = std::numeric_limits<double>::quiet_NaN();
      const std::string name = parameter_label(p);
      if (std::find(fitted.undetermined.begin(), fitted.undetermined.end(), name) ==
          fitted.undetermined.end())
        fitted.undetermined.push_back(name);
      continue;
    }
    double extent = 0;
    for (const Eigen::VectorXd& x : ridge.along) extent = std::max(extent, std::abs(way(p, x[k])));
    const double along = bread(w, w) > 0 ? bread(k, w) / bread(w, w) : 0;
    const double beside =
        std::max(0.0, covariance(k, k) - along * along * covariance(w, w)) / (slope * slope);
    const double error = slope * std::sqrt(extent * extent / (kHalf95 * kHalf95) + beside);
    // What is at its bound or not seen has none; one that the curvature has made larger stays.
    if (error > p.std_error) p.std_error = error;
  }
  if (const std::string words = trade_words(model, ridge); !words.empty())
    fitted.blind.push_back(words);
}

}  // namespace hapsim
