#include "experiment/labels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "effects/catalogue.h"
#include "experiment/nearest_region.h"

namespace hapsim {

void require_label(int number) {
  if (0 <= number && number <= kMostLabel) return;
  fail_input("",
             fmt::format("the body has tetrahedra of region {}; regions of a model have numbers "
                         "from 0 to {}",
                         number, kMostLabel),
             "number them anew (hs-tetmesh --region, or the program that made the mesh)");
}

namespace {

void require_modulus(const MaterialSpec& material, int region) {
  require_label(region);
  if (std::find(material.given.begin(), material.given.end(), region) != material.given.end())
    return;
  fail_input("",
             fmt::format("the body has tetrahedra of region {}, of which the model has no modulus",
                         region),
             fmt::format("add a row {},{},{} to the model, or take out that of all regions but 0",
                         body_effect().card().name, region, body_effect().card().modulus));
}

}  // namespace

std::shared_ptr<const BodyRegions> acting_labels(const MaterialSpec& material,
                                                 const std::shared_ptr<const BodyRegions>& labels) {
  const bool acts = labels && is_by_label(material);
  for (const FeatureSpec& f : material.features) {
    if (f.feature.kind != Feature::kGrowth) continue;
    const int region = static_cast<int>(std::lround(f.feature.value[0]));
    if (acts && std::binary_search(labels->numbers().begin(), labels->numbers().end(), region))
      continue;
    fail_input("",
               is_by_label(material)
                   ? fmt::format("the model lets region {} grow, and no tetrahedron of the body is "
                                 "of a region of that number",
                                 region)
                   : fmt::format("the model lets region {} grow, and places no moduli by the "
                                 "body's own regions",
                                 region),
               is_by_label(material)
                   ? "take the row out, or give a body that is numbered (hs-tetmesh --region)"
                   : "take the row out, or give E of each region and no key points");
  }
  if (!acts) return nullptr;
  for (const int region : labels->numbers()) require_modulus(material, region);
  return labels;
}

std::shared_ptr<const BodyRegions> acting_labels(const MaterialSpec& material,
                                                 const TetMesh& body) {
  if (!is_by_label(material)) return acting_labels(material, nullptr);
  return acting_labels(material, BodyRegions::of(body));
}

void refuse_growth(const MaterialSpec& material, const std::string& what) {
  for (const FeatureSpec& f : material.features)
    if (f.feature.kind == Feature::kGrowth)
      fail_input("", fmt::format("{} is not known of a region that grows", what),
                 "take the growth out of the model, or number the tetrahedra as it has grown");
}

std::vector<int> labels_at(const std::shared_ptr<const BodyRegions>& labels,
                           const std::vector<Vec3>& points) {
  std::vector<int> result;
  if (!labels) return result;
  for (const Vec3& p : points) result.push_back(labels->at(p));
  return result;
}

int region_of_tet(const MaterialSpec& material, const TetMesh& body, std::size_t tet) {
  if (is_by_label(material) && !body.region.empty()) {
    require_modulus(material, body.region[tet]);
    return body.region[tet];
  }
  return region_at(material, tet_centroid(body, tet));
}

}  // namespace hapsim
