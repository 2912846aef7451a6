#include "experiment/learned_curves.h"

#include <fmt/format.h>

#include <cmath>

#include "experiment/forces.h"
#include "io/csv.h"
#include "io/number.h"
#include "model/interval.h"

namespace hapsim {
namespace {

// Standard errors in the order of the effect's values; 0 of what is not fitted.
Eigen::VectorXd errors_of(const Model& model, const EffectInstance& instance) {
  Eigen::VectorXd errors = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(instance.values.size()));
  for (std::size_t k = 0; k < instance.values.size(); ++k) {
    const ParameterValue& v = instance.values[k];
    const Parameter* p = model.find(instance.effect->card().name, v.region, v.name);
    if (p != nullptr && p->state == ParameterState::kFree)
      errors[static_cast<Eigen::Index>(k)] = p->std_error;
  }
  return errors;
}

}  // namespace

std::vector<LearnedCurveBand> learned_curves(const Model& model) {
  std::vector<LearnedCurveBand> all;
  for (const EffectInstance& instance : effect_instances(model, false)) {
    const Eigen::VectorXd errors = errors_of(model, instance);
    for (const EffectCurve& curve : instance.effect->curves(instance.values)) {
      LearnedCurveBand band{instance.effect->card().name,
                            curve.name,
                            curve.x,
                            curve.x_unit,
                            curve.y,
                            curve.y_unit,
                            {},
                            {},
                            {},
                            {}};
      for (const CurvePoint& point : curve.points) {
        double square = 0;  // a value that does not act there counts for nothing, known or not
        for (Eigen::Index k = 0; k < errors.size(); ++k)
          if (point.by[k] != 0) square += std::pow(point.by[k] * errors[k], 2);
        const double half = kHalf95 * std::sqrt(square) + point.form;
        band.x.push_back(point.x);
        band.y.push_back(point.y);
        band.low.push_back(point.y - half);
        band.high.push_back(point.y + half);
      }
      all.push_back(std::move(band));
    }
  }
  return all;
}

void write_curves(std::ostream& out, const Model& model) {
  CsvWriter writer(out, {}, {"effect", "curve", "x", "x_unit", "y", "y_unit", "low", "high"});
  const auto number = [](double v) { return std::isnan(v) ? "" : format_number(v); };
  for (const LearnedCurveBand& c : learned_curves(model))
    for (std::size_t i = 0; i < c.x.size(); ++i)
      writer.row({c.effect, c.name.empty() ? c.y_name : c.y_name + " " + c.name,
                  format_number(c.x[i]), c.x_unit, format_number(c.y[i]), c.y_unit,
                  number(c.low[i]), number(c.high[i])});
}

std::string curve_words(const LearnedCurveBand& c) {
  const bool length = c.x_unit == "m";
  std::string text = c.name.empty() ? c.y_name : c.y_name + " " + c.name;
  for (const std::size_t part : {1, 4, 7, 10}) {
    const std::size_t i = (c.x.size() - 1) * part / 10;
    text += fmt::format("{} {:.3g}{} at {:.2g} {}", part == 1 ? "" : ",", c.y[i],
                        c.y_unit == "1" ? "" : " " + c.y_unit, length ? 1e3 * c.x[i] : c.x[i],
                        length ? "mm" : c.x_unit);
  }
  return text;
}

}  // namespace hapsim
