// The forces of a model along the motion of a recording, with their derivatives.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "experiment/experiment.h"
#include "model/model.h"

namespace hapsim {

// What the model's body effects say of the material; columns number the free parameters.
MaterialSpec material_of(const Model& model);

// Why the fitted values of an effect are not what it is meant for; "" when they are.
std::string implausible(const Model& model, const Effect& effect, const Dataset& dataset);

// The model's effects in the order of the catalogue; with `derivatives`, the columns of their free
// parameters.
struct EffectInstance {
  const Effect* effect;
  Values values;
};
std::vector<EffectInstance> effect_instances(const Model& model, bool derivatives);
// It has Maxwell elements.
bool relaxes(const EffectInstance& instance);

// Episodes to evaluate, in this order; their rows follow one another in all stacked vectors.
using Selection = std::vector<int>;
Selection all_episodes(const Dataset& dataset);
// Rows of the recording in the stacked order.
std::vector<int> stacked_rows(const Dataset& dataset, const Selection& selection);

// Stacked forces (3 x rows) and, when asked, their derivatives by the free parameters. Depends on
// its arguments alone; `about` is made for the model's material (Places::solve, Places::estimate).
Signal model_forces(const Model& model, const Experiment& experiment, const Linearisation& about,
                    const Selection& selection, bool derivatives);
// About the model's own material, solved here.
Signal solved_forces(const Model& model, const Experiment& experiment, const Selection& selection,
                     bool derivatives);

// The same with stiffnesses by position from elsewhere, on so many threads (0: as many as there
// are); the threads change nothing in the result. Derivatives by `more` parameters of the
// stiffness alone come after those of the model.
using StiffnessAt = std::function<PositionStiffness(std::size_t position)>;
Signal model_forces(const Model& model, const Dataset& dataset, const StiffnessAt& stiffness_at,
                    const Selection& selection, bool derivatives, int threads = 1,
                    Eigen::Index more = 0);

// How a tool that is flat and rigid would move for the body's forces, one vector a row [m]: the
// recorded motion after all effects that change it.
std::vector<Vec3> motion_on_body(const Model& model, const Experiment& experiment,
                                 const Linearisation& about, const Selection& selection);

// The measured forces in the same order.
Eigen::VectorXd measured_forces(const Dataset& dataset, const Selection& selection);

// A root mean square of force errors that knows what it is taken over.
struct ForceError {
  // Over all three components, measured or not: what fits and tests of effects count [N]. NaN:
  // there is none.
  double pooled = std::numeric_limits<double>::quiet_NaN();
  int axes = 3;  // components that were measured

  // Over the components that were measured: what people are told [N].
  double told() const { return std::sqrt(3.0 / axes) * pooled; }
};
ForceError force_error(const Dataset& dataset, const Eigen::VectorXd& residual);

}  // namespace hapsim
