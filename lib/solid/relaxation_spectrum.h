// A body whose regions relax each in its own way, as one set of Maxwell elements.
#pragma once

#include <Eigen/SVD>
#include <utility>
#include <vector>

namespace hapsim {

// One Maxwell element: its modulus [Pa] and relaxation time [s].
struct MaxwellModulus {
  double modulus = 0, tau = 1;
};

// A generalised Maxwell material of one Poisson's ratio: under a strain exp(s t) its modulus is
// E(s) = E + sum E_i s tau_i / (1 + s tau_i); E(0) relaxed, E(inf) at once.
struct RegionRelaxation {
  double modulus = 0;  // E [Pa]
  std::vector<MaxwellModulus> terms;
  double at(double s) const;  // s >= 0 [1/s], or infinity
};

// With regions of one Poisson's ratio the stiffness against the tool is K(s) = K(E_1(s), E_2(s),
// ...), of degree one in the moduli, so all its poles are real and lie where two of the moduli have
// opposite signs: between a region's relaxation times tau_i and the retardation times -1/s of the
// zeros of its E(s) (the correspondence principle; Christensen, Theory of Viscoelasticity, ch. 2).
// A rational function with Chebyshev points of log(time) in these few short intervals as poles,
//   K(s) = K(0) + sum_j K_j s theta_j / (1 + s theta_j),
// fitted to K at real s, converges geometrically (Gonchar; Gautschi, Orthogonal Polynomials):
// to 1e-8 of K(inf) with the points taken here. Each K_j is then a Maxwell element with a matrix
// modulus, and in time the force on the tool is exact for straight motion between samples.
class RelaxationSpectrum {
 public:
  // Error(kBadInput): more than `most` times are needed. Terms must have positive moduli and times.
  explicit RelaxationSpectrum(const std::vector<RegionRelaxation>& regions, std::size_t most = 32);

  const std::vector<double>& times() const { return times_; }  // theta_j [s], ascending
  // The moduli of all regions at which K must be known, one row a sample; the first is K(0), the
  // last K(inf).
  const std::vector<std::vector<double>>& moduli() const { return moduli_; }
  // K_j (times x m) from K at the samples (samples x m entries of it).
  Eigen::MatrixXd parts(const Eigen::MatrixXd& values) const;
  // The largest |K(s) - fit| over the samples, relative to K(inf), for one entry of K and its
  // parts: what the fit leaves.
  double misfit(const Eigen::VectorXd& values, const Eigen::VectorXd& parts) const;

 private:
  std::vector<double> times_, samples_;
  std::vector<std::vector<double>> moduli_;
  Eigen::MatrixXd terms_;  // samples x times: s theta / (1 + s theta)
  Eigen::VectorXd weight_;
  Eigen::JacobiSVD<Eigen::MatrixXd> weighted_;
};

}  // namespace hapsim
