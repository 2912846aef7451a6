// How far the tool's force in a deck is from hapsim's, whatever program solves it.
#pragma once

#include <string>
#include <vector>

#include "exchange/scene.h"

namespace hapsim {

struct PrepareOptions {
  int threads = 0;    // 0: as many as the machine has
  std::string cache;  // directory, "" for none
};

// A press as hapsim has it: of a body of the scene's material, on a mesh graded to the tool's rim.
struct GradedPress {
  int id = 0;         // of the press in the recording
  Vec3 place, u;      // contact point; the deepest displacement, or into the surface [m]
  Eigen::Matrix3d K;  // at rest and small strain: the force of the body is -K u [N/m]
};

// Those of `presses` (rows of the recording) at whose places the tool's disc fits, in this order.
// Error(kBadInput) where the first does not fit. Costs half a second a place that is not cached.
std::vector<GradedPress> graded_presses(const TetMesh& body, const Model& model,
                                        const Recording& recording,
                                        const std::vector<Press>& presses,
                                        const PrepareOptions& options);

// MuJoCo: the tool on three slides along the principal axes of K, whose springs are the body at
// this place, bonded, at rest and small strain: their force is hapsim's. A key frame a row of the
// press. Error(kBadInput): finite strain, relaxation.
void write_mujoco(std::ostream& out, const Scene& scene, const GradedPress& press, double radius);

// Stiffness of the scene's tool on the scene's mesh with its moduli, at rest and small strain
// [N/m], integrated as CalculiX, FEBio and SOFA integrate it: no mean dilatation. That of a linear
// deck in CalculiX to its printed digits (tests/verify/export_test.cpp).
Eigen::Matrix3d deck_stiffness(const Scene& scene);

// |K_deck u - K u| / |K u|, negative where the deck's force is the smaller one.
double deck_error(const Eigen::Matrix3d& K_deck, const GradedPress& press);

// A sentence with the nodes and the error; a warning with the mend from 5 % on.
std::string deck_words(const Scene& scene, double error);

}  // namespace hapsim
