// Contact stiffness at every position of a recording, for whatever material the model asks.
#pragma once

#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "effects/effect.h"
#include "fem/contact_library.h"

namespace hapsim {

struct PositionStiffness {
  Eigen::Matrix3d K;                         // [N/m]; the body's force on the tool is -K u
  Eigen::Matrix3d dK_dnu;                    // [N/m]
  std::vector<Eigen::Matrix3d> dK_dmodulus;  // [m], one a region
};

class BodyStiffness {
 public:
  // Prepares all positions for Poisson's ratios in [nu_low, nu_high].
  BodyStiffness(const ContactLibrary& library, const std::vector<Vec3>& positions, double nu_low,
                double nu_high);

  // A homogeneous material is exact. With regions: linear about the last solve() with the same key
  // points; without one, the homogeneous stiffness times the geometric mean of the moduli, weighted
  // by each region's share of the strain energy (first order in the contrast).
  PositionStiffness at(std::size_t position, const MaterialSpec& material) const;

  // Finite-element solutions for an inhomogeneous material; nothing to do for a homogeneous one.
  void solve(const MaterialSpec& material);

  const std::vector<PreparedContact>& contacts() const { return contacts_; }
  std::vector<Vec3> normals() const;
  double mesh_uncertainty() const;  // median over the positions, relative

 private:
  using Shares = std::vector<std::vector<double>>;  // [position][region], sums to 1
  const Shares& shares(const MaterialSpec& material) const;

  const ContactLibrary& library_;
  std::vector<Vec3> positions_;
  std::vector<PreparedContact> contacts_;
  std::string solved_layout_;  // of the key points that the solutions belong to
  MaterialSpec solved_;
  std::vector<StiffnessSolution> solutions_;
  mutable std::mutex mutex_;
  mutable std::map<std::string, Shares> shares_;
};

}  // namespace hapsim
