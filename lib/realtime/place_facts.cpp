#include "realtime/place_facts.h"

#include "experiment/dataset.h"
#include "experiment/nearest_region.h"

namespace hapsim {

PlaceFacts::PlaceFacts(const StiffnessField& field, const MaterialSpec& material,
                       const std::vector<KnownStiffness>& known)
    : field_(field), nu_(material.nu) {
  for (const Vec3& v : field.surface().vertices)
    modulus_.push_back(material.local
                           ? local_modulus(material, v).value
                           : material.modulus[static_cast<std::size_t>(region_at(material, v))]);
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
  place.contact.K = field_.at(face, point);
  place.contact.nu = nu_;
  const Vec3 weight = field_.weights(face, point);
  const Triangle& t = field_.surface().faces[face];
  place.contact.modulus =
      weight[0] * modulus_[t[0]] + weight[1] * modulus_[t[1]] + weight[2] * modulus_[t[2]];
  return place;
}

}  // namespace hapsim
