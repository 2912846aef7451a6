#include "experiment/labels.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "effects/catalogue.h"
#include "experiment/nearest_region.h"

namespace hapsim {
namespace {

void require_modulus(const MaterialSpec& material, int region) {
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
  if (!labels || !is_by_label(material)) return nullptr;
  for (const int region : labels->numbers()) require_modulus(material, region);
  return labels;
}

std::shared_ptr<const BodyRegions> acting_labels(const MaterialSpec& material,
                                                 const TetMesh& body) {
  if (!is_by_label(material)) return nullptr;
  return acting_labels(material, BodyRegions::of(body));
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
  const auto& n = body.tets[tet];
  return region_at(material,
                   (body.nodes[n[0]] + body.nodes[n[1]] + body.nodes[n[2]] + body.nodes[n[3]]) / 4);
}

}  // namespace hapsim
