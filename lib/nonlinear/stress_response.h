// What the stresses of one state do at another: how bodies that remember their stresses are
// condensed.
#pragma once

#include <Eigen/Core>
#include <cstddef>

namespace hapsim {

// Part `index` of `count` of the numbers below, by tetrahedra; the last one ends with all groups'.
struct StressPart {
  std::size_t index = 0, count = 1;
};

// Of a state of a body: stresses as vectors of six numbers a quadrature point (the second
// Piola-Kirchhoff stress, as Voigt) and one a dilatation group (its pressure), and with each the
// change of strain that it does work by, so that of stresses s made at one state and the work w of
// another
//   w' s = integral of S : dE + p dtheta   [N]
// is the force that holds a handle at that other state where the body bears these stresses alone,
// but for what it then moves inside; of one and the same state exactly that of the laws.
// n numbers each (n: 6 points + groups), a column a handle's direction.
struct StressResponse {
  Eigen::VectorXd stress;   // of the laws [Pa]
  Eigen::MatrixXd changes;  // n x directions: d stress / d motion of the handle [Pa/m]
  Eigen::MatrixXd work;     // n x directions: volume times d strain / d motion [m^2]
  Eigen::VectorXd strain;   // n: volume times strain (Green's, theta - 1) [m^3]
  // The same of given fields y_j inside (m of them), which leave the handles where they are: n x m
  // by their amplitudes; and m x m what the stresses do along two of them at once, integral of
  // S : d2E/dy_j dy_k + p d2theta [J].
  Eigen::MatrixXd inside_changes, inside_work, inside_stressed;
};

}  // namespace hapsim
