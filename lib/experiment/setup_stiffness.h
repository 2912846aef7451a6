// Contact stiffness of one body against one tool at given positions, for whatever material the
// model asks.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "contact/contact_library.h"
#include "effects/effect.h"
#include "experiment/extrapolate.h"
#include "experiment/registration.h"

namespace hapsim {

class SetupStiffness {
 public:
  // Prepares all positions for Poisson's ratios in [nu_low, nu_high].
  SetupStiffness(const ContactLibrary& library, const std::vector<Vec3>& positions, double nu_low,
                 double nu_high);

  // A homogeneous material is exact. Any other is linear about the last solve() of a material of
  // the same layout (key points and kinds of features), exact at each material that was solved.
  // Without a solution it is estimated on top of what is known without its last features, or its
  // regions: features as FeatureEstimate says, regions by the geometric mean of the moduli weighted
  // by each region's share of the strain energy (first order in the contrast). A body that has
  // moved is prepared anew, once for each move.
  PositionStiffness at(std::size_t position, const MaterialSpec& material) const;

  // The same body pressed by the same tool at other positions.
  std::unique_ptr<SetupStiffness> with_positions(const std::vector<Vec3>& positions) const;

  // Finite-element solutions for a material that is not homogeneous; nothing to do for one that is.
  void solve(const MaterialSpec& material) const;
  // Whether a material of this layout was solved, so that at() does not estimate.
  bool is_solved(const MaterialSpec& material) const;
  void forget(const MaterialSpec& material) const;  // the solutions of its layout

  int threads() const { return library_.threads(); }
  const std::vector<PreparedContact>& contacts() const { return contacts_; }
  const std::vector<Vec3>& positions() const { return positions_; }
  const Surface& surface() const { return library_.surface(); }
  const PlanGrid& grid() const { return library_.grid(); }  // of the contacts' plan_share
  // The move that the contact points' distances from the surface show.
  RigidMove move() const { return register_points(positions_, library_.surface()); }

 private:
  using Shares = std::vector<std::vector<double>>;  // [position][region], sums to 1
  const Shares& shares(const MaterialSpec& material) const;
  PositionStiffness by_shares(std::size_t position, const MaterialSpec& material) const;
  PositionStiffness estimated(std::size_t position, const MaterialSpec& material) const;

  const ContactLibrary& library_;
  std::vector<Vec3> positions_;
  std::vector<PreparedContact> contacts_;
  // What was solved for one layout; the last one is extrapolated from.
  struct Reference {
    MaterialSpec material;
    std::vector<StiffnessSolution> solutions;  // by position
  };
  using ReferencePointer = std::shared_ptr<const Reference>;
  ReferencePointer reference_for(const MaterialSpec& material) const;
  // This body where it lay when it was scanned, and the material as it is there.
  const SetupStiffness& before_move(const MaterialSpec& material) const;

  double nu_low_, nu_high_;
  mutable std::mutex mutex_;
  mutable std::map<std::array<double, 6>, std::unique_ptr<SetupStiffness>> moved_;
  mutable std::map<std::string, std::vector<ReferencePointer>> references_;
  mutable std::map<std::string, Shares> shares_;
  mutable std::vector<std::shared_ptr<const FeatureEstimate>> estimates_;  // when first needed
};

}  // namespace hapsim
