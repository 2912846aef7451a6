// A scene whose force in the target program is hapsim's: its mesh graded to the tool, and one
// factor on all moduli for what the target's elements are stiffer by.
#pragma once

#include <string>
#include <vector>

#include "exchange/deck_error.h"

namespace hapsim {

struct MatchOptions {
  int order = 2;           // of the tetrahedra
  std::size_t places = 9;  // of the recording at which forces are compared, the press among them
  PrepareOptions prepare;
};

struct MatchedPress {
  int id = 0;
  bool learned = false;  // the factor was chosen for it, among others
  double error = 0;      // deck_error()
};

struct Match {
  double factor = 1;  // on all moduli
  double before = 0;  // error of the body's own mesh and the model's moduli at the exported press
  std::vector<MatchedPress> presses;  // the exported one first
  // The largest |error| of those that the factor was not chosen for.
  double largest_unseen() const;
  std::size_t learned() const;
};

// Replaces the scene's mesh by the one that hapsim solves for this press (make_contact_mesh()), of
// straight elements and order `order`, and its moduli by `factor` times them. The factor makes the
// least squares of relative force errors at every other one of up to `places` - 1 further places of
// the recording, each on its own such mesh; the exported press is never among them unless the
// recording has no other place. What the errors are is known without the program: deck_stiffness().
// `press`: the rows of the exported one. Error(kBadInput): the tool's disc does not fit there.
Match match_scene(Scene& scene, const TetMesh& body, const Model& model, const Recording& recording,
                  const Press& press, const MatchOptions& options);

// A sentence with the errors at the press and at those held out, the factor, and the error before.
std::string match_words(const Match& match);

}  // namespace hapsim
