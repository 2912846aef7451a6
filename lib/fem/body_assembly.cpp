#include "fem/body_assembly.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cassert>
#include <cmath>

#include "base/error.h"
#include "fem/elasticity.h"

namespace hapsim {

using Eigen::Index;
using Eigen::Matrix3d;

struct BodyAssembly::Point {
  double weight;
  Matrix3d F, C;      // small strain: C = 1 + 2 eps, F = 1
  double theta;       // J or 1 + tr eps
  Matrix3d cofactor;  // dtheta/dF; small strain: 1
  bool small;
};

BodyAssembly::BodyAssembly(const BodyModel& model)
    : mesh_(model.mesh),
      laws_(model.laws),
      law_(model.law_of_tet.empty() ? model.mesh->region : model.law_of_tet),
      dilatation_(model.dilatation),
      faces_(foundation_faces(*model.mesh, model.foundation)),
      springs_(model.springs),
      k_normal_(model.foundation.normal),
      k_tangential_(model.foundation.tangential),
      nodes_(model.mesh->order == 1 ? 4 : 10) {
  const std::size_t tets = mesh_->tets.size();
  assert(law_.size() == tets);
  for (std::size_t t = 0; t < tets; ++t)
    if (law_[t] < 0 || law_[t] >= static_cast<int>(laws_.size()) || !laws_[law_[t]])
      fail_input("",
                 "tetrahedron " + std::to_string(t) + " is of region " + std::to_string(law_[t]) +
                     ", which has no material",
                 "give one material a region, from 0 on");
  for (std::size_t t = 0; t < tets; ++t) {
    const ElementGradients e = element_gradients(*mesh_, t);
    for (int q = 0; q < e.points; ++q) {
      weight_.push_back(e.weight[q]);
      gradient_.insert(gradient_.end(), e.gradient[q].data(), e.gradient[q].data() + 3 * nodes_);
    }
    first_point_.push_back(static_cast<int>(weight_.size()));
  }
  build_groups();
  set_scale(model.scale);
}

void BodyAssembly::build_groups() {
  const std::size_t tets = mesh_->tets.size();
  std::size_t count = tets;
  if (dilatation_ == Dilatation::kPointwise) count = weight_.size();
  if (dilatation_ == Dilatation::kPatch) {
    patch_ = dilatation_patches(*mesh_, law_);
    count = 1 + static_cast<std::size_t>(*std::max_element(patch_.begin(), patch_.end()));
    std::vector<std::vector<int>> nodes(count);
    for (std::size_t t = 0; t < tets; ++t)
      nodes[patch_[t]].insert(nodes[patch_[t]].end(), mesh_->tets[t].begin(),
                              mesh_->tets[t].begin() + nodes_);
    for (auto& n : nodes) {
      std::sort(n.begin(), n.end());
      n.erase(std::unique(n.begin(), n.end()), n.end());
      patch_nodes_.add(n);
    }
    for (std::size_t t = 0; t < tets; ++t) {
      const auto& n = nodes[patch_[t]];
      local_.emplace_back();
      for (int a = 0; a < nodes_; ++a)
        local_.back().push_back(
            static_cast<int>(std::lower_bound(n.begin(), n.end(), mesh_->tets[t][a]) - n.begin()));
    }
  }
  groups_.resize(count);
  for (std::size_t t = 0; t < tets; ++t)
    for (int q = 0; q < points(t); ++q) {
      groups_[group(t, q)].volume += weight_[first_point_[t] + q];
      groups_[group(t, q)].law = law_[t];
    }
}

int BodyAssembly::group(std::size_t tet, int q) const {
  if (dilatation_ == Dilatation::kPointwise) return first_point_[tet] + q;
  return dilatation_ == Dilatation::kPatch ? patch_[tet] : static_cast<int>(tet);
}

void BodyAssembly::set_laws(const std::vector<LawPointer>& laws) {
  assert(laws.size() == laws_.size());
  laws_ = laws;
  set_scale(std::vector<double>(scale_));
}

void BodyAssembly::set_scale(const std::vector<double>& scale) {
  scale_ = scale.empty() ? std::vector<double>(mesh_->tets.size(), 1.0) : scale;
  assert(scale_.size() == mesh_->tets.size());
  for (Group& g : groups_) g.weight = 0;
  double volume = 0, stiffest = 0;
  for (std::size_t t = 0; t < scale_.size(); ++t) {
    if (!(scale_[t] > 0))
      fail_input("",
                 "the stiffness factor of tetrahedron " + std::to_string(t) + " is not positive",
                 "give factors above 0");
    for (int q = 0; q < points(t); ++q) {
      groups_[group(t, q)].weight += scale_[t] * weight_[first_point_[t] + q];
      volume += weight_[first_point_[t] + q];
    }
    stiffest = std::max(stiffest, scale_[t]);
  }
  double modulus = 0;
  for (const LawPointer& law : laws_) {
    if (!law) continue;
    const PointResponse r = law->respond(Matrix3d::Identity(), true);
    modulus = std::max(modulus, r.D.diagonal().maxCoeff() + law->volume(1).second);
  }
  force_unit_ = stiffest * modulus * std::pow(volume, 2.0 / 3);
}

Cliques BodyAssembly::cliques() const {
  Cliques cliques;
  for (const auto& tet : mesh_->tets)
    cliques.add(std::vector<int>(tet.begin(), tet.begin() + nodes_));
  for (std::size_t p = 0; p < patch_nodes_.size(); ++p)
    cliques.add({patch_nodes_.nodes(p), patch_nodes_.nodes(p) + patch_nodes_.count(p)});
  for (const FoundationFace& f : faces_) cliques.add(f.nodes);
  for (const NodeSpring& s : springs_) cliques.add({s.node});
  return cliques;
}

template <int N>
Eigen::Matrix<double, 3, N> BodyAssembly::gather(const Eigen::VectorXd& field,
                                                 std::size_t tet) const {
  Eigen::Matrix<double, 3, N> u;
  for (int a = 0; a < N; ++a) u.col(a) = field.segment<3>(3 * mesh_->tets[tet][a]);
  return u;
}

template <int N>
using Gradients = Eigen::Map<const Eigen::Matrix<double, 3, N>>;

template <int N>
BodyAssembly::Point BodyAssembly::point(std::size_t tet, int q,
                                        const Eigen::Matrix<double, 3, N>& u) const {
  const std::size_t at = static_cast<std::size_t>(first_point_[tet] + q);
  const Gradients<N> G(gradient_.data() + at * 3 * N);
  Point p;
  p.weight = weight_[at];
  p.small = laws_[law_[tet]]->small_strain();
  const Matrix3d H = u * G.transpose();
  if (p.small) {
    p.F.setIdentity();
    p.C = Matrix3d::Identity() + H + H.transpose();
    p.theta = 1 + H.trace();
    p.cofactor.setIdentity();
    return p;
  }
  p.F = Matrix3d::Identity() + H;
  p.C.noalias() = p.F.transpose() * p.F;
  p.cofactor.col(0) = p.F.col(1).cross(p.F.col(2));
  p.cofactor.col(1) = p.F.col(2).cross(p.F.col(0));
  p.cofactor.col(2) = p.F.col(0).cross(p.F.col(1));
  p.theta = p.F.col(0).dot(p.cofactor.col(0));
  return p;
}

namespace {

Matrix3d to_matrix(const Voigt& v) {
  Matrix3d m;
  m << v[0], v[3], v[5], v[3], v[1], v[4], v[5], v[4], v[2];
  return m;
}

}  // namespace

template <int N>
bool BodyAssembly::state_pass() {
  for (Group& g : groups_) g.theta = 0;
  for (std::size_t t = 0; t < mesh_->tets.size(); ++t) {
    const auto u = gather<N>(u_, t);
    for (int q = 0; q < points(t); ++q) {
      const Point p = point<N>(t, q, u);
      if (!p.small && !(p.theta > 0)) return false;
      groups_[group(t, q)].theta += p.weight * p.theta;
    }
  }
  energy_ = 0;
  for (Group& g : groups_) {
    g.theta /= g.volume;
    const VolumeResponse v = laws_[g.law]->volume(g.theta);
    energy_ += g.weight * v.energy;
    g.pressure = g.weight / g.volume * v.first;
    g.stiffness = g.weight / (g.volume * g.volume) * v.second;
  }
  force_.setZero(u_.size());
  for (std::size_t t = 0; t < mesh_->tets.size(); ++t) {
    const auto u = gather<N>(u_, t);
    Eigen::Matrix<double, 3, N> r = Eigen::Matrix<double, 3, N>::Zero();
    for (int q = 0; q < points(t); ++q) {
      const Point p = point<N>(t, q, u);
      const PointResponse m = laws_[law_[t]]->respond(p.C, false);
      energy_ += p.weight * scale_[t] * m.energy;
      const Matrix3d P =
          p.F * (scale_[t] * to_matrix(m.S)) + groups_[group(t, q)].pressure * p.cofactor;
      r.noalias() += p.weight * P * Gradients<N>(gradient_.data() + (first_point_[t] + q) * 3 * N);
    }
    for (int a = 0; a < N; ++a) force_.segment<3>(3 * mesh_->tets[t][a]) += r.col(a);
  }
  for (const FoundationFace& f : faces_) {
    Eigen::VectorXd u(3 * f.nodes.size());
    for (std::size_t a = 0; a < f.nodes.size(); ++a)
      u.segment<3>(3 * a) = u_.segment<3>(3 * f.nodes[a]);
    const Eigen::VectorXd r = k_normal_ * (f.by_normal * u) + k_tangential_ * (f.by_tangential * u);
    energy_ += 0.5 * u.dot(r);
    for (std::size_t a = 0; a < f.nodes.size(); ++a)
      force_.segment<3>(3 * f.nodes[a]) += r.segment<3>(3 * a);
  }
  for (const NodeSpring& s : springs_) {
    const Vec3 u = u_.segment<3>(3 * s.node), r = s.stiffness * u;
    energy_ += 0.5 * u.dot(r);
    force_.segment<3>(3 * s.node) += r;
  }
  return std::isfinite(energy_) && force_.allFinite();
}

template <int N>
void BodyAssembly::tangent_pass(NodeSystem& system, const std::vector<char>& kept,
                                std::vector<CliqueMatrix>& kept_matrices) const {
  const std::size_t tets = mesh_->tets.size();
  const auto is_kept = [&](const int* nodes, int count) {
    return std::any_of(nodes, nodes + count, [&](int n) { return kept[n] != 0; });
  };
  const bool patches = dilatation_ == Dilatation::kPatch;
  std::vector<Eigen::VectorXd> patch_slope;  // b of each patch
  for (std::size_t p = 0; p < patch_nodes_.size(); ++p)
    patch_slope.push_back(Eigen::VectorXd::Zero(3 * patch_nodes_.count(p)));

  Eigen::Matrix<double, 3 * N, 3 * N> K;
  Eigen::Matrix<double, 6, 3 * N> B, DB;
  for (std::size_t t = 0; t < tets; ++t) {
    const auto u = gather<N>(u_, t);
    K.setZero();
    Eigen::Matrix<double, 3, N> slope = Eigen::Matrix<double, 3, N>::Zero();  // b, element's share
    for (int q = 0; q < points(t); ++q) {
      const Point p = point<N>(t, q, u);
      const Gradients<N> G(gradient_.data() + (first_point_[t] + q) * 3 * N);
      PointResponse m = laws_[law_[t]]->respond(p.C, true);
      const Group& g = groups_[group(t, q)];
      m.S *= scale_[t];
      m.D *= scale_[t];
      if (!p.small) {
        // The pressure's part: S = p J C^-1 and its derivative by E.
        const Matrix3d inverse = p.C.inverse();
        const Voigt c = to_voigt(inverse);
        const double pj = g.pressure * p.theta;
        m.S += pj * c;
        m.D += pj * (c * c.transpose() - 2 * symmetric_product(inverse));
      }
      for (int a = 0; a < N; ++a) {
        const Eigen::Vector3d w = G.col(a);
        const Matrix3d& F = p.F;
        B.template block<1, 3>(0, 3 * a) = w[0] * F.col(0).transpose();
        B.template block<1, 3>(1, 3 * a) = w[1] * F.col(1).transpose();
        B.template block<1, 3>(2, 3 * a) = w[2] * F.col(2).transpose();
        B.template block<1, 3>(3, 3 * a) = (w[1] * F.col(0) + w[0] * F.col(1)).transpose();
        B.template block<1, 3>(4, 3 * a) = (w[2] * F.col(1) + w[1] * F.col(2)).transpose();
        B.template block<1, 3>(5, 3 * a) = (w[2] * F.col(0) + w[0] * F.col(2)).transpose();
      }
      DB.noalias() = p.weight * m.D * B;
      K.noalias() += B.transpose() * DB;
      if (!p.small) {
        const Eigen::Matrix<double, N, N> geometric = p.weight * G.transpose() * to_matrix(m.S) * G;
        for (int a = 0; a < N; ++a)
          for (int b = 0; b < N; ++b)
            K.template block<3, 3>(3 * a, 3 * b).diagonal().array() += geometric(a, b);
      }
      if (dilatation_ == Dilatation::kPointwise) slope.setZero();
      slope.noalias() += p.weight * p.cofactor * G;
      const bool complete =
          dilatation_ == Dilatation::kPointwise || (!patches && q + 1 == points(t));
      if (complete) {
        const Eigen::Map<const Eigen::Matrix<double, 3 * N, 1>> b(slope.data());
        K.noalias() += g.stiffness * b * b.transpose();
      }
    }
    if (patches)
      for (int a = 0; a < N; ++a)
        patch_slope[patch_[t]].template segment<3>(3 * local_[t][a]) += slope.col(a);
    system.add(t, K);
    if (is_kept(mesh_->tets[t].data(), N)) kept_matrices.emplace_back(t, K);
  }
  for (std::size_t p = 0; p < patch_slope.size(); ++p) {
    const Eigen::MatrixXd k = groups_[p].stiffness * patch_slope[p] * patch_slope[p].transpose();
    system.add(tets + p, k);
    if (is_kept(patch_nodes_.nodes(p), patch_nodes_.count(p)))
      kept_matrices.emplace_back(tets + p, k);
  }
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    const Eigen::MatrixXd k =
        k_normal_ * faces_[f].by_normal + k_tangential_ * faces_[f].by_tangential;
    const std::size_t clique = tets + patch_slope.size() + f;
    system.add(clique, k);
    if (is_kept(faces_[f].nodes.data(), static_cast<int>(faces_[f].nodes.size())))
      kept_matrices.emplace_back(clique, k);
  }
  for (std::size_t s = 0; s < springs_.size(); ++s) {
    const std::size_t clique = tets + patch_slope.size() + faces_.size() + s;
    system.add(clique, springs_[s].stiffness);
    if (kept[springs_[s].node]) kept_matrices.emplace_back(clique, springs_[s].stiffness);
  }
}

template <int N>
BodyAssembly::Derivatives BodyAssembly::derivative_pass(const Eigen::MatrixXd& fields,
                                                        bool by_scale) const {
  const Index m = fields.cols();
  Derivatives d;
  for (const LawPointer& law : laws_)
    d.constants.push_back(
        Eigen::MatrixXd::Zero(m, law ? static_cast<Index>(law->constants().size()) : 0));
  if (by_scale) d.scale = Eigen::MatrixXd::Zero(m, static_cast<Index>(mesh_->tets.size()));
  Eigen::MatrixXd change =
      Eigen::MatrixXd::Zero(m, static_cast<Index>(groups_.size()));  // b.phi of each group
  for (std::size_t t = 0; t < mesh_->tets.size(); ++t) {
    const auto u = gather<N>(u_, t);
    Eigen::MatrixXd phi(3 * N, m);
    for (int a = 0; a < N; ++a)
      phi.middleRows(3 * a, 3) = fields.middleRows(3 * mesh_->tets[t][a], 3);
    for (int q = 0; q < points(t); ++q) {
      const Point p = point<N>(t, q, u);
      const Gradients<N> G(gradient_.data() + (first_point_[t] + q) * 3 * N);
      const std::vector<Voigt> S_by = laws_[law_[t]]->stress_by_constants(p.C);
      const Voigt S = by_scale ? laws_[law_[t]]->respond(p.C, false).S : Voigt::Zero();
      for (Index j = 0; j < m; ++j) {
        const Eigen::Map<const Eigen::Matrix<double, 3, N>> field(phi.data() + 3 * N * j);
        const Matrix3d H = field * G.transpose();
        const Matrix3d FH = p.F.transpose() * H;
        Voigt e = to_voigt(0.5 * (FH + FH.transpose()));
        e.tail<3>() *= 2;
        for (std::size_t k = 0; k < S_by.size(); ++k)
          d.constants[law_[t]](j, static_cast<Index>(k)) += p.weight * scale_[t] * S_by[k].dot(e);
        if (by_scale) d.scale(j, static_cast<Index>(t)) += p.weight * S.dot(e);
        change(j, group(t, q)) += p.weight * p.cofactor.cwiseProduct(H).sum();
      }
    }
  }
  for (std::size_t i = 0; i < groups_.size(); ++i) {
    const Group& g = groups_[i];
    const std::vector<double> p_by = laws_[g.law]->pressure_by_constants(g.theta);
    for (std::size_t k = 0; k < p_by.size(); ++k)
      d.constants[g.law].col(static_cast<Index>(k)) +=
          g.weight / g.volume * p_by[k] * change.col(static_cast<Index>(i));
  }
  for (std::size_t t = 0; by_scale && t < mesh_->tets.size(); ++t)
    for (int q = 0; q < points(t); ++q) {
      const Group& g = groups_[group(t, q)];
      d.scale.col(static_cast<Index>(t)) += weight_[first_point_[t] + q] / g.volume *
                                            laws_[g.law]->volume(g.theta).first *
                                            change.col(group(t, q));
    }
  d.foundation = Eigen::MatrixXd::Zero(m, 2);
  for (const FoundationFace& f : faces_) {
    const Index n = static_cast<Index>(f.nodes.size());
    Eigen::VectorXd u(3 * n);
    Eigen::MatrixXd phi(3 * n, m);
    for (Index a = 0; a < n; ++a) {
      u.segment<3>(3 * a) = u_.segment<3>(3 * f.nodes[a]);
      phi.middleRows(3 * a, 3) = fields.middleRows(3 * f.nodes[a], 3);
    }
    d.foundation.col(0) += phi.transpose() * (f.by_normal * u);
    d.foundation.col(1) += phi.transpose() * (f.by_tangential * u);
  }
  return d;
}

bool BodyAssembly::set_state(const Eigen::VectorXd& u) {
  assert(u.size() == 3 * static_cast<Index>(mesh_->nodes.size()));
  u_ = u;
  return nodes_ == 4 ? state_pass<4>() : state_pass<10>();
}

void BodyAssembly::tangent(NodeSystem& system, const std::vector<char>& kept,
                           std::vector<CliqueMatrix>& kept_matrices) const {
  if (nodes_ == 4)
    tangent_pass<4>(system, kept, kept_matrices);
  else
    tangent_pass<10>(system, kept, kept_matrices);
}

BodyAssembly::Derivatives BodyAssembly::derivatives(const Eigen::MatrixXd& fields,
                                                    bool by_scale) const {
  return nodes_ == 4 ? derivative_pass<4>(fields, by_scale) : derivative_pass<10>(fields, by_scale);
}

}  // namespace hapsim
