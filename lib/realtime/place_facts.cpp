#include "realtime/place_facts.h"

#include "experiment/dataset.h"
#include "experiment/nearest_region.h"

namespace hapsim {

PlaceFacts::PlaceFacts(const StiffnessField& field, const MaterialSpec& material,
                       const BodyRegions* labels, const std::vector<KnownStiffness>& known)
    : field_(field), nu_(material.nu) {
  for (const FieldEntry& entry : field.entries()) {
    const int region =
        labels != nullptr ? labels->at(entry.point) : region_at(material, entry.point);
    modulus_.push_back(material.local ? local_modulus(material, entry.point).value
                                      : material.modulus[static_cast<std::size_t>(region)]);
  }
  for (const KnownStiffness& k : known) known_.emplace_back(k.point, k.normal);
}

StepPlace PlaceFacts::at(int face, const Vec3& point, const Vec3& normal) const noexcept {
  StepPlace place;
  place.point = point;
  place.normal = normal;
  for (const auto& [at, its] : known_)
    if ((at - point).squaredNorm() <= kSamePlace * kSamePlace) {
      place.normal = its;
      break;
    }
  const StiffnessField::Place table = field_.locate(face, point);
  place.contact.K = field_.at(table);
  place.contact.nu = nu_;
  place.contact.modulus = 0;
  for (int k = 0; k < 3; ++k) place.contact.modulus += table.weight[k] * modulus_[table.entry[k]];
  return place;
}

}  // namespace hapsim
