// Contact stiffness at every position of a dataset, of whichever body and tool it is.
#pragma once

#include <memory>
#include <vector>

#include "experiment/dataset.h"
#include "experiment/setup_stiffness.h"

namespace hapsim {

class BodyStiffness {
 public:
  // libraries[s] is that of dataset.setups[s]. Prepares all positions for Poisson's ratios in
  // [nu_low, nu_high].
  BodyStiffness(const std::vector<std::unique_ptr<ContactLibrary>>& libraries,
                const Dataset& dataset, double nu_low, double nu_high);

  // As SetupStiffness says; positions are numbered as in the dataset.
  PositionStiffness at(std::size_t position, const MaterialSpec& material) const;
  void solve(const MaterialSpec& material) const;
  bool is_solved(const MaterialSpec& material) const;
  void forget(const MaterialSpec& material) const;

  int threads() const { return setups_.front()->threads(); }
  std::size_t size() const { return place_.size(); }  // positions
  std::size_t setups() const { return setups_.size(); }
  const SetupStiffness& setup(std::size_t s) const { return *setups_[s]; }
  const PreparedContact& contact(std::size_t position) const;
  const Vec3& position(std::size_t position) const;
  std::vector<Vec3> normals() const;
  double mesh_uncertainty() const;  // median over the positions, relative
  // The move that the contact points' distances from the surface show; none of several setups.
  RigidMove move() const;

 private:
  struct Place {
    std::size_t setup = 0, position = 0;  // within the setup
  };
  std::vector<std::unique_ptr<SetupStiffness>> setups_;
  std::vector<Place> place_;  // by position
};

}  // namespace hapsim
