#include "contact/element_mixture.h"

#include <Eigen/Dense>
#include <cmath>
#include <limits>

#include "contact/feature_zone.h"
#include "solid/inhomogeneity.h"

namespace hapsim {
namespace {

constexpr std::size_t kGroups = std::numeric_limits<std::size_t>::max();

}  // namespace

ElementMixture::ElementMixture(const TetMesh& mesh, const Material& material,
                               const ElementGroups& groups,
                               const std::shared_ptr<const SurfaceTree>& free_surface,
                               const UnitLaw& law)
    : mesh_(mesh),
      material_(material),
      groups_(groups),
      law_(law),
      plane_(law.D, law.kappa),
      elements_(mesh.tets.size()) {
  for (std::size_t t = 0; t < elements_.size(); ++t) add_groups(t, elements_[t]);
  for (std::size_t f = 0; f < material.features.size(); ++f) {
    const BodyFeature& feature = material.features[f];
    if (!is_zone(feature.kind)) continue;
    const LevelSet level = zone_level(feature, free_surface);
    const InsideShares inside = inside_shares(mesh, level);
    for (std::size_t t = 0; t < elements_.size(); ++t)
      add_zone(t, f, level, inside.share[t], inside.by_parameters.row(static_cast<Eigen::Index>(t)),
               elements_[t]);
  }
  for (Element& e : elements_) {
    for (const Cut& c : e.cuts) e.contrast += c.contrast;
    for (const Cut& c : e.cuts) e.beyond += weight(e, c) * c.plane;
  }
}

double ElementMixture::weight(const Element& e, const Cut& c) {
  return e.scale * expm1_over(e.contrast) * c.contrast;
}

void ElementMixture::add_groups(std::size_t t, Element& e) const {
  double A = 0, inverse_H = 0;
  std::size_t parts = 0, only = 0;
  groups_.for_each(t, [&](std::size_t g, double share) {
    A += share * material_.modulus[g];
    inverse_H += share / material_.modulus[g];
    only = g;
    ++parts;
  });
  if (parts == 1) {
    e.scale = material_.modulus[only];
    e.slopes.push_back({kGroups, only, 1 / material_.modulus[only]});
    return;
  }
  const double H = 1 / inverse_H;
  e.scale = H;
  Cut cut;
  cut.feature = kGroups;
  cut.contrast = std::log(A / H);
  cut.contrast_by = Eigen::RowVectorXd::Zero(static_cast<Eigen::Index>(material_.modulus.size()));
  groups_.for_each(t, [&](std::size_t g, double share) {
    const double E = material_.modulus[g], by_H = H * share / (E * E);
    e.slopes.push_back({kGroups, g, by_H});
    cut.contrast_by[static_cast<Eigen::Index>(g)] += share / A - by_H;
  });
  cut.across = groups_.across(t);
  for (const auto& [normal, weight] : cut.across) cut.plane += weight * plane_.at(normal);
  std::size_t growth = 0;
  for (std::size_t f = 0; f < material_.features.size(); ++f) {
    if (material_.features[f].kind != Feature::kGrowth) continue;
    double by_A = 0, by_inverse = 0;
    groups_.for_each_growth(t, growth++, [&](std::size_t g, double by) {
      by_A += by * material_.modulus[g];
      by_inverse += by / material_.modulus[g];
    });
    if (by_A == 0 && by_inverse == 0) continue;
    e.slopes.push_back({f, 1, -H * by_inverse});
    cut.growths.push_back({f, by_A / A + H * by_inverse});
  }
  e.cuts.push_back(std::move(cut));
}

void ElementMixture::add_zone(std::size_t t, std::size_t feature, const LevelSet& level,
                              double share, const Eigen::RowVectorXd& share_by, Element& e) const {
  if (share <= 0) return;
  const double ratio = material_.features[feature].value.back();
  const double A = 1 + (ratio - 1) * share, inverse_H = 1 + (1 / ratio - 1) * share;
  const double H = 1 / inverse_H;
  const auto last = static_cast<std::size_t>(share_by.size());
  e.scale *= H;
  const double log_H_by_share = -H * (1 / ratio - 1), log_H_by_ratio = H * share / (ratio * ratio);
  for (std::size_t v = 0; v < last; ++v)
    if (share_by[static_cast<Eigen::Index>(v)] != 0)
      e.slopes.push_back({feature, v, log_H_by_share * share_by[static_cast<Eigen::Index>(v)]});
  e.slopes.push_back({feature, last, log_H_by_ratio});
  if (share >= 1) return;
  Cut cut;
  cut.feature = feature;
  cut.contrast = std::log(A * inverse_H);
  cut.contrast_by.resize(share_by.size() + 1);
  cut.contrast_by.head(share_by.size()) = ((ratio - 1) / A - log_H_by_share) * share_by;
  cut.contrast_by[share_by.size()] = share / A - log_H_by_ratio;
  const BoundaryNormal boundary = boundary_normal(mesh_, t, level);
  cut.across = {{boundary.normal, 1.0}};
  cut.plane = plane_.at(boundary.normal);
  for (Eigen::Index v = 0; v < boundary.by_parameters.cols(); ++v)
    cut.plane_by.push_back(plane_.by_normal(boundary.normal, boundary.by_parameters.col(v)));
  e.cuts.push_back(std::move(cut));
}

void ElementMixture::add(std::size_t t, const FieldMoments& moments, FeaturedBody::Solution& s,
                         std::vector<Eigen::Matrix3d>& by_law) const {
  const Element& e = elements_[t];
  Eigen::Matrix3d energy = e.scale * moments.energy(law_.D, law_.kappa);
  for (std::size_t v = 0; v < by_law.size(); ++v)
    by_law[v] += e.scale * moments.energy(law_.D_by[v], law_.kappa_by[v]);
  const auto place = [&](std::size_t feature, std::size_t value) -> Eigen::Matrix3d& {
    return feature == kGroups ? s.by_modulus[value] : s.by_feature[feature][value];
  };
  if (!e.cuts.empty()) {
    std::vector<Eigen::Matrix3d> of_cut;
    Eigen::Matrix3d along = Eigen::Matrix3d::Zero();  // sum L_k e_k
    for (const Cut& c : e.cuts) {
      of_cut.push_back(moments.energy(c.plane, 0));
      along += c.contrast * of_cut.back();
      const double weight_of = weight(e, c);
      energy += weight_of * of_cut.back();
      for (std::size_t v = 0; v < c.plane_by.size(); ++v)
        place(c.feature, v) += weight_of * moments.energy(c.plane_by[v], 0);
      for (std::size_t v = 0; v < by_law.size(); ++v)
        for (const auto& [normal, share] : c.across)
          by_law[v] += weight_of * share *
                       moments.energy(plane_.by_law(normal, law_.D_by[v], law_.kappa_by[v]), 0);
    }
    const double g = expm1_over(e.contrast), slope = expm1_over_slope(e.contrast);
    for (std::size_t k = 0; k < e.cuts.size(); ++k) {
      const Cut& c = e.cuts[k];
      const Eigen::Matrix3d by_contrast = e.scale * (slope * along + g * of_cut[k]);
      for (Eigen::Index v = 0; v < c.contrast_by.size(); ++v)
        if (c.contrast_by[v] != 0)
          place(c.feature, static_cast<std::size_t>(v)) += c.contrast_by[v] * by_contrast;
      for (const auto& [feature, by] : c.growths) s.by_feature[feature][1] += by * by_contrast;
    }
  }
  for (const Element::Slope& slope : e.slopes)
    place(slope.feature, slope.value) += slope.by * energy;
  s.K += energy;
  s.mixed += 0.25 * (1 + e.contrast) * e.contrast * energy;
}

}  // namespace hapsim
