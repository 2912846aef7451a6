#include "experiment/workspace.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace hapsim {
namespace {

// Nothing is pressed in by more than the body's size: a wrong digit or unit, of which contact laws
// find no equilibrium.
void require_small_displacements(const std::vector<TetMesh>& bodies, const Dataset& dataset) {
  std::vector<double> size;
  for (const TetMesh& body : bodies) {
    Eigen::AlignedBox3d box;
    for (const Vec3& p : body.nodes) box.extend(p);
    size.push_back(box.diagonal().norm());
  }
  const Recording& recording = dataset.recording;
  for (const Episode& e : dataset.episodes) {
    const int setup = dataset.setup_of[static_cast<std::size_t>(e.position)];
    const double most = size[static_cast<std::size_t>(dataset.setups[setup].body)];
    for (std::size_t i = 0; i < e.rows.size(); ++i)
      if (!e.view.in_air[i] && e.view.u[i].norm() > most)
        fail_input(fmt::format("{}:{}", recording.name, recording.line[e.rows[i]]),
                   fmt::format("a displacement of {:.3g} m on a body of {:.3g} m",
                               e.view.u[i].norm(), most),
                   "correct or remove the row; all lengths are in metres");
  }
}

}  // namespace

Workspace make_workspace(const TetMesh& body, Recording recording,
                         const WorkspaceOptions& options) {
  return make_workspace(std::vector<TetMesh>{body}, std::move(recording), {}, options);
}

Workspace make_workspace(const std::vector<TetMesh>& bodies, Recording recording,
                         const std::vector<Setup>& setup_of_row, const WorkspaceOptions& options) {
  Workspace w;
  w.dataset = make_dataset(std::move(recording), setup_of_row);
  require_small_displacements(bodies, w.dataset);
  ContactLibraryOptions library;
  library.threads = options.threads;
  library.cache = options.cache;
  library.rim_edge = options.rim_edge;
  library.draft = options.draft;
  if (options.progress) library.step = options.progress(w.dataset.positions.size());
  for (const Setup& s : w.dataset.setups)
    w.libraries.push_back(std::make_unique<ContactLibrary>(bodies[static_cast<std::size_t>(s.body)],
                                                           s.tool_radius, library));
  try {
    w.body =
        std::make_unique<BodyStiffness>(w.libraries, w.dataset, options.nu_low, options.nu_high);
  } catch (const Error& error) {  // names the contact, not the file in which it stands
    if (error.code() != ExitCode::kBadInput) throw;
    throw Error(error.code(), w.dataset.recording.name, error.what(), "");
  }
  set_normals(w.dataset, w.body->normals());
  if (options.noise > 0)
    w.noise = {options.noise, false};
  else if (!w.dataset.recording.f.empty())
    w.noise = force_noise(w.dataset.recording);
  w.shape = shape_error(*w.body);
  const double mesh = w.body->mesh_uncertainty();
  w.floor = w.doubted_floor = options.floor;
  if (options.floor < 0) {
    w.floor = std::max(kLeastFloor, std::hypot(mesh, w.shape.share()));
    w.doubted_floor = std::max(kLeastFloor, std::hypot(mesh, w.shape.share_unmoved()));
  }
  return w;
}

void set_poisson_range(const Model& model, WorkspaceOptions& options) {
  const Parameter* nu = model.find("elastic", 0, "nu");
  if (nu == nullptr) return;
  options.nu_low = nu->state == ParameterState::kFree ? nu->lower : nu->value;
  options.nu_high = nu->state == ParameterState::kFree ? nu->upper : nu->value;
}

}  // namespace hapsim
