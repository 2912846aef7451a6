#include "experiment/linearisation.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "experiment/nearest_region.h"

namespace hapsim {
namespace {

bool same_kinds(const MaterialSpec& a, const MaterialSpec& b) {
  return std::equal(
      a.features.begin(), a.features.end(), b.features.begin(), b.features.end(),
      [](const FeatureSpec& x, const FeatureSpec& y) { return x.feature.kind == y.feature.kind; });
}

bool is_homogeneous(const SetupPlaces& places, const MaterialSpec& material) {
  return !places.has_regions(material) && material.features.empty();
}

// One modulus everywhere.
MaterialSpec without_regions(MaterialSpec material, double modulus) {
  material.local = false;
  material.key_point.clear();
  material.key_region.clear();
  material.modulus = {modulus};
  material.modulus_column = {-1};
  return material;
}

}  // namespace

SetupLinearisation SetupLinearisation::solve(std::shared_ptr<const SetupPlaces> places,
                                             const MaterialSpec& material) {
  SetupLinearisation result = estimate(places, material, nullptr);
  if (is_homogeneous(*places, material)) return result;
  result.solved_ = result.places_->solve(in_place(material));
  result.shares_ = nullptr;
  result.estimates_ = nullptr;
  return result;
}

SetupLinearisation SetupLinearisation::estimate(std::shared_ptr<const SetupPlaces> places,
                                                const MaterialSpec& material,
                                                const SetupLinearisation* known) {
  SetupLinearisation result;
  if (known != nullptr && known->shift_ == material.shift && known->rotation_ == material.rotation)
    result = *known;
  result.pressed_ = places;
  result.places_ = places->before_move(material);
  result.shift_ = material.shift;
  result.rotation_ = material.rotation;
  if (result.is_solved_for(material)) return result;
  if (places->has_regions(material) && !result.is_solved_for(result.known_part(material))) {
    result.regions_ = in_place(material);
    result.shares_ = result.places_->shares(result.regions_);
  }
  if (result.known_part(material).features.size() < material.features.size())
    result.estimates_ = result.places_->estimates();
  return result;
}

bool SetupLinearisation::is_solved_for(const MaterialSpec& material) const {
  return solved_ && places_->same_regions(solved_->material, material) &&
         same_kinds(solved_->material, material);
}

MaterialSpec SetupLinearisation::known_part(const MaterialSpec& material) const {
  MaterialSpec known = material;
  std::erase_if(known.features, [&](const FeatureSpec& f) {
    return !solved_ ||
           std::none_of(solved_->material.features.begin(), solved_->material.features.end(),
                        [&](const FeatureSpec& s) { return s.feature.kind == f.feature.kind; });
  });
  // Features that were solved with others, or in other regions, are not known by themselves.
  if (!known.features.empty() && !is_solved_for(known) &&
      !is_solved_for(without_regions(known, known.modulus[0])))
    known.features.clear();
  return known;
}

PositionStiffness SetupLinearisation::at(std::size_t position, const MaterialSpec& material) const {
  if (!places_ || material.shift != shift_ || material.rotation != rotation_)
    throw std::logic_error("a stiffness is asked of a linearisation about another move");
  if (!has_moved(material)) return unmoved(position, material);
  PositionStiffness s = unmoved(position, in_place(material));
  const Eigen::Matrix3d R = rotation_matrix(rotation_);
  s.K = (R * s.K * R.transpose()).eval();
  for (auto& [column, dK] : s.by_column) dK = (R * dK * R.transpose()).eval();
  return s;
}

PositionStiffness SetupLinearisation::unmoved(std::size_t position,
                                              const MaterialSpec& material) const {
  if (material.local) return local(position, material);
  if (is_solved_for(material))
    return extrapolated(solved_->solutions[position], places_->contacts()[position].stiffness,
                        solved_->material, material);
  if (!is_homogeneous(*places_, material)) return with_estimates(position, material);
  PositionStiffness result;
  Eigen::Matrix3d unit, by_nu;
  places_->contacts()[position].stiffness.evaluate(material.nu, unit, by_nu);
  const double modulus = material.modulus.front();
  result.K = modulus * unit;
  result.add(material.nu_column, modulus * by_nu);
  result.add(material.modulus_column.front(), unit);
  return result;
}

// As if all of the body had the contact's own modulus, to which all forces are proportional.
PositionStiffness SetupLinearisation::local(std::size_t position,
                                            const MaterialSpec& material) const {
  const LocalModulus local = local_modulus(material, places_->positions()[position]);
  PositionStiffness result = unmoved(position, without_regions(material, local.value));
  const Eigen::Matrix3d K = result.K;
  for (const auto& [region, share] : local.share) {
    const auto r = static_cast<std::size_t>(region);
    result.add(material.modulus_column[r], share / material.modulus[r] * K);
  }
  return result;
}

PositionStiffness SetupLinearisation::with_estimates(std::size_t position,
                                                     const MaterialSpec& material) const {
  const MaterialSpec known = known_part(material);
  // Regions that nothing was solved for are the last thing to add.
  if (places_->has_regions(material) && !is_solved_for(known)) return by_shares(position, material);
  if (!estimates_)
    throw std::logic_error("a stiffness is asked of a linearisation that lacks its features");
  PositionStiffness result = unmoved(position, known);
  for (const FeatureSpec& f : material.features) {
    const bool there =
        std::any_of(known.features.begin(), known.features.end(),
                    [&](const FeatureSpec& k) { return k.feature.kind == f.feature.kind; });
    if (!there) result = with_estimate(result, (*estimates_)[position]->at(f.feature), f.column);
  }
  return result;
}

PositionStiffness SetupLinearisation::by_shares(std::size_t position,
                                                const MaterialSpec& material) const {
  if (!shares_ || !places_->same_regions(regions_, material))
    throw std::logic_error("a stiffness is asked of a linearisation that lacks its regions");
  PositionStiffness result = unmoved(position, without_regions(material, 1));
  const std::vector<double>& share = (*shares_)[position];
  double log_modulus = 0;
  for (std::size_t g = 0; g < share.size(); ++g)
    log_modulus += share[g] * std::log(material.modulus[g]);
  const double modulus = std::exp(log_modulus);
  result.K *= modulus;
  for (auto& [column, dK] : result.by_column) dK *= modulus;
  for (std::size_t g = 0; g < share.size(); ++g)
    result.add(material.modulus_column[g], share[g] / material.modulus[g] * result.K);
  return result;
}

bool Linearisation::is_solved_for(const MaterialSpec& material) const {
  return !setups_.empty() && std::all_of(setups_.begin(), setups_.end(), [&](const auto& setup) {
    return setup.is_solved_for(material);
  });
}

std::vector<double> SetupLinearisation::mixture_uncertainties() const {
  std::vector<double> result;
  if (solved_)
    for (const StiffnessSolution& s : solved_->solutions) result.push_back(mixture_uncertainty(s));
  return result;
}

std::vector<double> Linearisation::mixture_uncertainties() const {
  std::vector<double> result;
  for (const SetupLinearisation& setup : setups_)
    for (const double share : setup.mixture_uncertainties()) result.push_back(share);
  return result;
}

}  // namespace hapsim
