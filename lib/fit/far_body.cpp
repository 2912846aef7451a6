#include "fit/far_body.h"

#include <algorithm>
#include <cmath>

#include "effects/local_contact.h"
#include "model/body_parameters.h"

namespace hapsim {

Eigen::VectorXd far_body_doubt(const Fit& fitted, const Experiment& experiment,
                               const Selection& selection, const Eigen::VectorXd& forces) {
  constexpr double kDoubt = 0.1, kMost = 0.5;
  const Dataset& dataset = experiment.dataset;
  if (dataset.recording.metadata.find("tool") != "sphere") return {};
  const MaterialSpec material = material_of(fitted.model);
  const std::vector<ToolStand> stands = experiment.places.stands();
  const auto doubted = [&](std::size_t p) {
    PositionStiffness s = fitted.about.at(p, material);
    const DiscStiffness disc =
        bonded_disc(material.modulus[0], material.nu,
                    dataset.setups[static_cast<std::size_t>(dataset.setup_of[p])].tool_radius);
    const double own = stands[p].normal.dot(s.K * stands[p].normal);
    s.K *= 1 + std::min(kDoubt * std::abs(own / disc.normal - 1), kMost);
    return s;
  };
  return model_forces(fitted.model, dataset, doubted, selection, false).f - forces;
}

}  // namespace hapsim
