#include "contact/featured_body.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.h"
#include "contact/feature_zone.h"
#include "contact/support_springs.h"
#include "material/unit_law.h"
#include "solid/elasticity.h"
#include "solid/element_moments.h"
#include "solid/inhomogeneity.h"
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

struct FeaturedBody::Moduli {
  std::vector<double> modulus;   // one a tetrahedron [Pa]
  std::vector<double> of_group;  // without zones [Pa]
  // By the values of each feature (tetrahedra x values); no rows where it is no zone.
  std::vector<Eigen::MatrixXd> by_feature;
};

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
  auto made = std::make_shared<const ElementGroups>(contact_.mesh, material);
  if (material.labels && !grows) {
    groups_ = made;
    labels_ = material.labels;
  }
  return made;
}

FeaturedBody::Moduli FeaturedBody::moduli(const Material& material,
                                          const ElementGroups& groups) const {
  const TetMesh& mesh = contact_.mesh;
  const auto count = static_cast<Eigen::Index>(mesh.tets.size());
  Moduli m;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    m.modulus.push_back(groups.modulus(t, material.modulus));
  m.of_group = m.modulus;
  std::vector<std::vector<double>> factors;
  std::size_t growths = 0;
  for (const BodyFeature& f : material.features) {
    m.by_feature.emplace_back();
    factors.emplace_back();
    if (f.kind == Feature::kGrowth) {
      Eigen::MatrixXd& by = m.by_feature.back();
      by.setZero(count, 2);
      for (Eigen::Index t = 0; t < count; ++t)
        by(t, 1) = groups.modulus_by_growth(static_cast<std::size_t>(t), material.modulus, growths);
      ++growths;
      factors.back() = m.of_group;
    }
    if (!is_zone(f.kind)) continue;
    const double ratio = f.value.back();
    const InsideShares inside = inside_shares(mesh, zone_level(f, free_surface_));
    factors.back() = stiffness_factors(inside.share, ratio);
    Eigen::MatrixXd& by = m.by_feature.back();
    by.resize(count, static_cast<Eigen::Index>(f.value.size()));
    by.leftCols(by.cols() - 1) = (ratio - 1) * inside.by_parameters;
    by.rightCols<1>() = Eigen::Map<const Eigen::VectorXd>(inside.share.data(), count);
    for (std::size_t t = 0; t < mesh.tets.size(); ++t) m.modulus[t] *= factors.back()[t];
  }
  for (std::size_t k = 0; k < m.by_feature.size(); ++k)
    for (Eigen::Index t = 0; t < m.by_feature[k].rows(); ++t)
      m.by_feature[k].row(t) *=
          m.modulus[static_cast<std::size_t>(t)] / factors[k][static_cast<std::size_t>(t)];
  return m;
}

FeaturedBody::Solution FeaturedBody::solve(const Material& material) {
  const TetMesh& mesh = contact_.mesh;
  const std::size_t tets = mesh.tets.size();
  const auto group = groups(material);
  const Moduli m = moduli(material, *group);
  const BodyFeature* transverse = find_feature(material, Feature::kTransverse);
  const UnitLaw law =
      unit_law(material.nu, transverse != nullptr ? transverse->value : std::vector<double>{});
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
  Eigen::Matrix<double, 30, 30> K;
  for (std::size_t t = 0; t < tets; ++t) {
    const auto& n = mesh.tets[t];
    element_matrix(element_gradients(mesh, t), block, law.kappa, m.modulus[t], K);
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

  Solution s{Eigen::Matrix3d::Zero(), {}, {}, {}};
  s.by_modulus.assign(material.modulus.size(), Eigen::Matrix3d::Zero());
  for (const BodyFeature& f : material.features)
    s.by_feature.emplace_back(f.value.size(), Eigen::Matrix3d::Zero());
  FieldMoments all;
  for (std::size_t t = 0; t < tets; ++t) {
    const FieldMoments moments(element_gradients(mesh, t), local_fields(mesh, t, phi));
    const Eigen::Matrix3d k = moments.energy(law.D, law.kappa);
    all.add(m.modulus[t], moments);
    group->for_each(t, [&](std::size_t g, double share) {
      // Zones multiply it; of one group its own modulus drops out exactly.
      s.by_modulus[g] +=
          share * (m.modulus[t] / m.of_group[t]) * (m.of_group[t] / material.modulus[g]) * k;
    });
    s.K += m.modulus[t] * k;
    for (std::size_t f = 0; f < m.by_feature.size(); ++f)
      for (Eigen::Index v = 0; v < m.by_feature[f].cols(); ++v)
        s.by_feature[f][v] += m.by_feature[f](static_cast<Eigen::Index>(t), v) * k;
  }
  s.by_nu = all.energy(law.D_by[0], law.kappa_by[0]);
  for (std::size_t f = 0; f < material.features.size(); ++f)
    if (material.features[f].kind == Feature::kTransverse)
      for (std::size_t v = 0; v < 4; ++v)
        s.by_feature[f][v] = all.energy(law.D_by[1 + v], law.kappa_by[1 + v]);
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
