#include "contact/feature_estimate.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "contact/feature_zone.h"
#include "material/unit_law.h"
#include "solid/elastic_body.h"
#include "solid/foundation.h"
#include "solid/membrane.h"

namespace hapsim {
namespace {

// exp(S) of a symmetric matrix, and its derivative along symmetric directions (Daleckii and Krein,
// 1965).
class SymmetricExponential {
 public:
  explicit SymmetricExponential(const Eigen::Matrix3d& S) : eigen_(S) {
    const Eigen::Vector3d l = eigen_.eigenvalues();
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        const double gap = l[i] - l[j];
        slope_(i, j) = std::exp(l[j]) * (std::abs(gap) < 1e-9 ? 1 : std::expm1(gap) / gap);
      }
  }
  Eigen::Matrix3d value() const {
    return eigen_.eigenvectors() * eigen_.eigenvalues().array().exp().matrix().asDiagonal() *
           eigen_.eigenvectors().transpose();
  }
  Eigen::Matrix3d along(const Eigen::Matrix3d& direction) const {
    const Eigen::Matrix3d& V = eigen_.eigenvectors();
    return V * (V.transpose() * direction * V).cwiseProduct(slope_) * V.transpose();
  }

 private:
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen_;
  Eigen::Matrix3d slope_;
};

using Fields = Eigen::Matrix<double, Eigen::Dynamic, 3>;

Fields homogeneous_fields(const ContactMesh& contact, double nu) {
  const TetMesh& mesh = contact.mesh;
  std::vector<int> handle(mesh.nodes.size(), kFreeNode);
  for (std::size_t n = 0; n < handle.size(); ++n)
    if (mesh.fixed[n]) handle[n] = kHeldNode;
  for (const int n : contact.patch_nodes) handle[n] = 0;
  ElasticBody body(mesh, handle, Dilatation::kElement);
  body.factorise(std::vector<Lame>(mesh.tets.size(), lame(1, nu)));
  return body.solve(Eigen::Matrix3d::Identity()).field;
}

// Thicknesses of the table are at deepest * (k / kDepths)^2: close where the energy is.
constexpr int kDepths = 200;

}  // namespace

FeatureEstimate::FeatureEstimate(std::shared_ptr<const ContactMesh> contact,
                                 const SurfaceTree& free_surface, double poisson_ratio)
    : contact_(std::move(contact)), mesh_(contact_->mesh), nu_(poisson_ratio) {
  const Fields phi = homogeneous_fields(*contact_, nu_);
  const UnitLaw law = unit_law(nu_, {});
  const BlockMaker block(law.D);
  std::vector<Eigen::Matrix3d> reaction(mesh_.nodes.size(), Eigen::Matrix3d::Zero());
  Eigen::Matrix<double, 30, 30> stiffness;
  Eigen::Matrix<double, 30, 3> local;
  std::vector<Eigen::Matrix3d> share;  // S, one a tetrahedron; their sum is the identity
  Eigen::Matrix3d K = Eigen::Matrix3d::Zero();
  for (std::size_t t = 0; t < mesh_.tets.size(); ++t) {
    const auto& n = mesh_.tets[t];
    const ElementGradients gradients = element_gradients(mesh_, t);
    bool at_base = false;
    for (int a = 0; a < 10; ++a) {
      local.middleRows<3>(3 * a) = phi.middleRows<3>(3 * static_cast<Eigen::Index>(n[a]));
      at_base = at_base || mesh_.fixed[n[a]];
    }
    const FieldMoments moments(gradients, local);
    moments_.add(1, moments);
    share.push_back(moments.energy(law.D, law.kappa));
    K += share.back();
    if (!at_base) continue;
    element_matrix(gradients, block, law.kappa, 1, stiffness);
    const Eigen::Matrix<double, 30, 3> force = stiffness * local;
    for (int a = 0; a < 10; ++a)
      if (mesh_.fixed[n[a]]) reaction[n[a]] += force.middleRows<3>(3 * a);
  }
  inverse_ = Eigen::Matrix3d(K.llt().matrixL()).inverse();
  for (const MembraneFace& face : free_membrane(mesh_)) {
    Fields at_face(3 * static_cast<Eigen::Index>(face.nodes.size()), 3);
    for (std::size_t a = 0; a < face.nodes.size(); ++a)
      at_face.middleRows<3>(3 * static_cast<Eigen::Index>(a)) =
          phi.middleRows<3>(3 * static_cast<Eigen::Index>(face.nodes[a]));
    tension_ += at_face.transpose() * face.matrix * at_face;
  }
  tension_ = (inverse_ * tension_ * inverse_.transpose()).eval();
  for (Eigen::Matrix3d& k : share) k = (inverse_ * k * inverse_.transpose()).eval();
  tree_ = ShareTree(mesh_, share);
  tabulate_depths(free_surface, share);
  make_base(reaction);
  Vec3 middle = Vec3::Zero();
  int held = 0;
  for (std::size_t n = 0; n < mesh_.nodes.size(); ++n)
    if (mesh_.fixed[n]) {
      middle += mesh_.nodes[n];
      ++held;
    }
  if (held > 0) height_ = std::abs(contact_->point.z() - middle.z() / held);
}

// Each tetrahedron's share is spread evenly over the depths between its corners.
void FeatureEstimate::tabulate_depths(const SurfaceTree& free_surface,
                                      const std::vector<Eigen::Matrix3d>& share) {
  std::vector<double> depth(mesh_.nodes.size(), 0);
  for (const auto& n : mesh_.tets)
    for (int a = 0; a < 4; ++a)
      if (depth[n[a]] == 0) depth[n[a]] = free_surface.nearest(mesh_.nodes[n[a]]).distance;
  deepest_ = *std::max_element(depth.begin(), depth.end());
  shallow_.assign(kDepths + 1, Eigen::Matrix3d::Zero());
  for (std::size_t t = 0; t < mesh_.tets.size(); ++t) {
    const auto& n = mesh_.tets[t];
    double low = depth[n[0]], high = low;
    for (int a = 1; a < 4; ++a) {
      low = std::min(low, depth[n[a]]);
      high = std::max(high, depth[n[a]]);
    }
    for (int k = 1; k <= kDepths; ++k) {
      const double thickness = deepest_ * k * k / (kDepths * kDepths);
      if (thickness <= low) continue;
      shallow_[static_cast<std::size_t>(k)] +=
          (thickness >= high ? 1 : (thickness - low) / (high - low)) * share[t];
    }
  }
}

// What the bonded faces carry, and by how much a bed below them lets the contact sink.
void FeatureEstimate::make_base(const std::vector<Eigen::Matrix3d>& reaction) {
  Foundation foundation;
  Vec3 low = Vec3::Constant(1e300), high = -low;
  for (const Triangle& f : boundary_faces(mesh_)) {
    if (!mesh_.fixed[f[0]] || !mesh_.fixed[f[1]] || !mesh_.fixed[f[2]]) continue;
    foundation.faces.push_back(f);
    for (const int n : f) {
      low = low.cwiseMin(mesh_.nodes[n]);
      high = high.cwiseMax(mesh_.nodes[n]);
    }
  }
  const Vec3 middle = 0.5 * (low + high);
  const std::vector<FoundationFace> faces = foundation_faces(mesh_, foundation);
  std::vector<double> area_at(mesh_.nodes.size(), 0);
  std::vector<Eigen::Matrix3d> bed;  // of E/h and E/(3 h) for E = h = 1, summed over a face
  for (const FoundationFace& face : faces) {
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    const auto nodes = static_cast<Eigen::Index>(face.nodes.size());
    for (Eigen::Index a = 0; a < nodes; ++a)
      for (Eigen::Index b = 0; b < nodes; ++b)
        sum += face.by_normal.block<3, 3>(3 * a, 3 * b) +
               face.by_tangential.block<3, 3>(3 * a, 3 * b) / 3;
    bed.push_back(sum);
    for (const int n : face.nodes) area_at[n] += sum.norm();
  }
  for (std::size_t f = 0; f < faces.size(); ++f) {
    Eigen::Matrix3d R = Eigen::Matrix3d::Zero();
    for (const int n : faces[f].nodes) R += bed[f].norm() / area_at[n] * reaction[n];
    R = (R * inverse_.transpose()).eval();
    const Triangle& corner = foundation.faces[f];
    BaseFace face;
    const Vec3 centre =
        (mesh_.nodes[corner[0]] + mesh_.nodes[corner[1]] + mesh_.nodes[corner[2]]) / 3;
    for (const int n : corner) face.size = std::max(face.size, (mesh_.nodes[n] - centre).norm());
    face.centre = centre - middle;
    face.compliance = R.transpose() * bed[f].inverse() * R;
    base_.push_back(face);
  }
}

FeatureEstimate::Change FeatureEstimate::at(const BodyFeature& feature) const {
  switch (feature.kind) {
    case Feature::kLayer:
      return of_layer(feature);
    case Feature::kInclusion:
      return of_ball(feature);
    case Feature::kTransverse:
      return of_law(feature);
    case Feature::kTension:
      return {Eigen::Matrix3d::Identity() + feature.value[0] * tension_, {tension_}};
    case Feature::kGrowth:
      return {Eigen::Matrix3d::Identity(), {Eigen::Matrix3d::Zero(), Eigen::Matrix3d::Zero()}};
    default:
      return of_support(feature);
  }
}

std::vector<double> FeatureEstimate::shares(const BodyRegions& labels, std::size_t count) const {
  std::vector<double> share(count, 0);
  for (const int region : labels.numbers())
    share[static_cast<std::size_t>(region)] =
        tree_.inside(labels.level(region), 0).share.trace() / 3;
  double sum = 0;  // what elements at a boundary have of several need not be 1
  for (const double s : share) sum += s;
  for (double& s : share) s /= sum;
  return share;
}

FeatureEstimate::Change FeatureEstimate::of_zone(const Eigen::Matrix3d& share,
                                                 const std::vector<Eigen::Matrix3d>& share_by,
                                                 double ratio) const {
  const double exponent = std::log(ratio);
  const SymmetricExponential exponential(exponent * share);
  Change change{exponential.value(), {}};
  for (const Eigen::Matrix3d& by : share_by)
    change.by_value.push_back(exponential.along(exponent * by));
  change.by_value.push_back(exponential.along(share / ratio));
  return change;
}

FeatureEstimate::Change FeatureEstimate::of_layer(const BodyFeature& layer) const {
  const double place = kDepths * std::sqrt(std::clamp(layer.value[0] / deepest_, 0.0, 1.0));
  const int k = std::min(static_cast<int>(place), kDepths - 1);
  const auto thickness = [&](int i) { return deepest_ * i * i / (kDepths * kDepths); };
  const double step = thickness(k + 1) - thickness(k);
  const Eigen::Matrix3d& below = shallow_[static_cast<std::size_t>(k)];
  const Eigen::Matrix3d by = (shallow_[static_cast<std::size_t>(k) + 1] - below) / step;
  const double beyond = std::min(layer.value[0], deepest_) - thickness(k);
  return of_zone(below + beyond * by, {by}, layer.value[1]);
}

FeatureEstimate::Change FeatureEstimate::of_ball(const BodyFeature& ball) const {
  const ShareTree::Inside inside = tree_.inside(zone_level(ball, nullptr), 4);
  return of_zone(inside.share, inside.by_parameters, ball.value[4]);
}

FeatureEstimate::Change FeatureEstimate::of_law(const BodyFeature& transverse) const {
  const UnitLaw law = unit_law(nu_, transverse.value);
  const auto reduced = [&](const Eigen::Matrix3d& k) {
    return Eigen::Matrix3d(inverse_ * k * inverse_.transpose());
  };
  Change change{reduced(moments_.energy(law.D, law.kappa)), {}};
  for (std::size_t v = 1; v < law.D_by.size(); ++v)
    change.by_value.push_back(reduced(moments_.energy(law.D_by[v], law.kappa_by[v])));
  return change;
}

FeatureEstimate::Change FeatureEstimate::of_support(const BodyFeature& support) const {
  const double give = support.value[0], azimuth = support.value[1], edge = support.value[2];
  const Vec3 along(std::cos(azimuth), std::sin(azimuth), 0), across(-along.y(), along.x(), 0);
  Eigen::Matrix3d W = Eigen::Matrix3d::Zero();
  std::vector<Eigen::Matrix3d> by(3, Eigen::Matrix3d::Zero());
  for (const BaseFace& face : base_) {
    // Beyond the edge, by a smooth step over the face.
    const double level = (along.dot(face.centre) - edge) / face.size;
    const double share = 0.5 * (1 + std::tanh(2 * level));
    const double slope = 4 * share * (1 - share) / face.size;
    const double bed = give * share, series = 1 / (height_ + bed);
    const double by_bed = height_ * series * height_ * series;
    W += height_ * bed * series * face.compliance;
    by[0] += by_bed * share * face.compliance;
    by[1] += by_bed * give * slope * across.dot(face.centre) * face.compliance;
    by[2] -= by_bed * give * slope * face.compliance;
  }
  const Eigen::Matrix3d G = (Eigen::Matrix3d::Identity() + W).inverse();
  Change change{G, {}};
  for (const Eigen::Matrix3d& dW : by) change.by_value.push_back(-G * dW * G);
  return change;
}

}  // namespace hapsim
