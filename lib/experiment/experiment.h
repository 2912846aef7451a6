// A recording on prepared bodies: what every question about a model and measured forces needs.
#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "experiment/dataset.h"
#include "experiment/places.h"
#include "experiment/press_depth.h"
#include "experiment/shape_error.h"
#include "model/model.h"
#include "recording/force_noise.h"

namespace hapsim {

// What a model is not blamed for.
struct Allowance {
  double noise = 1;  // standard deviation of the force noise, one component [N]
  double floor = 0;  // relative gain error by position: of mesh and geometry
};

// A place of a recording that the body cannot be pressed at by this tool.
struct UnfitPlace {
  Vec3 point = Vec3::Zero();  // [m]
  std::string why;
};

// Complete when it is made and never changed after; any number of threads may read it.
struct Experiment {
  Dataset dataset;  // with normals
  Places places;
  Noise noise;
  ShapeError shape;
  PressDepth depth;
  std::vector<UnfitPlace> unfit;
  // Samples that strain the body between plates by more than kMostPlateStrain, and those after
  // them in their presses: no law was verified so far. Left out where something is fitted.
  std::size_t too_strained = 0;
  double floor = 0;          // Allowance::floor, as the meshes and the shape let expect it
  double doubted_floor = 0;  // the same, if distances of points from the surface are none of a
                             // move's

  Allowance allowance() const { return {noise.value, floor}; }
};

struct ExperimentOptions {
  int threads = 0;                     // 0: as many as the machine has
  std::string cache;                   // directory, "" for none
  double rim_edge = kRimEdge;          // share of the tool's radius
  bool draft = false;                  // ContactLibraryOptions::draft
  double noise = 0;                    // [N]; 0: declared by the recording or measured from it
  double floor = -1;                   // relative; negative: from the meshes and the shape
  double nu_low = 0, nu_high = 0.499;  // the range of Poisson's ratio that will be asked
  // By body: outline in plan view of what was seen of it (mesh/window.h), beyond which it is a
  // guess; empty: all was seen.
  std::vector<std::vector<Vec3>> windows;
  // What becomes of places at which the tool's disc does not fit: left out with their presses, or
  // taken for the nearest one at which it does.
  bool borrow = false;
  // Meshes, matrices and solutions kept in memory for later, of all bodies and tools [bytes].
  std::size_t memory = Memo::kDefaultBudget;
  std::function<std::function<void()>(std::size_t)> progress;  // from the count, a step function
};

// Least floor: bodies come from scans, whose shape is uncertain even where the points lie on it.
constexpr double kLeastFloor = 0.01;

// Reads nothing; prepares (or finds in the cache) the stiffness at each position of the recording.
// Error(kBadInput), with the recording's name: displacements beyond the size of the body; a contact
// off its surface; no place at which the tool fits, or more than half at which it comes through the
// body.
Experiment make_experiment(const TetMesh& body, Recording recording,
                           const ExperimentOptions& options);
// Of several bodies or tools: Setup::body of the dataset numbers `bodies`.
Experiment make_experiment(std::span<const TetMesh> bodies, Dataset dataset,
                           const ExperimentOptions& options);

// How many places and samples were left out (or taken for others, or are beyond what was verified),
// and why; a line each.
std::vector<std::string> left_out_words(const Experiment& experiment, bool borrowed = false);
// Of some positions alone, in ascending order, as prepared.
Experiment at_positions(const Experiment& experiment, const std::vector<std::size_t>& positions);

// [nu, nu] when the model's Poisson's ratio is fixed, else its bounds.
void set_poisson_range(const Model& model, ExperimentOptions& options);

}  // namespace hapsim
