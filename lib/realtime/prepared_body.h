// A body and a model made ready for a loop that asks for forces a thousand times a second.
#pragma once

#include <memory>
#include <vector>

#include "geometry/signed_distance.h"
#include "model/body_stiffness.h"
#include "model/model.h"
#include "realtime/stiffness_field.h"

namespace hapsim {

struct PreparedBodyOptions {
  double tool_radius = 0;                // of the flat tool [m]
  std::vector<KnownStiffness> contacts;  // finely solved ones; see known_contacts()
  int threads = 1;                       // of the condensation's dense part
};

// Reads nothing, and holds all that a loop reads: never changed after, so any number of loops and
// threads may share one. Cost: one factorisation and condensation of the body's mesh
// (its corners, of first order).
class PreparedBody {
 public:
  // Error(kUsage): an effect of the model has no form for a loop (Effect::live), or more than
  // kMostTerms Maxwell elements. Error(kBadInput): body without a closed surface.
  // Error(kNoConvergence): body not held.
  PreparedBody(const TetMesh& body, const Model& model, const PreparedBodyOptions& options);

  const SignedDistance& distance() const { return *distance_; }
  const StiffnessField& field() const { return *field_; }
  const std::vector<MaxwellTerm>& terms() const { return terms_; }
  std::size_t surface_unknowns() const { return surface_unknowns_; }

  static constexpr int kMostTerms = 16;

 private:
  std::vector<MaxwellTerm> terms_;
  std::size_t surface_unknowns_ = 0;
  std::unique_ptr<StiffnessField> field_;
  std::unique_ptr<SignedDistance> distance_;
};

// The stiffnesses that the batch mode would take at the positions of `body`.
std::vector<KnownStiffness> known_contacts(const BodyStiffness& body, const MaterialSpec& material);

}  // namespace hapsim
