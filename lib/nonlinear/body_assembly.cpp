#include "nonlinear/body_assembly.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cassert>
#include <cmath>

#include "base/error.h"
#include "solid/elasticity.h"

namespace hapsim {

using Eigen::Matrix3d;

BodyAssembly::BodyAssembly(const BodyModel& model)
    : mesh_(model.mesh),
      laws_(model.laws),
      law_(model.law_of_tet.empty() ? model.mesh->region : model.law_of_tet),
      dilatation_(model.dilatation),
      faces_(foundation_faces(*model.mesh, model.foundation)),
      springs_(model.springs),
      k_normal_(model.foundation.normal),
      k_tangential_(model.foundation.tangential),
      face_springs_(model.face_springs),
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
  modulus_ = modulus;
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
  for (const FaceSpring& s : face_springs_) cliques.add(s.nodes);
  return cliques;
}

void BodyAssembly::stiffen(NodeSystem& system, double share) const {
  for (std::size_t t = 0; t < mesh_->tets.size(); ++t) {
    double volume = 0;
    for (int q = 0; q < points(t); ++q) volume += weight_[first_point_[t] + q];
    system.add(t, share * scale_[t] * modulus_ * std::cbrt(volume) *
                      Eigen::MatrixXd::Identity(3 * nodes_, 3 * nodes_));
  }
}

}  // namespace hapsim
