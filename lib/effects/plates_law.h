// The compression of a whole body between plates at finite strain.
#pragma once

namespace hapsim {

// The strain to which it was verified, and the heights over the diameter.
constexpr double kMostPlateStrain = 0.3;
constexpr double kLeastSlender = 0.35, kMostSlender = 1.5;

// The stress along the axis of a bar that is free at its sides, over its Young's modulus, as a
// function of the compression e = 1 - l [-] (l its stretch; negative e: tension); e for small e. Of
// W = mu/(2b) (exp(b (I1bar - 3)) - 1) + K/2 (J - 1)^2 (hyperelastic_law.h) with the transverse
// stretch t that leaves the sides free: dW/dt = 0, dW/dl per unit of first area. Plates that hold
// the body's faces make it stiffer by a factor that is in the body's stiffness; of finite elements
// of cylinders, 0.35 to 1.5 diameters high, bonded to the plates, this is at nu = 0.45 within 3 %
// to e = 0.2 and 8 % to 0.3 (b to 0.5; 16 % with b = 2), at nu = 0.3 and 0.49 within 12 and 21 %,
// flat ones being the worst (tests/verify/plates_test.cpp).
struct PlatesLaw {
  double b = 0;
  double nu = 0.45;
  bool finite = true;  // else e exp(3 b e^2): the same energy at small strain
  // Compressions beyond 0.95 give that of 0.95.
  double stress(double e) const;
  double by_strain(double e) const;
  double by_b(double e) const;
  double by_nu(double e) const;
};

}  // namespace hapsim
