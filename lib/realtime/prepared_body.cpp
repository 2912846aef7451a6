#include "realtime/prepared_body.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <string>

#include "base/error.h"
#include "experiment/forces.h"
#include "experiment/nearest_region.h"
#include "simulate/regional_relaxation.h"

namespace hapsim {
namespace {

constexpr std::size_t kMostLeftOut = 24;  // contacts, spread over all of them

// The corners' mesh: the field puts the tool's own neighbourhood in, which is where second order
// counts. Middles become nodes that no tetrahedron uses, which are held.
TetMesh corners_only(TetMesh mesh) {
  mesh.order = 1;
  for (auto& t : mesh.tets) std::fill(t.begin() + 4, t.end(), -1);
  return mesh;
}

// The field of one material on a mesh whose sparsity is analysed once.
class FieldMaker {
 public:
  FieldMaker(const TetMesh& mesh, const PreparedBodyOptions& options)
      : mesh_(mesh), options_(options), compliance_(mesh, Dilatation::kPointwise) {}

  std::unique_ptr<StiffnessField> field(const MaterialSpec& material,
                                        const StiffnessField* like = nullptr) {
    const auto modulus_at = [&](const Vec3& p) {
      return material.local ? local_modulus(material, p).value
                            : material.modulus[static_cast<std::size_t>(region_at(material, p))];
    };
    // A contact that feels its own region alone stands on a body of that modulus.
    const bool apart = material.local || material.modulus.size() == 1;
    if (!apart || !condensed_) {
      std::vector<Lame> constants;
      constants.reserve(mesh_.tets.size());
      const Lame unit = lame(1, material.nu);
      for (const auto& t : mesh_.tets) {
        const Vec3 centre =
            (mesh_.nodes[t[0]] + mesh_.nodes[t[1]] + mesh_.nodes[t[2]] + mesh_.nodes[t[3]]) / 4;
        const double modulus = apart ? 1 : modulus_at(centre);
        constants.push_back({modulus * unit.lambda, modulus * unit.mu});
      }
      compliance_.factorise(constants, options_.threads);
      condensed_ = apart;
    }
    about_ = {material.nu, modulus_at, apart};
    if (options_.contacts) known_ = options_.contacts(material);
    return std::make_unique<StiffnessField>(mesh_, compliance_, about_, options_.tool_radius,
                                            known_, like);
  }
  // Of the last field's known contacts, each from those that lie farther off than the tool's
  // radius.
  LeftOut left_out() const {
    LeftOut result;
    const std::size_t every = (known_.size() + kMostLeftOut - 1) / kMostLeftOut;
    double squares = 0;
    for (std::size_t k = 0; k < known_.size(); k += every) {
      std::vector<KnownStiffness> others;
      for (const KnownStiffness& o : known_)
        if ((o.point - known_[k].point).norm() > options_.tool_radius) others.push_back(o);
      if (others.empty()) continue;
      const StiffnessField field(mesh_, compliance_, about_, options_.tool_radius, others);
      const SurfacePoint place = nearest_point(field.surface(), known_[k].point);
      const double error =
          (field.at(place.face, place.point) - known_[k].K).norm() / known_[k].K.norm();
      squares += error * error;
      result.worst = std::max(result.worst, error);
      ++result.contacts;
    }
    if (result.contacts > 0) result.rms = std::sqrt(squares / static_cast<double>(result.contacts));
    return result;
  }
  const std::vector<KnownStiffness>& known() const { return known_; }  // of the last field
  std::size_t unknowns() const { return static_cast<std::size_t>(compliance_.matrix().rows()); }

 private:
  const TetMesh& mesh_;
  const PreparedBodyOptions& options_;
  SurfaceCompliance compliance_;
  FieldMaterial about_;
  std::vector<KnownStiffness> known_;
  bool condensed_ = false;  // of unit modulus: serves any
};

}  // namespace

PreparedBody::PreparedBody(const TetMesh& body, const Model& model,
                           const PreparedBodyOptions& options)
    : effects_(effect_instances(model, false)),
      tool_radius_(options.tool_radius),
      heals_(options.heals) {
  const TetMesh mesh = corners_only(body);
  const MaterialSpec material = material_of(model);
  modulus_ = material.modulus[0];
  const bool moved = material.shift != Vec3::Zero() || material.rotation != Vec3::Zero();
  if ((moved || !material.features.empty()) && !options.contacts)
    fail_input(model.name,
               moved ? "the body has moved, which its own mesh does not know"
                     : "the body has features that its own mesh does not show",
               "have the contacts solved finely: hs-simulate --live --contacts data.csv");
  const ModelRelaxation relaxation = relaxation_of(model, material);
  FieldMaker maker(mesh, options);
  field_ = maker.field(material);
  surface_unknowns_ = maker.unknowns();
  left_out_ = maker.left_out();
  facts_ = std::make_unique<PlaceFacts>(*field_, material, maker.known());
  terms_ = relaxation.common;
  if (!relaxation.regional.empty())
    prepare_regional(relaxation.regional, material,
                     [&](const MaterialSpec& m) { return maker.field(m, field_.get()); });
  if (is_regional() && terms_.size() > static_cast<std::size_t>(kMostTerms))
    fail_input(model.name, "the model has " + std::to_string(terms_.size()) + " relaxation times",
               "the real-time loop takes up to " + std::to_string(kMostTerms));
  distance_ = std::make_unique<SignedDistance>(field_->surface(), "body");
}

void PreparedBody::prepare_regional(
    const std::vector<RegionRelaxation>& regions, const MaterialSpec& relaxed,
    const std::function<std::unique_ptr<StiffnessField>(const MaterialSpec&)>& field_for) {
  assert(terms_.empty());  // an effect's terms are common or regional
  const std::size_t vertices = field_->surface().vertices.size();
  const auto solve = [&](const MaterialSpec& material) {
    const std::unique_ptr<StiffnessField> field = field_for(material);
    std::vector<Eigen::Matrix3d> K;
    for (std::size_t v = 0; v < vertices; ++v) K.push_back(field->at_vertex(static_cast<int>(v)));
    return K;
  };
  const std::vector<PositionStiffness> stiffness =
      regional_stiffness(regions, relaxed, solve, misfit_);
  for (const PositionStiffness& s : stiffness)
    for (const MaxwellStiffness& element : s.relaxing) maxwell_.push_back(element.K);
  for (const MaxwellStiffness& element : stiffness.front().relaxing)
    terms_.push_back({1, element.tau});
}

void PreparedBody::maxwell_at(int face, const Vec3& point, Eigen::Matrix3d* K) const noexcept {
  const Vec3 weight = field_->weights(face, point);
  const Triangle& t = field_->surface().faces[face];
  const std::size_t terms = terms_.size();
  for (std::size_t j = 0; j < terms; ++j)
    K[j] = weight[0] * maxwell_[static_cast<std::size_t>(t[0]) * terms + j] +
           weight[1] * maxwell_[static_cast<std::size_t>(t[1]) * terms + j] +
           weight[2] * maxwell_[static_cast<std::size_t>(t[2]) * terms + j];
}

std::vector<KnownStiffness> known_contacts(const Places& places, const MaterialSpec& material) {
  const Linearisation about = places.solve(material);
  std::vector<KnownStiffness> known;
  for (std::size_t p = 0; p < places.size(); ++p)
    known.push_back({places.contact(p).point, places.contact(p).normal, about.at(p, material).K});
  return known;
}

}  // namespace hapsim
