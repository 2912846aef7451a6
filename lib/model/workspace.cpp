#include "model/workspace.h"

#include <algorithm>

namespace hapsim {

Workspace make_workspace(const TetMesh& body, Recording recording,
                         const WorkspaceOptions& options) {
  return make_workspace(std::vector<TetMesh>{body}, std::move(recording), {}, options);
}

Workspace make_workspace(const std::vector<TetMesh>& bodies, Recording recording,
                         const std::vector<Setup>& setup_of_row, const WorkspaceOptions& options) {
  Workspace w;
  w.dataset = make_dataset(std::move(recording), setup_of_row);
  ContactLibraryOptions library;
  library.threads = options.threads;
  library.cache = options.cache;
  library.rim_edge = options.rim_edge;
  library.draft = options.draft;
  if (options.progress) library.step = options.progress(w.dataset.positions.size());
  for (const Setup& s : w.dataset.setups)
    w.libraries.push_back(std::make_unique<ContactLibrary>(bodies[static_cast<std::size_t>(s.body)],
                                                           s.tool_radius, library));
  w.body = std::make_unique<BodyStiffness>(w.libraries, w.dataset, options.nu_low, options.nu_high);
  set_normals(w.dataset, w.body->normals());
  if (options.noise > 0)
    w.noise = {options.noise, false};
  else if (!w.dataset.recording.f.empty())
    w.noise = force_noise(w.dataset);
  w.floor = options.floor >= 0 ? options.floor : std::max(kLeastFloor, w.body->mesh_uncertainty());
  return w;
}

void set_poisson_range(const Model& model, WorkspaceOptions& options) {
  const Parameter* nu = model.find("elastic", 0, "nu");
  if (nu == nullptr) return;
  options.nu_low = nu->state == ParameterState::kFree ? nu->lower : nu->value;
  options.nu_high = nu->state == ParameterState::kFree ? nu->upper : nu->value;
}

}  // namespace hapsim
