#include "simulate/full_body.h"

#include <utility>

#include "base/error.h"
#include "contact/element_groups.h"
#include "contact/feature_zone.h"
#include "contact/support_springs.h"
#include "experiment/dataset.h"
#include "experiment/forces.h"
#include "experiment/labels.h"
#include "material/hooke_law.h"
#include "material/hyperelastic_law.h"
#include "material/unit_law.h"
#include "solid/inhomogeneity.h"
#include "solid/membrane.h"

namespace hapsim {

FullBody::FullBody(const TetMesh& body, const Model& model, const FullOptions& options)
    : body_(body),
      averaged_(options.averaged),
      material_(material_of(model)),
      regions_(regional_relaxation_of(model, material_)) {
  for (EffectInstance& i : effect_instances(model, false)) {
    if (i.effect->full(i.values, material_.modulus[0], spec_)) continue;
    const Stage stage = i.effect->card().stage;
    if (stage != Stage::kSensor && stage != Stage::kMotion)
      fail_input(model.name,
                 "the full simulation has no form of the effect " + i.effect->card().name,
                 "take it out of the model, or simulate without --full");
    if (options.force_control)
      fail_input(model.name,
                 "forces are given to the body itself, without " + i.effect->card().name,
                 "take it out of the model, or simulate displacements");
    around_.push_back(std::move(i));
  }
  if (material_.shift != Vec3::Zero() || material_.rotation != Vec3::Zero())
    fail_input(model.name, "the full simulation does not move the body",
               "move the contact points instead");
  if (material_.local)
    fail_input(model.name, "the full simulation has no contacts that feel their own region alone",
               "set local of regions to 0");
  for (const FeatureSpec& f : material_.features)
    if (f.feature.kind == Feature::kTransverse && spec_.finite)
      fail_input(model.name, "finite strain of a transversely isotropic body is not in the model",
                 "take hyperelastic or anisotropic out");
  labels_ = acting_labels(material_, body);
  base_ = options.base != nullptr ? *options.base : make_contact_base(body);
  surface_ = free_surface(base_);
}

std::vector<std::vector<Relaxation>> FullBody::relaxation() const {
  std::vector<std::vector<Relaxation>> result;
  for (const RegionRelaxation& region : regions_) {
    result.emplace_back();
    for (const MaxwellModulus& t : region.terms)
      result.back().push_back({t.modulus / region.modulus, t.tau});
  }
  if (!regions_.empty() || spec_.terms.empty()) return result;
  result.resize(material_.modulus.size());
  for (std::vector<Relaxation>& law : result)
    for (const MaxwellTerm& t : spec_.terms) law.push_back({t.share, t.tau});
  return result;
}

BodyModel FullBody::model(const TetMesh& mesh, bool& free_base) const {
  BodyModel model;
  model.mesh = &mesh;
  const BodyFeature* transverse = nullptr;
  for (const FeatureSpec& f : material_.features)
    if (f.feature.kind == Feature::kTransverse) transverse = &f.feature;
  for (const double E : material_.modulus) {
    const Moduli m = moduli(E, material_.nu);
    model.laws.push_back(spec_.finite ? exponential_law(m.mu, spec_.stiffening, m.bulk)
                         : transverse != nullptr
                             ? transverse_body_law(E, material_.nu, transverse->value)
                             : isotropic_law(E, material_.nu));
  }
  place_regions(mesh, model);
  if (averaged_) model.dilatation = mesh.order == 2 ? Dilatation::kElement : Dilatation::kPatch;
  for (const FeatureSpec& f : material_.features) {
    if (is_zone(f.feature.kind)) {
      const std::vector<double> factors = stiffness_factors(
          inside_shares(mesh, zone_level(f.feature, surface_)).share, f.feature.value.back());
      if (model.scale.empty()) model.scale.assign(factors.size(), 1.0);
      for (std::size_t t = 0; t < factors.size(); ++t) model.scale[t] *= factors[t];
    }
    if (f.feature.kind == Feature::kTension)
      for (const MembraneFace& face : free_membrane(mesh))
        model.face_springs.push_back(
            {face.nodes, material_.modulus[0] * f.feature.value[0] * face.matrix});
    if (f.feature.kind != Feature::kSupport) continue;
    free_base = true;
    for (const SupportSprings::Face& face : SupportSprings(mesh, f.feature.value).faces)
      model.face_springs.push_back({face.nodes, material_.modulus[0] * face.spring * face.matrix});
  }
  return model;
}

void FullBody::place_regions(const TetMesh& mesh, BodyModel& model) const {
  if (&mesh == &body_ || !labels_) {
    for (const FeatureSpec& f : material_.features)
      if (f.feature.kind == Feature::kGrowth)
        fail_input("", "a region that has grown is not that of the body's own mesh",
                   "take its growth out, or press with one tool and without --own-mesh");
    for (std::size_t t = 0; t < mesh.tets.size(); ++t)
      model.law_of_tet.push_back(region_of_tet(material_, mesh, t));
    return;
  }
  Material by_label;
  by_label.labels = labels_;
  for (const FeatureSpec& f : material_.features) by_label.features.push_back(f.feature);
  const ElementGroups groups(mesh, by_label);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const std::size_t group = groups.main_group(t);
    model.law_of_tet.push_back(static_cast<int>(group));
    model.scale.push_back(groups.modulus(t, material_.modulus) / material_.modulus[group]);
  }
}

}  // namespace hapsim
