// Regions over the plan view of a body: classifier, boundary, labels, model.
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "cluster/class_boundary.h"
#include "mesh/tetmesh.h"
#include "model/model.h"
#include "regions/location_regions.h"

namespace hapsim {

enum class RegionRule { kQda, kNearest };  // by discriminant analysis, or as the nearest sample

// The region of a plan position (x, y), learnt from the samples' positions alone (thesis 5.2.4).
PlaneClassifier region_classifier(const LocationTable& table, const std::vector<int>& label,
                                  int regions, RegionRule rule);

// Samples on the wrong side of their boundary.
int contradicted(const PlaneClassifier& classify, const LocationTable& table,
                 const std::vector<int>& label);

// Boundaries within the plan view of the body; without a body, within the box of the samples
// widened by half their spacing.
std::vector<BoundaryLine> region_boundaries(const PlaneClassifier& classify,
                                            const LocationTable& table,
                                            const std::optional<TetMesh>& body, int scan_points);

// Each tetrahedron's region from its centre's plan position.
void label_body(TetMesh& body, const PlaneClassifier& classify);

// Key points of the effect `regions`, appended to a model as fixed rows, numbered by region.
class KeyPoints {
 public:
  explicit KeyPoints(Model& model) : model_(model) {}
  void add(const Eigen::Vector2d& p, int region);

 private:
  Model& model_;
  std::map<int, int> number_;  // by region
};

// Key points for each of `keys` points along every line: one
// on either side, so that "nearest key point" has that boundary.
void place_key_points(Model& model, const PlaneClassifier& classify,
                      const std::vector<BoundaryLine>& lines, int keys);

// A model with one E a region, one nu and the key points of the boundaries. A start for
// hs-identify --model.
Model region_model(const LocationTable& table, const RegionEstimate& regions,
                   const PlaneClassifier& classify, const std::vector<BoundaryLine>& lines,
                   int keys);

}  // namespace hapsim
