#include "realtime/prepared_body.h"

#include <algorithm>
#include <string>

#include "base/error.h"
#include "effects/catalogue.h"
#include "model/forces.h"
#include "model/nearest_region.h"

namespace hapsim {
namespace {

// The corners' mesh: the field puts the tool's own neighbourhood in, which is where second order
// counts. Middles become nodes that no tetrahedron uses, which are held.
TetMesh corners_only(TetMesh mesh) {
  mesh.order = 1;
  for (auto& t : mesh.tets) std::fill(t.begin() + 4, t.end(), -1);
  return mesh;
}

std::vector<MaxwellTerm> live_terms(const Model& model, const MaterialSpec& material) {
  std::vector<MaxwellTerm> terms;
  for (const Effect* effect : catalogue()) {
    Values values;
    for (const Parameter& p : model.parameters)
      if (p.effect == effect->card().name) values.push_back({p.region, p.name, p.value, -1});
    if (values.empty()) continue;
    if (!effect->live(values, material.modulus[0], terms))
      fail_usage("the model has " + effect->card().name + ", which the real-time loop cannot do",
                 "simulate without --live, or fit a model without it");
  }
  if (terms.size() > static_cast<std::size_t>(PreparedBody::kMostTerms))
    fail_usage("the model has " + std::to_string(terms.size()) + " relaxation times",
               "the real-time loop takes up to " + std::to_string(PreparedBody::kMostTerms));
  return terms;
}

}  // namespace

PreparedBody::PreparedBody(const TetMesh& body, const Model& model,
                           const PreparedBodyOptions& options) {
  const TetMesh mesh = corners_only(body);
  const MaterialSpec material = material_of(model);
  terms_ = live_terms(model, material);
  const auto modulus_at = [&](const Vec3& p) {
    return material.modulus[static_cast<std::size_t>(region_at(material, p))];
  };
  // A contact that feels its own region alone stands on a body of that modulus.
  const bool apart = material.local || material.modulus.size() == 1;
  std::vector<Lame> constants;
  constants.reserve(mesh.tets.size());
  const Lame unit = lame(1, material.nu);
  for (const auto& t : mesh.tets) {
    const Vec3 centre =
        (mesh.nodes[t[0]] + mesh.nodes[t[1]] + mesh.nodes[t[2]] + mesh.nodes[t[3]]) / 4;
    const double modulus = apart ? 1 : modulus_at(centre);
    constants.push_back({modulus * unit.lambda, modulus * unit.mu});
  }
  SurfaceCompliance compliance(mesh,
                               mesh.order == 2 ? Dilatation::kElement : Dilatation::kPointwise);
  compliance.factorise(constants, options.threads);
  surface_unknowns_ = static_cast<std::size_t>(compliance.matrix().rows());
  FieldMaterial about{material.nu, modulus_at, apart};
  field_ = std::make_unique<StiffnessField>(mesh, compliance, about, options.tool_radius,
                                            options.contacts);
  distance_ = std::make_unique<SignedDistance>(field_->surface(), "body");
}

std::vector<KnownStiffness> known_contacts(const BodyStiffness& body,
                                           const MaterialSpec& material) {
  std::vector<KnownStiffness> known;
  for (std::size_t p = 0; p < body.contacts().size(); ++p)
    known.push_back({body.contacts()[p].point, body.contacts()[p].normal, body.at(p, material).K});
  return known;
}

}  // namespace hapsim
