#include "fem/featured_body.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "base/error.h"
#include "fem/elasticity.h"
#include "fem/foundation.h"
#include "fem/inhomogeneity.h"
#include "fem/unit_law.h"

namespace hapsim {

std::size_t feature_size(Feature kind) {
  switch (kind) {
    case Feature::kLayer:
      return 2;
    case Feature::kInclusion:
      return 5;
    case Feature::kTransverse:
      return 4;
    default:
      return 3;
  }
}

namespace {

const BodyFeature* find_feature(const Material& material, Feature kind) {
  for (const BodyFeature& f : material.features)
    if (f.kind == kind) return &f;
  return nullptr;
}

bool is_zone(Feature kind) {
  return kind == Feature::kLayer || kind == Feature::kInclusion;
}

// A ball: the distance to it. Parameters: centre x, y, z, radius.
LevelSet ball_level(const Vec3& centre, double radius) {
  return [centre, radius](const Vec3& p) {
    const Vec3 d = p - centre;
    const double r = d.norm();
    LevelValue level{r - radius, Eigen::VectorXd::Zero(4), std::abs(r - radius)};
    if (r > 0) level.by_parameters.head<3>() = -d / r;
    level.by_parameters[3] = -1;
    return level;
  };
}

LevelSet zone_level(const BodyFeature& zone, const std::shared_ptr<const SurfaceTree>& surface) {
  if (zone.kind == Feature::kLayer) return layer_level(surface, zone.value[0]);
  return ball_level({zone.value[0], zone.value[1], zone.value[2]}, zone.value[3]);
}

// 3x3 blocks of an element's stiffness from the integrals of grad N_a (x) grad N_b.
class BlockMaker {
 public:
  explicit BlockMaker(const VoigtMatrix& D) {
    constexpr int kVoigt[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        for (int k = 0; k < 3; ++k)
          for (int l = 0; l < 3; ++l) by_gradients_[i][j](k, l) = D(kVoigt[i][k], kVoigt[j][l]);
  }
  Eigen::Matrix3d operator()(const Eigen::Matrix3d& g) const {
    Eigen::Matrix3d block = Eigen::Matrix3d::Zero();
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) block += g(i, j) * by_gradients_[i][j];
    return block;
  }

 private:
  Eigen::Matrix3d by_gradients_[3][3];  // D_ikjl
};

struct MeanGradients {
  double volume = 0;
  Eigen::Matrix<double, 3, 10> mean = Eigen::Matrix<double, 3, 10>::Zero();
  explicit MeanGradients(const ElementGradients& e) {
    for (int q = 0; q < e.points; ++q) {
      volume += e.weight[q];
      mean += e.weight[q] * e.gradient[q];
    }
    mean /= volume;
  }
};

void element_matrix(const ElementGradients& e, const BlockMaker& block, double kappa, double scale,
                    Eigen::Matrix<double, 30, 30>& K) {
  const MeanGradients m(e);
  for (int a = 0; a < 10; ++a)
    for (int b = a; b < 10; ++b) {
      Eigen::Matrix3d g = Eigen::Matrix3d::Zero();
      for (int q = 0; q < e.points; ++q)
        g.noalias() += e.weight[q] * e.gradient[q].col(a) * e.gradient[q].col(b).transpose();
      Eigen::Matrix3d k = block(g);
      k.noalias() += kappa * m.volume * m.mean.col(a) * m.mean.col(b).transpose();
      K.block<3, 3>(3 * a, 3 * b) = scale * k;
      if (a != b) K.block<3, 3>(3 * b, 3 * a) = scale * k.transpose();
    }
}

// Sums over the elements of what any law's energy needs of the three unit fields i, j:
// strain(i, j) = integral of eps_i eps_j', volume(i, j) = integral of mean div u_i div u_j.
struct FieldMoments {
  VoigtMatrix strain[3][3];
  Eigen::Matrix3d volume = Eigen::Matrix3d::Zero();
  FieldMoments() {
    for (auto& row : strain)
      for (VoigtMatrix& m : row) m.setZero();
  }
  FieldMoments(const ElementGradients& e, const Eigen::Matrix<double, 30, 3>& fields)
      : FieldMoments() {
    Eigen::Vector3d dilated = Eigen::Vector3d::Zero();
    double volume_of_element = 0;
    for (int q = 0; q < e.points; ++q) {
      Voigt eps[3];
      for (int i = 0; i < 3; ++i) {
        Eigen::Matrix3d g = Eigen::Matrix3d::Zero();  // d u_r / d x_c
        for (int a = 0; a < 10; ++a)
          g.noalias() += fields.block<3, 1>(3 * a, i) * e.gradient[q].col(a).transpose();
        eps[i] << g(0, 0), g(1, 1), g(2, 2), g(0, 1) + g(1, 0), g(1, 2) + g(2, 1),
            g(0, 2) + g(2, 0);
        dilated[i] += e.weight[q] * g.trace();
      }
      volume_of_element += e.weight[q];
      for (int i = 0; i < 3; ++i)
        for (int j = i; j < 3; ++j) strain[i][j] += e.weight[q] * eps[i] * eps[j].transpose();
    }
    volume = dilated * dilated.transpose() / volume_of_element;
  }
  void add(double weight, const FieldMoments& other) {
    for (int i = 0; i < 3; ++i)
      for (int j = i; j < 3; ++j) strain[i][j] += weight * other.strain[i][j];
    volume += weight * other.volume;
  }
  Eigen::Matrix3d energy(const VoigtMatrix& D, double kappa) const {
    Eigen::Matrix3d k = kappa * volume;
    for (int i = 0; i < 3; ++i)
      for (int j = i; j < 3; ++j) {
        const double value = strain[i][j].cwiseProduct(D).sum();
        k(i, j) += value;
        if (i != j) k(j, i) += value;
      }
    return k;
  }
};

// The bonded faces as springs, per unit modulus, and how these change with the support's values.
struct Support {
  struct Face {
    std::vector<int> nodes;
    Eigen::MatrixXd matrix;          // for a spring of 1 [1/m]
    double spring = 0;               // [1/m]
    std::array<double, 3> by_value;  // of the spring
  };
  std::vector<Face> faces;

  Support(const TetMesh& mesh, const std::vector<double>& value) {
    Foundation foundation;
    Vec3 low = Vec3::Constant(1e300), high = -low;
    for (const Triangle& f : boundary_faces(mesh)) {
      if (!mesh.fixed[f[0]] || !mesh.fixed[f[1]] || !mesh.fixed[f[2]]) continue;
      foundation.faces.push_back(f);
      for (const int n : f) {
        low = low.cwiseMin(mesh.nodes[n]);
        high = high.cwiseMax(mesh.nodes[n]);
      }
    }
    const Vec3 middle = 0.5 * (low + high);
    // A bonded base is a bed so thin that it does not show.
    const double least = 1e-5 * std::cbrt(volume(mesh));
    const double give = value[0];
    const Vec3 along(std::cos(value[1]), std::sin(value[1]), 0);
    const Vec3 across(-along.y(), along.x(), 0);
    const std::vector<FoundationFace> matrices = foundation_faces(mesh, foundation);
    for (std::size_t k = 0; k < matrices.size(); ++k) {
      const Triangle& f = foundation.faces[k];
      const Vec3 centre = (mesh.nodes[f[0]] + mesh.nodes[f[1]] + mesh.nodes[f[2]]) / 3 - middle;
      // How far the face reaches from its centre along the azimuth, and as that turns.
      double reach = 1e-9, reach_by_azimuth = 0;
      for (const int n : f) {
        const Vec3 arm = mesh.nodes[n] - middle - centre;
        if (std::abs(along.dot(arm)) <= reach) continue;
        reach = std::abs(along.dot(arm));
        reach_by_azimuth = (along.dot(arm) > 0 ? 1 : -1) * across.dot(arm);
      }
      // The share beyond the edge rises linearly while the edge crosses the face.
      const double level = along.dot(centre) - value[2];
      const double share = std::clamp(0.5 + level / (2 * reach), 0.0, 1.0);
      const bool cut = share > 0 && share < 1;
      const double by_level = cut ? 1 / (2 * reach) : 0;
      const double by_azimuth = by_level * (across.dot(centre) - level / reach * reach_by_azimuth);
      Face face{matrices[k].nodes, matrices[k].by_normal + matrices[k].by_tangential / 3, 0, {}};
      const double compliance = least + give * share;
      face.spring = 1 / compliance;
      const double by_share = -give / (compliance * compliance);
      face.by_value = {-share / (compliance * compliance), by_share * by_azimuth,
                       -by_share * by_level};
      faces.push_back(std::move(face));
    }
  }
};

Eigen::Matrix<double, 30, 3> local_fields(const TetMesh& mesh, std::size_t t,
                                          const Eigen::MatrixXd& phi) {
  Eigen::Matrix<double, 30, 3> local;
  for (int a = 0; a < 10; ++a)
    local.middleRows<3>(3 * a) = phi.middleRows<3>(3 * static_cast<Eigen::Index>(mesh.tets[t][a]));
  return local;
}

}  // namespace

struct FeaturedBody::Moduli {
  std::vector<int> group;
  std::vector<double> modulus;  // one a tetrahedron [Pa]
  // By the values of each feature (tetrahedra x values); no rows where it is no zone.
  std::vector<Eigen::MatrixXd> by_feature;
};

FeaturedBody::FeaturedBody(const ContactMesh& contact,
                           std::shared_ptr<const SurfaceTree> free_surface)
    : contact_(contact), free_surface_(std::move(free_surface)) {}

FeaturedBody::~FeaturedBody() = default;

FeaturedBody::Moduli FeaturedBody::moduli(const Material& material) const {
  const TetMesh& mesh = contact_.mesh;
  const auto count = static_cast<Eigen::Index>(mesh.tets.size());
  Moduli m;
  for (const auto& n : mesh.tets) {
    const Vec3 centre =
        (mesh.nodes[n[0]] + mesh.nodes[n[1]] + mesh.nodes[n[2]] + mesh.nodes[n[3]]) / 4;
    m.group.push_back(material.group_of ? material.group_of(centre) : 0);
    m.modulus.push_back(material.modulus[m.group.back()]);
  }
  std::vector<std::vector<double>> factors;
  for (const BodyFeature& f : material.features) {
    m.by_feature.emplace_back();
    factors.emplace_back();
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
  const Moduli m = moduli(material);
  const BodyFeature* transverse = find_feature(material, Feature::kTransverse);
  const UnitLaw law =
      unit_law(material.nu, transverse != nullptr ? transverse->value : std::vector<double>{});
  std::optional<Support> support;
  if (const BodyFeature* f = find_feature(material, Feature::kSupport))
    support.emplace(mesh, f->value);
  const double base_modulus = material.modulus[0];

  std::vector<char> moved(mesh.nodes.size(), 0);
  for (const int n : contact_.patch_nodes) moved[n] = 1;
  if (!system_ || supported_ != support.has_value()) {
    std::vector<char> free(mesh.nodes.size());
    for (std::size_t n = 0; n < free.size(); ++n)
      free[n] = !moved[n] && (support || !mesh.fixed[n]);
    Cliques cliques;
    for (const auto& n : mesh.tets) cliques.add({n.begin(), n.end()});
    if (support)
      for (const Support::Face& f : support->faces) cliques.add(f.nodes);
    system_ = std::make_unique<NodeSystem>(std::move(free), std::move(cliques));
    supported_ = support.has_value();
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
  if (support)
    for (std::size_t f = 0; f < support->faces.size(); ++f)
      system.add(tets + f, base_modulus * support->faces[f].spring * support->faces[f].matrix);
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
    s.by_modulus[m.group[t]] += m.modulus[t] / material.modulus[m.group[t]] * k;
    s.K += m.modulus[t] * k;
    for (std::size_t f = 0; f < m.by_feature.size(); ++f)
      for (Eigen::Index v = 0; v < m.by_feature[f].cols(); ++v)
        s.by_feature[f][v] += m.by_feature[f](static_cast<Eigen::Index>(t), v) * k;
  }
  s.by_nu = all.energy(law.D_by[0], law.kappa_by[0]);
  for (std::size_t f = 0; f < material.features.size(); ++f) {
    if (material.features[f].kind == Feature::kTransverse)
      for (std::size_t v = 0; v < 4; ++v)
        s.by_feature[f][v] = all.energy(law.D_by[1 + v], law.kappa_by[1 + v]);
    if (material.features[f].kind != Feature::kSupport) continue;
    for (const Support::Face& face : support->faces) {
      Eigen::MatrixXd fields(3 * static_cast<Eigen::Index>(face.nodes.size()), 3);
      for (std::size_t a = 0; a < face.nodes.size(); ++a)
        fields.middleRows<3>(3 * static_cast<Eigen::Index>(a)) =
            phi.middleRows<3>(3 * face.nodes[a]);
      const Eigen::Matrix3d k = base_modulus * fields.transpose() * face.matrix * fields;
      s.K += face.spring * k;
      s.by_modulus[0] += face.spring / base_modulus * k;
      for (std::size_t v = 0; v < 3; ++v) s.by_feature[f][v] += face.by_value[v] * k;
    }
  }
  return s;
}

}  // namespace hapsim
