#include "model/plausible.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "base/error.h"

namespace hapsim {

void require_enough_data(const Model& model, const Dataset& dataset, const Selection& selection) {
  std::size_t rows = 0;
  for (const int e : selection) rows += dataset.episodes[e].rows.size();
  const std::size_t free = model.free_parameters().size();
  if (3 * rows < free)
    fail_input(dataset.recording.name,
               fmt::format("{} force components cannot tell {} free parameters", 3 * rows, free),
               "record more samples, or fix parameters (--fix)");
}

void require_like_columns(const Model& model, const Dataset& dataset, const Selection& selection,
                          const BodyStiffness& body) {
  const Eigen::VectorXd f = model_forces(model, dataset, selection, body, false).f;
  const Eigen::VectorXd measured = measured_forces(dataset, selection);
  // What each axis measured over what the model has there: root mean squares, so that neither sign
  // nor scatter matters; axes that the model hardly loads say nothing.
  std::array<double, 3> model_power{}, power{};
  for (Eigen::Index i = 0; i < f.size(); ++i) {
    model_power[i % 3] += f[i] * f[i];
    power[i % 3] += measured[i] * measured[i];
  }
  constexpr double kLoaded = 0.03, kLeast = 100;
  std::array<double, 3> ratio{};
  double strongest = 0;
  for (const double p : model_power) strongest = std::max(strongest, p);
  for (int k = 0; k < 3; ++k)
    if (model_power[k] > kLoaded * kLoaded * strongest && power[k] > 0)
      ratio[k] = std::sqrt(power[k] / model_power[k]);
  for (int k = 0; k < 3; ++k)
    for (int other = 0; other < 3; ++other) {
      if (ratio[k] == 0 || ratio[other] == 0 || ratio[k] < kLeast * ratio[other]) continue;
      constexpr const char* kColumns[] = {"fx", "fy", "fz"};
      fail_input(dataset.recording.name,
                 fmt::format("column {} is some {:.0f} times larger than {} calls for", kColumns[k],
                             ratio[k] / ratio[other], kColumns[other]),
                 "is one of them in mN? All forces are in N (hs-import converts)");
    }
}

std::string strange_modulus(const Model& model) {
  constexpr double kSoftest = 50, kHardest = 5e6;  // from brain and fat to cartilage and rubber
  const Parameter* e = model.find("elastic", 0, "E");
  if (e == nullptr || (e->value >= kSoftest && e->value <= kHardest)) return "";
  return fmt::format(
      "E = {:.3g} Pa is {} than soft bodies are: are forces in N and displacements in m?", e->value,
      e->value > kHardest ? "harder" : "softer");
}

}  // namespace hapsim
