// The state and its tangent.
#include <cassert>
#include <cmath>

#include "nonlinear/body_point.h"

namespace hapsim {

using Eigen::Index;
using Eigen::Matrix3d;

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
    if (!added_.pressure.empty()) {
      const double p = added_.pressure[static_cast<std::size_t>(&g - groups_.data())];
      g.pressure += p;
      energy_ += g.volume * p * (g.theta - 1);
    }
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
      Voigt S = scale_[t] * m.S;
      if (!added_.S.empty()) {
        const Voigt& S0 = added_.S[first_point_[t] + q];
        Voigt strain = to_voigt(0.5 * (p.C - Matrix3d::Identity()));
        strain.tail<3>() *= 2;
        energy_ += p.weight * S0.dot(strain);
        S += S0;
      }
      const Matrix3d P = p.F * to_matrix(S) + groups_[group(t, q)].pressure * p.cofactor;
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
  for (const FaceSpring& s : face_springs_) {
    Eigen::VectorXd u(3 * static_cast<Index>(s.nodes.size()));
    for (std::size_t a = 0; a < s.nodes.size(); ++a)
      u.segment<3>(3 * static_cast<Index>(a)) = u_.segment<3>(3 * s.nodes[a]);
    const Eigen::VectorXd r = s.stiffness * u;
    energy_ += 0.5 * u.dot(r);
    for (std::size_t a = 0; a < s.nodes.size(); ++a)
      force_.segment<3>(3 * s.nodes[a]) += r.segment<3>(3 * static_cast<Index>(a));
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
      if (!added_.S.empty()) m.S += added_.S[first_point_[t] + q];
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
  for (std::size_t s = 0; s < face_springs_.size(); ++s) {
    const std::size_t clique = tets + patch_slope.size() + faces_.size() + springs_.size() + s;
    system.add(clique, face_springs_[s].stiffness);
    if (is_kept(face_springs_[s].nodes.data(), static_cast<int>(face_springs_[s].nodes.size())))
      kept_matrices.emplace_back(clique, face_springs_[s].stiffness);
  }
}

template <int N>
void BodyAssembly::stress_pass(PointStresses& stresses) const {
  for (std::size_t t = 0; t < mesh_->tets.size(); ++t) {
    const auto u = gather<N>(u_, t);
    for (int q = 0; q < points(t); ++q)
      stresses.S.push_back(scale_[t] * laws_[law_[t]]->respond(point<N>(t, q, u).C, false).S);
  }
}

PointStresses BodyAssembly::elastic_stresses() const {
  PointStresses stresses;
  stresses.S.reserve(weight_.size());
  if (nodes_ == 4)
    stress_pass<4>(stresses);
  else
    stress_pass<10>(stresses);
  for (const Group& g : groups_)
    stresses.pressure.push_back(g.weight / g.volume * laws_[g.law]->volume(g.theta).first);
  return stresses;
}

void BodyAssembly::laws_of_stresses(std::vector<int>& of_point, std::vector<int>& of_group) const {
  of_point.clear();
  of_group.clear();
  for (std::size_t t = 0; t < mesh_->tets.size(); ++t)
    of_point.insert(of_point.end(), static_cast<std::size_t>(points(t)), law_[t]);
  for (const Group& g : groups_) of_group.push_back(g.law);
}

template <int N>
void BodyAssembly::field_pass(ElementFields& fields) const {
  for (std::size_t t = 0; t < mesh_->tets.size(); ++t) {
    const auto u = gather<N>(u_, t);
    Voigt stress = Voigt::Zero();
    double energy = 0, size = 0;
    for (int q = 0; q < points(t); ++q) {
      const Point p = point<N>(t, q, u);
      const PointResponse m = laws_[law_[t]]->respond(p.C, false);
      const Group& g = groups_[group(t, q)];
      Voigt S = scale_[t] * m.S;
      if (!added_.S.empty()) S += added_.S[first_point_[t] + q];
      const double J = p.small ? 1 : p.theta;
      const Matrix3d cauchy =
          (p.F * to_matrix(S) * p.F.transpose() + g.pressure * p.cofactor * p.F.transpose()) / J;
      stress += p.weight * to_voigt(cauchy);
      energy += p.weight * scale_[t] * (m.energy + laws_[law_[t]]->volume(g.theta).energy);
      size += p.weight;
    }
    fields.stress.push_back(stress / size);
    fields.energy.push_back(energy / size);
  }
}

ElementFields BodyAssembly::element_fields() const {
  ElementFields fields;
  if (nodes_ == 4)
    field_pass<4>(fields);
  else
    field_pass<10>(fields);
  return fields;
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

}  // namespace hapsim
