// What every tool with a body and a recording needs: data, prepared stiffnesses, noise and floor.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "experiment/body_stiffness.h"
#include "experiment/dataset.h"
#include "experiment/shape_error.h"
#include "model/model.h"
#include "recording/force_noise.h"

namespace hapsim {

struct WorkspaceOptions {
  int threads = 0;                     // 0: as many as the machine has
  std::string cache;                   // directory, "" for none
  double rim_edge = kRimEdge;          // share of the tool's radius
  bool draft = false;                  // ContactLibraryOptions::draft
  double noise = 0;                    // [N]; 0: declared by the recording or measured from it
  double floor = -1;                   // relative; negative: from the meshes and the shape
  double nu_low = 0, nu_high = 0.499;  // the range of Poisson's ratio that will be asked
  std::function<std::function<void()>(std::size_t)> progress;  // from the count, a step function
};

struct Workspace {
  Dataset dataset;
  std::vector<std::unique_ptr<ContactLibrary>> libraries;  // by setup
  std::unique_ptr<BodyStiffness> body;
  Noise noise;
  ShapeError shape;
  double floor = 0;  // relative gain error by position that a model is not blamed for
  double doubted_floor =
      0;  // the same, if distances of points from the surface are none of a move's
};

// Least floor: bodies come from scans, whose shape is uncertain even where the points lie on it.
constexpr double kLeastFloor = 0.01;

// Reads nothing; prepares (or finds in the cache) the stiffness at each position of the recording.
// Error(kBadInput), with the recording's name: displacements beyond the size of the body, a contact
// off its surface or on what is bonded.
Workspace make_workspace(const TetMesh& body, Recording recording, const WorkspaceOptions& options);
// Of several bodies or tools: Setup::body numbers `bodies`.
Workspace make_workspace(const std::vector<TetMesh>& bodies, Recording recording,
                         const std::vector<Setup>& setup_of_row, const WorkspaceOptions& options);

// [nu, nu] when the model's Poisson's ratio is fixed, else its bounds.
void set_poisson_range(const Model& model, WorkspaceOptions& options);

}  // namespace hapsim
