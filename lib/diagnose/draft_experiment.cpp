#include "diagnose/draft_experiment.h"

#include <span>

#include "experiment/contact_radius.h"
#include "experiment/plausible.h"

namespace hapsim {

Experiment draft_experiment(const TetMesh& body, const std::vector<Vec3>& window,
                            const Model& model, Recording recording, ExperimentOptions options) {
  options.windows = {window};
  options.draft = true;
  set_poisson_range(model, options);
  set_contact_radius(recording, model);
  Dataset dataset = make_dataset(std::move(recording));
  require_presses(dataset);
  return make_experiment(std::span(&body, 1), std::move(dataset), options);
}

}  // namespace hapsim
