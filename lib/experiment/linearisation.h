// Contact stiffness at every place of an experiment, for materials near one that was solved.
#pragma once

#include <memory>
#include <vector>

#include "experiment/extrapolate.h"
#include "experiment/setup_places.h"

namespace hapsim {

// Of one body and one tool. A value: two of the same places about the same material give the same
// stiffnesses, whatever else was computed before or is computed beside them.
class SetupLinearisation {
 public:
  // About the material as finite elements have it. Costs their solution, unless it is homogeneous.
  static SetupLinearisation solve(std::shared_ptr<const SetupPlaces> places,
                                  const MaterialSpec& material);
  // Ready for a material of other regions or features than `known` was solved for: what `known`
  // lacks is estimated. Costs no solution for the material, but prepares its move where that is
  // another than known's. `known` may be null.
  static SetupLinearisation estimate(std::shared_ptr<const SetupPlaces> places,
                                     const MaterialSpec& material, const SetupLinearisation* known);

  // A homogeneous material is exact. Any other is linear about the solved one of the same regions
  // and kinds of features, exact at it. Beyond these it is estimated: features as FeatureEstimate
  // says, on top of those that were solved; regions by the geometric mean of the moduli weighted by
  // each region's share of the strain energy (first order in the contrast). The material has moved
  // as the one that this was made for, and what it lacks was asked of estimate(); std::logic_error
  // otherwise.
  PositionStiffness at(std::size_t position, const MaterialSpec& material) const;
  // Whether a material of these regions and kinds of features was solved, so that at() does not
  // estimate.
  bool is_solved_for(const MaterialSpec& material) const;
  // mixture_uncertainty() of every place of what was solved; empty of a homogeneous body.
  std::vector<double> mixture_uncertainties() const;

 private:
  PositionStiffness unmoved(std::size_t position, const MaterialSpec& material) const;
  PositionStiffness local(std::size_t position, const MaterialSpec& material) const;
  PositionStiffness by_shares(std::size_t position, const MaterialSpec& material) const;
  PositionStiffness with_estimates(std::size_t position, const MaterialSpec& material) const;
  // The material with those of its features that are solved.
  MaterialSpec known_part(const MaterialSpec& material) const;

  std::shared_ptr<const SetupPlaces> pressed_;  // as they were pressed
  std::shared_ptr<const SetupPlaces> places_;   // before the body had moved
  Vec3 shift_ = Vec3::Zero(), rotation_ = Vec3::Zero();
  std::shared_ptr<const SolvedPlaces> solved_;  // null: nothing but the homogeneous body is known
  MaterialSpec regions_;                        // whose shares these are
  std::shared_ptr<const RegionShares> shares_;
  std::shared_ptr<const FeatureEstimates> estimates_;
};

// Of all bodies and tools of an experiment; positions are numbered as in its data. Empty until an
// experiment makes it.
class Linearisation {
 public:
  struct Place {
    std::size_t setup = 0, position = 0;  // within the setup
  };
  Linearisation() = default;
  Linearisation(std::shared_ptr<const std::vector<Place>> place,
                std::vector<SetupLinearisation> setups)
      : place_(std::move(place)), setups_(std::move(setups)) {}

  // As SetupLinearisation says.
  PositionStiffness at(std::size_t position, const MaterialSpec& material) const {
    const Place& place = (*place_)[position];
    return setups_[place.setup].at(place.position, material);
  }
  bool is_solved_for(const MaterialSpec& material) const;
  std::vector<double> mixture_uncertainties() const;  // of all bodies and tools
  bool empty() const { return setups_.empty(); }
  const SetupLinearisation& setup(std::size_t s) const { return setups_[s]; }

 private:
  std::shared_ptr<const std::vector<Place>> place_;  // by position
  std::vector<SetupLinearisation> setups_;
};

}  // namespace hapsim
