// What effects with no law have learned: curves with their bands.
#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "model/model.h"

namespace hapsim {

struct LearnedCurveBand {
  std::string effect, name, x_name, x_unit, y_name, y_unit;  // name: of the axis, or ""
  std::vector<double> x, y, low, high;                       // SI; low and high: 95 %
};

// Of all learned effects of a model. The bands are of the parameters' standard errors, taken for
// independent, and of the curve's few knots; where one is not known the band is not either (NaN).
std::vector<LearnedCurveBand> learned_curves(const Model& model);
// effect,curve,x,x_unit,y,y_unit,low,high
void write_curves(std::ostream& out, const Model& model);
// "factor 0.82 at 0.5 mm, 1 at 2 mm, ...": some points of each.
std::string curve_words(const LearnedCurveBand& curve);

}  // namespace hapsim
