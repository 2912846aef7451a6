#include "exchange/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "effects/catalogue.h"
#include "experiment/forces.h"
#include "experiment/labels.h"
#include "experiment/nearest_region.h"
#include "model/relaxation_steps.h"
#include "solid/mesh_press.h"

namespace hapsim {
namespace {

[[noreturn]] void refuse(const Model& model, const std::string& effect, const std::string& why) {
  fail_input(model.name, fmt::format("the effect {} cannot be exported: {}", effect, why),
             "take it out of the model (hs-identify --remove " + effect + ")");
}

// What the effects ask of the body beyond its moduli.
FullSpec checked_effects(const Model& model, const MaterialSpec& material, bool bare) {
  FullSpec all;
  for (const EffectInstance& i : effect_instances(model, false)) {
    const EffectCard& card = i.effect->card();
    if (card.stage == Stage::kSensor || card.stage == Stage::kMotion) {
      if (bare) continue;
      fail_input(model.name,
                 "the effect " + card.name + " acts on what is measured, not on the body",
                 "add --bare to export the body without it");
    }
    FullSpec own;
    if (!i.effect->full(i.values, material.modulus[0], own))
      refuse(model, card.name, "finite elements have no form of it");
    if (card.solved && !card.is_map && !material.features.empty())
      refuse(model, card.name, "it is solved on meshes of its own");
    if (own.curvature > 0) refuse(model, card.name, "the tool of the scene is flat and bonded");
    if (std::isfinite(own.friction))
      refuse(model, card.name, "the tool of the scene is flat and bonded");
    if (own.finite && own.stiffening > 0)
      refuse(model, card.name,
             "its exponential law is in none of these programs; s = 0 is neo-Hookean");
    all.finite = all.finite || own.finite;
    all.terms.insert(all.terms.end(), own.terms.begin(), own.terms.end());
  }
  if (!material.features.empty() || material.shift.norm() > 0 || material.rotation.norm() > 0)
    fail_input(model.name,
               "the model has an effect that moves the body or is solved on meshes of its own",
               "take it out of the model (hs-identify --remove)");
  if (material.local)
    refuse(model, map_effect().card().name,
           "its contacts feel their own region alone; set local to 0 and fit again");
  if (!regional_relaxation_of(model, material).empty())
    refuse(model, maxwell_effect().card().name, "its regions relax each in its own way");
  return all;
}

// At most `count` of `rows`, evenly, with the last and the one of the deepest displacement.
std::vector<int> thinned(const std::vector<int>& rows, const Recording& r, std::size_t count) {
  std::vector<int> kept;
  if (rows.size() <= count) return rows;
  for (std::size_t k = 1; k <= count; ++k) kept.push_back(rows[k * (rows.size() - 1) / count]);
  const int deepest = *std::max_element(rows.begin(), rows.end(), [&](int a, int b) {
    return r.u[static_cast<std::size_t>(a)].norm() < r.u[static_cast<std::size_t>(b)].norm();
  });
  const auto at = std::lower_bound(kept.begin(), kept.end(), deepest);
  if (at == kept.end() || *at != deepest) {
    // In the place of its neighbour, unless that is the last.
    if (at != kept.end() && at + 1 != kept.end())
      *at = deepest;
    else
      kept.insert(at, deepest);
  }
  return kept;
}

}  // namespace

void write_xml_remarks(std::ostream& out, const Scene& scene) {
  for (std::string remark : scene.remarks) {
    for (std::size_t at; (at = remark.find("--")) != remark.npos;) remark.erase(at, 1);
    out << "<!-- " << remark << " -->\n";
  }
}

std::vector<int> regions_of(const TetMesh& mesh, const MaterialSpec& material,
                            const BodyRegions* labels) {
  std::vector<int> region;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const Vec3 centre = tet_centroid(mesh, t);
    region.push_back(labels != nullptr ? labels->at(centre) : region_at(material, centre));
  }
  return region;
}

Scene make_scene(const TetMesh& body, const Model& model, const Recording& recording,
                 const std::vector<int>& press, const SceneOptions& options) {
  const MaterialSpec material = material_of(model);
  const FullSpec spec = checked_effects(model, material, options.bare);
  Scene scene;
  scene.model_name = model.name;
  scene.mesh = body;
  scene.modulus = material.modulus;
  scene.nu = material.nu;
  scene.finite = spec.finite;
  scene.terms = spec.terms;
  if (!acting_labels(material, body) && material.key_point.empty())
    scene.modulus.resize(1);  // the body's own regions stay
  if (!material.key_point.empty()) scene.mesh.region = regions_of(body, material, nullptr);
  if (press.empty()) return scene;
  scene.tool = patch_under_tool(body, recording.position[static_cast<std::size_t>(press[0])],
                                recording.tool_radius())
                   .nodes;
  std::sort(scene.tool.begin(), scene.tool.end());
  const std::vector<int> rows = thinned(press, recording, std::max<std::size_t>(1, options.steps));
  const bool timed = !recording.t.empty();
  for (const int row : rows) {
    const auto i = static_cast<std::size_t>(row);
    const double t = timed ? recording.t[i] - recording.t[static_cast<std::size_t>(press[0])]
                           : static_cast<double>(scene.t.size() + 1);
    if (t <= (scene.t.empty() ? 0 : scene.t.back())) continue;  // the first row, and equal times
    scene.t.push_back(t);
    scene.u.push_back(recording.in_air(i) ? Vec3(Vec3::Zero()) : recording.u[i]);
  }
  if (scene.t.empty()) {  // a press of one row
    scene.t.push_back(1);
    scene.u.push_back(recording.u[static_cast<std::size_t>(press[0])]);
  }
  return scene;
}

}  // namespace hapsim
