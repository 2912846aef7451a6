// Stiffness imaging: where inside a body the modulus differs, from all presses at once.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "experiment/forces.h"
#include "imaging/ball_search.h"
#include "imaging/image_field.h"
#include "imaging/lump_fit.h"

namespace hapsim {

// What the presses in one direction at one position ask for.
struct ImageView {
  int position = 0;
  Eigen::Matrix3d B;  // the gain of a stiffness K is tr(K B); B has the model's own K in it
  double gain = 1;    // measured over the model's force
  double error = 0;   // its standard error, of the noise alone
};

struct ImageOptions {
  int threads = 0;
  double step = 0;  // of the finer grid [m]; 0: 0.7 tool radii
  Penalty penalty = Penalty::kTotalVariation;
  double largest_depth = 0;        // [m]; 0: 15 tool radii
  std::function<void()> progress;  // once a position is done
};

struct StiffnessImage {
  ImageField field;
  std::vector<Lump> lumps;   // strongest first; none: nothing compact is seen
  BallSearch found;          // of what the lumps leave: how deep these presses see, and errors
  double misfit_before = 0;  // of the log gains without lumps or field
  double error = 0;          // relative, of a gain
  std::size_t views = 0;
};

// Gains by position and direction (presses within 15 degrees are one view) by regression on the
// model's forces, in the order of the positions; effects of the sensor are kept.
std::vector<ImageView> image_views(const Model& model, const Experiment& experiment,
                                   const Linearisation& about);

// The sensitivities of all gains are the energies of the unit fields in every element: one solution
// a position on the body of `model` with its modulus alone, linear from there on. From them come
// the field (image_field.h) and where lumps may be (ball_search.h); lumps are then solved for by
// finite elements, with all that is left open about them (lump_fit.h). One setup only.
StiffnessImage stiffness_image(const Model& model, const Experiment& experiment,
                               const Linearisation& about, const TetMesh& body,
                               const ImageOptions& options);

// In words (image_words.cpp): what was found and how deep these presses see.
std::vector<std::string> words_of(const StiffnessImage& image);

}  // namespace hapsim
