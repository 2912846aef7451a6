// What contact laws need to know of a prepared body at a place, beside its stiffness.
#pragma once

#include <vector>

#include "effects/effect_step.h"
#include "realtime/stiffness_field.h"
#include "solid/body_regions.h"

namespace hapsim {

class PlaceFacts {
 public:
  // `labels`: where they are the material's regions, else null. `known`: contacts that are known
  // finely, of which each has its own normal. Keeps `field`.
  PlaceFacts(const StiffnessField& field, const MaterialSpec& material, const BodyRegions* labels,
             const std::vector<KnownStiffness>& known);

  // The place at a point of a face, where the surface has this normal; no table search, so it
  // allocates and throws nothing. The modulus is straight between entries, as the stiffness; the
  // normal is that of a known contact within kSamePlace.
  StepPlace at(int face, const Vec3& point, const Vec3& normal) const noexcept;

 private:
  const StiffnessField& field_;
  double nu_;
  std::vector<double> modulus_;               // by entry of the field [Pa]
  std::vector<std::pair<Vec3, Vec3>> known_;  // points and normals
};

}  // namespace hapsim
