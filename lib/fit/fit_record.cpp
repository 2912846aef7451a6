#include "fit/fit_record.h"

#include "experiment/fitted_range.h"
#include "experiment/unseen_band.h"
#include "io/number.h"
#include "model/model_edit.h"
#include "model/search_state.h"

namespace hapsim {

void record_fit(Fit& fitted, const Metadata& start, const Experiment& w) {
  Model& model = fitted.model;
  model.metadata = start;
  unmark(model);
  for (const char* key : {"heldout", "until", "heldout_later", "constraints", "binding",
                          "torque_rmse", "torque_noise", "marker_rmse", "marker_noise"})
    model.metadata.remove(key);
  record_band({}, model.metadata);
  std::string all, binding;
  for (const KeptConstraint& c : fitted.constraints) {
    all += (all.empty() ? "" : "; ") + c.text;
    if (c.active) binding += (binding.empty() ? "" : "; ") + c.text;
  }
  if (!all.empty()) model.metadata.set("constraints", all);
  if (!binding.empty()) model.metadata.set("binding", binding);
  model.metadata.set("rmse", format_number(fitted.error.told()));
  model.metadata.set("force_noise", format_number(w.noise.value));
  if (fitted.torque.rows > 0) {
    model.metadata.set("torque_rmse", format_number(fitted.torque.rms));
    model.metadata.set("torque_noise", format_number(fitted.torque.noise));
  }
  if (fitted.marker.rows > 0) {
    model.metadata.set("marker_rmse", format_number(fitted.marker.rms));
    model.metadata.set("marker_noise", format_number(fitted.marker.noise));
  }
  model.metadata.set("depth", format_number(w.depth.depth));
  record_range(w.dataset, model.metadata);
  if (w.dataset.tools() > 1)
    model.metadata.remove("tool_radius");
  else
    model.metadata.set("tool_radius", format_number(w.dataset.recording.tool_radius()));
  if (const auto disc = w.dataset.recording.metadata.find("contact_radius"))
    model.metadata.set("contact_radius", *disc);
  else
    model.metadata.remove("contact_radius");
}

HistoryRow history_row(const std::string& model, const Fit& fitted, double held_out,
                       const std::string& by, double noise, double force_rms) {
  return {model,
          effects_label(fitted.model),
          fitted.error.told(),
          held_out,
          by,
          noise,
          force_rms,
          static_cast<int>(fitted.model.free_parameters().size())};
}

}  // namespace hapsim
