// All places of an experiment, of whichever body and tool they are.
#pragma once

#include <memory>
#include <vector>

#include "experiment/dataset.h"
#include "experiment/linearisation.h"

namespace hapsim {

// Never changes; copies share what was prepared.
class Places {
 public:
  // libraries[s] is that of dataset.setups[s]. Prepares all positions for Poisson's ratios in
  // [nu_low, nu_high]. `kept`: see SetupPlaces.
  Places(const std::vector<std::shared_ptr<const ContactLibrary>>& libraries,
         const Dataset& dataset, double nu_low, double nu_high, std::size_t kept);

  // The stiffness about a material, as SetupLinearisation says. All that is dear is done here.
  Linearisation solve(const MaterialSpec& material) const;
  // What is needed to ask for a material of other regions or features than `known` was solved for.
  Linearisation estimate(const MaterialSpec& material, const Linearisation& known = {}) const;

  int threads() const { return setups_.front()->threads(); }
  std::size_t size() const { return place_->size(); }  // positions
  std::size_t setups() const { return setups_.size(); }
  const std::shared_ptr<const SetupPlaces>& setup(std::size_t s) const { return setups_[s]; }
  const PreparedContact& contact(std::size_t position) const;
  const Vec3& position(std::size_t position) const;
  std::vector<Vec3> normals() const;
  double mesh_uncertainty() const;  // median over the positions, relative
  // The move that the contact points' distances from the surface show; none of several setups.
  RigidMove move() const;

 private:
  std::vector<std::shared_ptr<const SetupPlaces>> setups_;
  std::shared_ptr<const std::vector<Linearisation::Place>> place_;  // by position
};

}  // namespace hapsim
