#include "material/hyperelastic_law.h"

#include <Eigen/Dense>
#include <cmath>

#include "base/error.h"

namespace hapsim {
namespace {

// f(x), f', f'' of x = I1bar - 3.
struct Curve {
  double value, first, second;
};

// What all laws of I1bar share; the last constant is K.
class FirstInvariantLaw : public MaterialLaw {
 public:
  using MaterialLaw::MaterialLaw;

  PointResponse respond(const Eigen::Matrix3d& C, bool tangent) const override {
    const State s = state(C);
    const Curve f = curve(s.x);
    PointResponse r;
    r.energy = f.value;
    r.S = 2 * f.first * s.gradient;
    if (!tangent) return r;
    // d2 I1bar / dC dC, from d(C^-1)/dC = -(C^-1 o C^-1).
    const Voigt one = to_voigt(Eigen::Matrix3d::Identity()), c = to_voigt(s.inverse);
    const VoigtMatrix cross = c * one.transpose();
    const VoigtMatrix hessian =
        s.scale * ((s.I1 / 9) * c * c.transpose() - (cross + cross.transpose()) / 3 +
                   (s.I1 / 3) * symmetric_product(s.inverse));
    r.D = 4 * f.second * s.gradient * s.gradient.transpose() + 4 * f.first * hessian;
    return r;
  }

  VolumeResponse volume(double theta) const override {
    const double K = bulk();
    return {K / 2 * (theta - 1) * (theta - 1), K * (theta - 1), K};
  }

  std::vector<Voigt> stress_by_constants(const Eigen::Matrix3d& C) const override {
    const State s = state(C);
    std::vector<Voigt> result;
    for (const double slope : slope_by_constants(s.x)) result.push_back(2 * slope * s.gradient);
    result.push_back(Voigt::Zero());
    return result;
  }

  std::vector<double> pressure_by_constants(double theta) const override {
    std::vector<double> result(constants().size(), 0);
    result.back() = theta - 1;
    return result;
  }

 private:
  virtual Curve curve(double x) const = 0;
  virtual std::vector<double> slope_by_constants(double x) const = 0;  // df'/dc, without K
  double bulk() const { return constants().back().value; }

  struct State {
    double I1, scale, x;      // tr C, J^(-2/3), I1bar - 3
    Eigen::Matrix3d inverse;  // of C
    Voigt gradient;           // d I1bar / dC
  };
  static State state(const Eigen::Matrix3d& C) {
    State s;
    s.I1 = C.trace();
    s.inverse = C.inverse();
    s.scale = 1 / std::cbrt(C.determinant());
    s.x = s.scale * s.I1 - 3;
    s.gradient = s.scale * to_voigt(Eigen::Matrix3d::Identity() - s.I1 / 3 * s.inverse);
    return s;
  }
};

class NeoHookeanLaw : public FirstInvariantLaw {
 public:
  using FirstInvariantLaw::FirstInvariantLaw;

 private:
  Curve curve(double x) const override { return {constant(0) / 2 * x, constant(0) / 2, 0}; }
  std::vector<double> slope_by_constants(double) const override { return {0.5}; }
};

class YeohLaw : public FirstInvariantLaw {
 public:
  using FirstInvariantLaw::FirstInvariantLaw;

 private:
  Curve curve(double x) const override {
    const double a = constant(0), b = constant(1), c = constant(2);
    return {x * (a + x * (b + x * c)), a + x * (2 * b + x * 3 * c), 2 * b + 6 * c * x};
  }
  std::vector<double> slope_by_constants(double x) const override { return {1, 2 * x, 3 * x * x}; }
};

class ExponentialLaw : public FirstInvariantLaw {
 public:
  using FirstInvariantLaw::FirstInvariantLaw;

 private:
  Curve curve(double x) const override {
    const double mu = constant(0), b = constant(1);
    const double value = b * std::abs(x) < 1e-9 ? mu / 2 * x : mu / (2 * b) * std::expm1(b * x);
    const double slope = mu / 2 * std::exp(b * x);
    return {value, slope, b * slope};
  }
  std::vector<double> slope_by_constants(double x) const override {
    const double e = std::exp(constant(1) * x) / 2;
    return {e, constant(0) * x * e};
  }
};

void check(double mu, double bulk) {
  if (!(mu > 0)) fail_input("", "the shear modulus is not positive", "give mu > 0");
  if (!(bulk > 0)) fail_input("", "the bulk modulus is not positive", "give K > 0");
}

const LawConstant kMu{"mu", "Pa", "shear modulus at small strain", 0};
const LawConstant kBulk{"K", "Pa", "bulk modulus", 0};

LawConstant with(LawConstant constant, double value) {
  constant.value = value;
  return constant;
}

}  // namespace

LawPointer neo_hookean_law(double mu, double bulk) {
  check(mu, bulk);
  return std::make_shared<NeoHookeanLaw>(
      std::vector<LawConstant>{with(kMu, mu), with(kBulk, bulk)});
}

LawPointer yeoh_law(double c10, double c20, double c30, double bulk) {
  check(2 * c10, bulk);
  return std::make_shared<YeohLaw>(
      std::vector<LawConstant>{{"C10", "Pa", "half the shear modulus", c10},
                               {"C20", "Pa", "stiffening, first order", c20},
                               {"C30", "Pa", "stiffening, second order", c30},
                               with(kBulk, bulk)});
}

LawPointer exponential_law(double mu, double b, double bulk) {
  check(mu, bulk);
  if (!(b >= 0)) fail_input("", "the exponent b is negative", "give b >= 0");
  return std::make_shared<ExponentialLaw>(std::vector<LawConstant>{
      with(kMu, mu), {"b", "1", "exponent of the stiffening", b}, with(kBulk, bulk)});
}

Moduli moduli(double youngs_modulus, double poisson_ratio) {
  const double e = youngs_modulus, nu = poisson_ratio;
  return {e / (2 * (1 + nu)), e / (3 * (1 - 2 * nu))};
}

Moduli moduli_by_poisson(double youngs_modulus, double poisson_ratio) {
  const double e = youngs_modulus, nu = poisson_ratio;
  return {-e / (2 * (1 + nu) * (1 + nu)), 2 * e / (3 * (1 - 2 * nu) * (1 - 2 * nu))};
}

}  // namespace hapsim
