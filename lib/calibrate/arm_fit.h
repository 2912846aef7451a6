// The compliance of an arm from presses on a rigid block.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "recording/recording.h"
#include "rig/calibration.h"

namespace hapsim {

struct ArmFit {
  std::array<CalibratedValue, kSymmetric> numbers;  // xx, yy, zz, xy, xz, yz [m/N]
  Eigen::MatrixXd covariance;                       // of the numbers, 6 x 6 [m2/N2]
  double noise = 0;                                 // of a component of the displacement [m]
  double freedom = 0;                               // independent numbers that it is known by
  double reach = 0;               // largest displacement that the fit explains [m]
  std::vector<std::string> open;  // sentences: what these presses do not tell
};

// On a rigid block all that moves is the arm: u = u0 - S f in each press, u0 where its contact was
// found. Least squares in the six numbers of S (symmetric by Maxwell's and Betti's theorem), with
// u0 of each press by itself; the standard errors count neighbours in time that err together once
// (autocorrelation time). Numbers that no press excites (below a hundredth of what the others have)
// are `assumed` 0. The noise of the forces is not counted: it makes S smaller by its share of
// their variance. Rows in the air are left out. Error(kBadInput): no press with three rows and a
// force, displacements that go with the force (a tool that is pushed out of the block).
ArmFit fit_arm(const Recording& presses);

// Writes the numbers into a calibration, with the metadata arm_source and arm_noise.
void add_arm(const ArmFit& fit, const Recording& presses, Calibration& calibration);

}  // namespace hapsim
