// How far points of the surface move with the tool, by place and material.
#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "experiment/places.h"

namespace hapsim {

// A point moves by G u, u the displacement of a bonded flat tool (contact/marker_solution.h). A
// common modulus drops out, and so does how it relaxes.
struct MarkerGain {
  Eigen::Matrix3d G = Eigen::Matrix3d::Zero();             // [-]
  std::vector<std::pair<int, Eigen::Matrix3d>> by_column;  // by the material's free parameters
  double doubt = 0;  // standard deviation of an entry, by the two meshes
};

// At all places of an experiment; copies share what was solved.
class MarkerGains {
 public:
  MarkerGains() = default;
  // Of these points on the measured body. About the material, which has no features; its regions
  // are solved for where `regions` says so. Costs a solution a place and Poisson's ratio (three
  // where that is free), on two meshes.
  MarkerGains(const Places& places, const MaterialSpec& material, const std::vector<Vec3>& points,
              bool regions);

  // By point. Homogeneous: exact in Poisson's ratio. Of regions that were solved for: linear in
  // the logarithms of their moduli and in Poisson's ratio, exact in a common factor. Where the body
  // has moved, of the move that this was made for.
  std::vector<MarkerGain> at(std::size_t position, const MaterialSpec& material) const;

 private:
  struct OfSetup {
    std::shared_ptr<const MarkerPlaces> solved;
    std::vector<std::vector<UnitStiffness>> G;  // [place][point], of one modulus
  };
  std::vector<Linearisation::Place> place_;  // by position
  std::vector<OfSetup> setups_;
};

}  // namespace hapsim
