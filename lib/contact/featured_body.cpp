#include "contact/featured_body.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.h"
#include "contact/element_mixture.h"
#include "contact/support_springs.h"
#include "material/unit_law.h"
#include "solid/elasticity.h"
#include "solid/element_moments.h"
#include "solid/membrane.h"

namespace hapsim {

namespace {

const BodyFeature* find_feature(const Material& material, Feature kind) {
  for (const BodyFeature& f : material.features)
    if (f.kind == kind) return &f;
  return nullptr;
}

Eigen::Matrix<double, 30, 3> local_fields(const TetMesh& mesh, std::size_t t,
                                          const Eigen::MatrixXd& phi) {
  Eigen::Matrix<double, 30, 3> local;
  for (int a = 0; a < 10; ++a)
    local.middleRows<3>(3 * a) = phi.middleRows<3>(3 * static_cast<Eigen::Index>(mesh.tets[t][a]));
  return local;
}

Eigen::MatrixXd fields_at(const std::vector<int>& nodes, const Eigen::MatrixXd& phi) {
  Eigen::MatrixXd fields(3 * static_cast<Eigen::Index>(nodes.size()), 3);
  for (std::size_t a = 0; a < nodes.size(); ++a)
    fields.middleRows<3>(3 * static_cast<Eigen::Index>(a)) = phi.middleRows<3>(3 * nodes[a]);
  return fields;
}

// What features put on faces: a matrix times so much per unit modulus.
struct FaceTerm {
  std::size_t feature = 0;
  std::vector<int> nodes;
  Eigen::MatrixXd matrix;
  double factor = 0;
  std::vector<double> by_value;  // of the factor
};

std::vector<FaceTerm> face_terms(const Material& material, const TetMesh& mesh) {
  std::vector<FaceTerm> terms;
  for (std::size_t f = 0; f < material.features.size(); ++f) {
    const BodyFeature& feature = material.features[f];
    if (feature.kind == Feature::kSupport)
      for (SupportSprings::Face& face : SupportSprings(mesh, feature.value).faces)
        terms.push_back({f,
                         std::move(face.nodes),
                         std::move(face.matrix),
                         face.spring,
                         {face.by_value.begin(), face.by_value.end()}});
    if (feature.kind == Feature::kTension)
      for (MembraneFace& face : free_membrane(mesh))
        terms.push_back(
            {f, std::move(face.nodes), std::move(face.matrix), feature.value[0], {1.0}});
  }
  return terms;
}

}  // namespace

FeaturedBody::FeaturedBody(const ContactMesh& contact,
                           std::shared_ptr<const SurfaceTree> free_surface)
    : contact_(contact), free_surface_(std::move(free_surface)) {}

FeaturedBody::~FeaturedBody() = default;

void FeaturedBody::forget_system() {
  if (system_) order_ = system_->order();
  system_.reset();
}

// What labels cut of a mesh is dear, and they never change.
std::shared_ptr<const ElementGroups> FeaturedBody::groups(const Material& material) {
  const bool grows = find_feature(material, Feature::kGrowth) != nullptr;
  if (groups_ && material.labels && labels_ == material.labels && !grows) return groups_;
  auto made =
      std::make_shared<const ElementGroups>(contact_.mesh, material, contact_.follows_inner);
  if (material.labels && !grows) {
    groups_ = made;
    labels_ = material.labels;
  }
  return made;
}

FeaturedBody::Solution FeaturedBody::solve(const Material& material) {
  const TetMesh& mesh = contact_.mesh;
  const std::size_t tets = mesh.tets.size();
  const auto group = groups(material);
  const BodyFeature* transverse = find_feature(material, Feature::kTransverse);
  const UnitLaw law =
      unit_law(material.nu, transverse != nullptr ? transverse->value : std::vector<double>{});
  const ElementMixture mixture(mesh, material, *group, free_surface_, law);
  const bool support = find_feature(material, Feature::kSupport) != nullptr;
  const std::vector<FaceTerm> on_faces = face_terms(material, mesh);
  const double base_modulus = material.modulus[0];

  std::vector<char> moved(mesh.nodes.size(), 0);
  for (const int n : contact_.patch_nodes) moved[n] = 1;
  if (!system_ || supported_ != support || face_terms_ != on_faces.size()) {
    std::vector<char> free(mesh.nodes.size());
    for (std::size_t n = 0; n < free.size(); ++n)
      free[n] = !moved[n] && (support || !mesh.fixed[n]);
    Cliques cliques;
    for (const auto& n : mesh.tets) cliques.add({n.begin(), n.end()});
    for (const FaceTerm& f : on_faces) cliques.add(f.nodes);
    system_ = std::make_unique<NodeSystem>(std::move(free), std::move(cliques));
    if (supported_ == support) system_->eliminate_in(std::move(order_));
    order_.clear();
    supported_ = support;
    face_terms_ = on_faces.size();
  }
  NodeSystem& system = *system_;
  system.clear();

  Eigen::MatrixXd phi = Eigen::MatrixXd::Zero(3 * static_cast<Eigen::Index>(mesh.nodes.size()), 3);
  for (const int n : contact_.patch_nodes) phi.middleRows<3>(3 * n).setIdentity();
  Eigen::MatrixXd load = Eigen::MatrixXd::Zero(phi.rows(), 3);
  const BlockMaker block(law.D);
  Eigen::Matrix<double, 30, 30> K, more;
  for (std::size_t t = 0; t < tets; ++t) {
    const auto& n = mesh.tets[t];
    const ElementGradients gradients = element_gradients(mesh, t);
    element_matrix(gradients, block, law.kappa, mixture.scale(t), K);
    if (const VoigtMatrix* beyond = mixture.beyond(t)) {
      element_matrix(gradients, BlockMaker(*beyond), 0, 1, more);
      K += more;
    }
    system.add(t, K);
    if (std::none_of(n.begin(), n.end(), [&](int a) { return moved[a]; })) continue;
    const Eigen::Matrix<double, 30, 3> force = K * local_fields(mesh, t, phi);
    for (int a = 0; a < 10; ++a) load.middleRows<3>(3 * n[a]) -= force.middleRows<3>(3 * a);
  }
  for (std::size_t f = 0; f < on_faces.size(); ++f) {
    const FaceTerm& face = on_faces[f];
    const Eigen::MatrixXd matrix = base_modulus * face.factor * face.matrix;
    system.add(tets + f, matrix);
    if (std::none_of(face.nodes.begin(), face.nodes.end(), [&](int a) { return moved[a]; }))
      continue;
    const Eigen::MatrixXd force = matrix * fields_at(face.nodes, phi);
    for (std::size_t a = 0; a < face.nodes.size(); ++a)
      load.middleRows<3>(3 * face.nodes[a]) -=
          force.middleRows<3>(3 * static_cast<Eigen::Index>(a));
  }
  if (!system.factorise())
    fail_numerics("", "the stiffness matrix is not positive definite",
                  "check that the body has fixed nodes, nu < 0.5 and all moduli are positive");
  phi += system.solve(load);

  Solution s{Eigen::Matrix3d::Zero(), Eigen::Matrix3d::Zero(), Eigen::Matrix3d::Zero(), {}, {}};
  s.by_modulus.assign(material.modulus.size(), Eigen::Matrix3d::Zero());
  for (const BodyFeature& f : material.features)
    s.by_feature.emplace_back(f.value.size(), Eigen::Matrix3d::Zero());
  std::vector<Eigen::Matrix3d> by_law(law.D_by.size(), Eigen::Matrix3d::Zero());
  for (std::size_t t = 0; t < tets; ++t)
    mixture.add(t, FieldMoments(element_gradients(mesh, t), local_fields(mesh, t, phi)), s, by_law);
  s.by_nu = by_law[0];
  for (std::size_t f = 0; f < material.features.size(); ++f)
    if (material.features[f].kind == Feature::kTransverse)
      for (std::size_t v = 0; v < 4; ++v) s.by_feature[f][v] = by_law[1 + v];
  for (const FaceTerm& face : on_faces) {
    const Eigen::MatrixXd fields = fields_at(face.nodes, phi);
    const Eigen::Matrix3d k = base_modulus * fields.transpose() * face.matrix * fields;
    s.K += face.factor * k;
    s.by_modulus[0] += face.factor / base_modulus * k;
    for (std::size_t v = 0; v < face.by_value.size(); ++v)
      s.by_feature[face.feature][v] += face.by_value[v] * k;
  }
  return s;
}

}  // namespace hapsim
