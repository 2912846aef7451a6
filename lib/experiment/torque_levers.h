// Torque over force of a bonded flat tool, by place and material.
#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "experiment/places.h"

namespace hapsim {

// The body's torque about the tool's tip is L f, f its force on the tool: with the fields of unit
// moves, L = T K^-1 (contact/tool_torque_solution.h). A common modulus drops out, and so does how
// it relaxes.
struct TorqueLever {
  Eigen::Matrix3d L = Eigen::Matrix3d::Zero();             // [m]
  std::vector<std::pair<int, Eigen::Matrix3d>> by_column;  // by the material's free parameters
  double doubt = 0;  // standard deviation of an entry, by the two meshes [m]
};

// At all places of an experiment; copies share what was solved.
class TorqueLevers {
 public:
  TorqueLevers() = default;
  // About the material, which has no features. Its regions are solved for where `regions` says so,
  // else the levers are those of one modulus. Costs a solution a place and Poisson's ratio (three
  // where that is free), on two meshes.
  TorqueLevers(const Places& places, const MaterialSpec& material, bool regions);

  // Homogeneous: exact in Poisson's ratio. Of regions that were solved for: by their moduli as
  // their energies say, exact in a common factor, linear in Poisson's ratio.
  TorqueLever at(std::size_t position, const MaterialSpec& material) const;

 private:
  struct OfSetup {
    std::shared_ptr<const TorquePlaces> solved;
    std::vector<UnitStiffness> K, T;  // by place, of one modulus
  };
  std::vector<Linearisation::Place> place_;  // by position
  std::vector<OfSetup> setups_;
};

}  // namespace hapsim
