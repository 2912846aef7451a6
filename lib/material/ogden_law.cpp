#include "material/ogden_law.h"

#include <Eigen/Dense>
#include <cmath>

#include "base/error.h"

namespace hapsim {
namespace {

using Eigen::Matrix3d;

class OgdenLaw : public MaterialLaw {
 public:
  using MaterialLaw::MaterialLaw;

  PointResponse respond(const Matrix3d& C, bool tangent) const override {
    const Principal p(C);
    // By the logarithms of the stretches: w, its slope beta and its second derivative gamma.
    PointResponse r;
    Vec3 beta = Vec3::Zero();
    Matrix3d gamma = Matrix3d::Zero();
    for (int k = 0; k < terms(); ++k) {
      const double mu = constant(2 * k), alpha = constant(2 * k + 1);
      const Vec3 x = p.powers(alpha);
      r.energy += 2 * mu / (alpha * alpha) * (x.sum() - 3);
      beta += 2 * mu / alpha * (x.array() - x.mean()).matrix();
      if (!tangent) continue;
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b)
          gamma(a, b) += 2 * mu * ((a == b ? x[a] : 0) - (x[a] + x[b]) / 3 + x.sum() / 9);
    }
    const Vec3 s = beta.cwiseQuotient(p.c);
    r.S = p.to_space(s);
    if (!tangent) return r;
    VoigtMatrix D = VoigtMatrix::Zero();
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b)
        D(a, b) = (gamma(a, b) - (a == b ? 2 * beta[a] : 0)) / (p.c[a] * p.c[b]);
    for (int k = 3; k < 6; ++k) {
      const auto [a, b] = kVoigtPairs[k];
      const double apart = p.c[b] - p.c[a];
      // Where two stretches meet, the quotient's limit; its error is of second order in `apart`.
      D(k, k) = std::abs(apart) > 1e-5 * p.c[a] ? (s[b] - s[a]) / apart
                                                : (D(a, a) + D(b, b) - 2 * D(a, b)) / 4;
    }
    const VoigtMatrix T = stress_rotation(p.axes);
    r.D = T * D * T.transpose();
    return r;
  }

  VolumeResponse volume(double theta) const override {
    const double K = constants().back().value;
    return {K / 2 * (theta - 1) * (theta - 1), K * (theta - 1), K};
  }

  std::vector<Voigt> stress_by_constants(const Matrix3d& C) const override {
    const Principal p(C);
    std::vector<Voigt> result;
    for (int k = 0; k < terms(); ++k) {
      const double mu = constant(2 * k), alpha = constant(2 * k + 1);
      const Vec3 x = p.powers(alpha), by_alpha = x.cwiseProduct(p.logarithm);
      const Vec3 unit = 2 / alpha * (x.array() - x.mean()).matrix();
      const Vec3 slope = 2 / alpha * (by_alpha.array() - by_alpha.mean()).matrix();
      result.push_back(p.to_space(unit.cwiseQuotient(p.c)));
      result.push_back(p.to_space((mu * (slope - unit / alpha)).cwiseQuotient(p.c)));
    }
    result.push_back(Voigt::Zero());
    return result;
  }

  std::vector<double> pressure_by_constants(double theta) const override {
    std::vector<double> result(constants().size(), 0);
    result.back() = theta - 1;
    return result;
  }

 private:
  int terms() const { return static_cast<int>(constants().size() / 2); }

  struct Principal {
    Vec3 c;          // squares of the stretches
    Vec3 logarithm;  // of the isochoric stretches
    Matrix3d axes;
    explicit Principal(const Matrix3d& C) {
      const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(C);
      c = solver.eigenvalues();
      axes = solver.eigenvectors();
      logarithm = 0.5 * c.array().log();
      logarithm.array() -= logarithm.mean();
    }
    Vec3 powers(double alpha) const { return (alpha * logarithm.array()).exp(); }
    Voigt to_space(const Vec3& s) const {
      return to_voigt(axes * s.asDiagonal() * axes.transpose());
    }
  };
};

}  // namespace

LawPointer ogden_law(const std::vector<OgdenTerm>& terms, double bulk) {
  double mu = 0;
  std::vector<LawConstant> constants;
  for (const OgdenTerm& t : terms) {
    if (!(std::abs(t.alpha) > 1e-6))
      fail_input("", "an exponent of Ogden's law is zero", "give alpha != 0");
    mu += t.mu;
    const std::string number = std::to_string(1 + constants.size() / 2);
    constants.push_back({"mu" + number, "Pa", "part of the shear modulus", t.mu});
    constants.push_back({"alpha" + number, "1", "exponent of the stretches", t.alpha});
  }
  if (!(mu > 0)) fail_input("", "the shear modulus is not positive", "give mu > 0 in the sum");
  if (!(bulk > 0)) fail_input("", "the bulk modulus is not positive", "give K > 0");
  constants.push_back({"K", "Pa", "bulk modulus", bulk});
  return std::make_shared<OgdenLaw>(std::move(constants));
}

}  // namespace hapsim
