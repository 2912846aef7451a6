// A body and a model made ready for a loop that asks for forces a thousand times a second.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "experiment/forces.h"
#include "mesh/signed_distance.h"
#include "model/model.h"
#include "model/relaxation_steps.h"
#include "realtime/large_strain.h"
#include "realtime/place_facts.h"
#include "realtime/stiffness_field.h"

namespace hapsim {

struct PreparedBodyOptions {
  double tool_radius = 0;  // of the flat tool [m]
  // Places whose stiffness is the batch mode's own, see known_contacts(); none where it is not set.
  // Asked once, or for some thirty materials where regions relax each in its own way.
  std::function<std::vector<KnownStiffness>(const MaterialSpec&)> contacts;
  int threads = 0;             // 0: as many as the machine has
  bool heals = false;          // the body recovers between presses (metadata `recovery: full`)
  std::string cache;           // directory of prepared fields and samples, "" for none
  double rim_edge = kRimEdge;  // of the contact meshes, over the tool's radius
  double tolerance = 0.02;     // relative error of the force between samples, root mean square
  std::size_t most_samples = kMostSamples;  // the tolerance may then not be reached
  // Finite strain by sampled elements, in place of the closed law of hyperelastic; the field's
  // tolerance is theirs.
  bool large_strain = false;
  std::size_t most_strain_samples = LargeStrainOptions{}.most_samples;
  std::function<std::function<void()>()> strain_progress;      // a step function
  std::function<std::function<void()>(std::size_t)> progress;  // from the most, a step function
};

// Reads nothing but the cache, and holds all that a loop reads: never changed after, so any number
// of loops and threads may share one. Cost: 0.05 to 0.1 s of a processor for each sample, thirty
// times that for 40 of them where regions relax each in its own way; nothing once the field
// is in the cache.
class PreparedBody {
 public:
  // Error(kBadInput): more than kMostTerms regional Maxwell elements; a move of the body without
  // contacts that know of it; body without a closed surface, or that the tool fits nowhere.
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
  const LargeStrain* large_strain() const { return large_strain_.get(); }  // null: not asked for
  // Of regional relaxation: what the Maxwell elements leave of the stiffness, the worst entry's,
  // relative to it.
  double misfit() const { return misfit_; }

  static constexpr int kMostTerms = 32;

 private:
  void prepare_regional(const std::vector<RegionRelaxation>& regions, const MaterialSpec& relaxed,
                        const FieldSampling& sampling,
                        const std::function<SampledMaterial(const MaterialSpec&)>& sampled,
                        const PreparedBodyOptions& options);

  std::vector<EffectInstance> effects_;
  double tool_radius_ = 0, modulus_ = 0;
  bool heals_ = false;
  std::unique_ptr<PlaceFacts> facts_;
  std::vector<MaxwellTerm> terms_;
  std::vector<Eigen::Matrix3d> maxwell_;  // [entry * terms + term]
  double misfit_ = 0;
  std::unique_ptr<StiffnessField> field_;
  std::unique_ptr<SignedDistance> distance_;
  std::unique_ptr<LargeStrain> large_strain_;
};

// The stiffnesses that the batch mode would take at these places, solved for the material.
std::vector<KnownStiffness> known_contacts(const Places& places, const MaterialSpec& material);

}  // namespace hapsim
