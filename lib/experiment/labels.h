// When the regions of a model are those that the body's tetrahedra are numbered with.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "effects/effect.h"
#include "solid/body_regions.h"

namespace hapsim {

// Several moduli and nothing that places them, as key points do: the body's numbers place them.
inline bool is_by_label(const MaterialSpec& material) {
  return material.key_point.empty() && material.modulus.size() > 1 && !material.local;
}

// Numbers that regions of a model may have; what is solved for grows with the largest.
inline constexpr int kMostLabel = 1000;
// Error(kBadInput): a tetrahedron's number that cannot be that of a region of a model.
void require_label(int number);

// The labels where they act, else null: no moduli are placed by them, or the body has none.
// Error(kBadInput): the body has a region of which the material has no modulus.
std::shared_ptr<const BodyRegions> acting_labels(const MaterialSpec& material,
                                                 const std::shared_ptr<const BodyRegions>& labels);
// The same of a body that is not prepared.
std::shared_ptr<const BodyRegions> acting_labels(const MaterialSpec& material, const TetMesh& body);

// Error(kBadInput): a region of the material grows, which `what` does not know.
void refuse_growth(const MaterialSpec& material, const std::string& what);

// Of points of its surface; empty where all tetrahedra have the number 0.
std::vector<int> labels_at(const std::shared_ptr<const BodyRegions>& labels,
                           const std::vector<Vec3>& points);

// Region of one of the body's own tetrahedra: by its number where that acts, else by the nearest
// key point. Errors as acting_labels(), of this tetrahedron.
int region_of_tet(const MaterialSpec& material, const TetMesh& body, std::size_t tet);

}  // namespace hapsim
