// A body and a model made ready for a loop that asks for forces a thousand times a second.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "experiment/forces.h"
#include "mesh/signed_distance.h"
#include "model/model.h"
#include "model/relaxation_steps.h"
#include "realtime/place_facts.h"
#include "realtime/stiffness_field.h"

namespace hapsim {

struct PreparedBodyOptions {
  double tool_radius = 0;  // of the flat tool [m]
  // Finely solved contacts for a material, see known_contacts(); none where it is not set. Asked
  // once, or for some thirty materials where regions relax each in its own way.
  std::function<std::vector<KnownStiffness>(const MaterialSpec&)> contacts;
  int threads = 1;     // of the condensation's dense part
  bool heals = false;  // the body recovers between presses (metadata `recovery: full`)
};

// How far the stiffness is off at known contacts that were left out, from those that were not:
// |K - K_known| / |K_known| in the norm of Frobenius.
struct LeftOut {
  std::size_t contacts = 0;  // that were; 0: there are not two, and nothing is known
  double rms = 0, worst = 0;
};

// Reads nothing, and holds all that a loop reads: never changed after, so any number of loops and
// threads may share one. Cost: one factorisation and condensation of the body's mesh (its corners,
// of first order); some thirty where regions relax each in its own way. Up to 24 known contacts
// are left out in turn, for which the field alone is made again.
class PreparedBody {
 public:
  // Error(kBadInput): more than kMostTerms regional Maxwell elements; features of the body, or a
  // move, without contacts that know of them; body without a closed surface.
  // Error(kNoConvergence): body not held.
  PreparedBody(const TetMesh& body, const Model& model, const PreparedBodyOptions& options);

  const SignedDistance& distance() const { return *distance_; }
  const StiffnessField& field() const { return *field_; }
  // Shares of the stiffness field; or, regional, of a field of their own each: share 1.
  const std::vector<MaxwellTerm>& terms() const { return terms_; }
  bool is_regional() const { return !maxwell_.empty(); }
  // The stiffnesses of all terms at a point of a face [N/m], interpolated as the field is.
  void maxwell_at(int face, const Vec3& point, Eigen::Matrix3d* K) const noexcept;
  // What the model does beside the material, in the order of the catalogue.
  const std::vector<EffectInstance>& effects() const { return effects_; }
  double tool_radius() const { return tool_radius_; }  // [m]
  bool heals() const { return heals_; }
  double modulus() const { return modulus_; }  // E of region 0 [Pa]
  const PlaceFacts& facts() const { return *facts_; }
  // Of regional relaxation: what the Maxwell elements leave of the stiffness, the worst vertex's,
  // relative to it.
  double misfit() const { return misfit_; }
  std::size_t surface_unknowns() const { return surface_unknowns_; }
  const LeftOut& left_out() const { return left_out_; }

  static constexpr int kMostTerms = 32;

 private:
  void prepare_regional(
      const std::vector<RegionRelaxation>& regions, const MaterialSpec& relaxed,
      const std::function<std::unique_ptr<StiffnessField>(const MaterialSpec&)>& field_for);

  std::vector<EffectInstance> effects_;
  double tool_radius_ = 0, modulus_ = 0;
  bool heals_ = false;
  std::unique_ptr<PlaceFacts> facts_;
  std::vector<MaxwellTerm> terms_;
  std::vector<Eigen::Matrix3d> maxwell_;  // [vertex * terms + term]
  double misfit_ = 0;
  std::size_t surface_unknowns_ = 0;
  LeftOut left_out_;
  std::unique_ptr<StiffnessField> field_;
  std::unique_ptr<SignedDistance> distance_;
};

// The stiffnesses that the batch mode would take at these places, solved for the material.
std::vector<KnownStiffness> known_contacts(const Places& places, const MaterialSpec& material);

}  // namespace hapsim
