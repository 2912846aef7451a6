// Moduli from the first samples, while the loop runs.
#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>
#include <vector>

#include "realtime/prepared_body.h"
#include "realtime/tool_loop.h"

namespace hapsim {

constexpr int kMostUnknowns = 6;
using ModuliVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMostUnknowns, 1>;
using ModuliMatrix =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMostUnknowns, kMostUnknowns>;
// What each modulus makes of the force where it is 1 Pa [m^2]: a column a modulus.
using UnitForces = Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, kMostUnknowns>;

// The force is linear in the moduli: f = E g_0 + sum_i E_i g_i, g_0 the force of a body of 1 Pa,
// g_i its memory of relaxation time tau_i (given, at most five). So the forces of a unit body,
// which cost about one force evaluation, are all that is needed to identify and then to predict.
class UnitResponse : public ToolLoop {
 public:
  // `body`: prepared for a model of E = 1 Pa without relaxation; outlives the loop.
  UnitResponse(const PreparedBody& body, const std::vector<double>& times,
               const ToolLoopOptions& options = {});
  const UnitForces& unit_forces() const { return g_; }  // of the last sample
  void set_moduli(const ModuliVector& moduli) noexcept { moduli_ = moduli; }

 protected:
  void take_place(const Place& place) noexcept override;
  void forget() noexcept override { begun_ = false; }
  Vec3 advance(double t, const Vec3& u) noexcept override;  // by the moduli that were set

 private:
  const PreparedBody& body_;
  std::vector<double> times_;
  UnitForces g_;
  ModuliVector moduli_;
  Eigen::Matrix3d K_ = Eigen::Matrix3d::Zero();
  Vec3 elastic_ = Vec3::Zero();
  double t_ = 0;
  bool begun_ = false;
};

struct OnlineEstimate {
  ModuliVector moduli;  // E, E_1, ... [Pa], not negative
  ModuliVector error;   // standard errors; infinite where the samples do not tell
  double rmse = std::numeric_limits<double>::quiet_NaN();  // of a force component [N]
  long samples = 0;
};

// Least squares of measured forces on unit forces under moduli >= 0: normal equations that grow
// sample by sample, old ones fading with a time constant (in samples) when asked. add() and
// estimate() allocate nothing.
class OnlineIdentification {
 public:
  explicit OnlineIdentification(int unknowns,
                                double memory = std::numeric_limits<double>::infinity());
  void add(const UnitForces& unit, const Vec3& force) noexcept;
  OnlineEstimate estimate() const noexcept;
  void restart() noexcept;

 private:
  int unknowns_;
  double keep_;
  ModuliMatrix A_;
  ModuliVector b_;
  double squares_ = 0, weight_ = 0;
  long samples_ = 0;
};

}  // namespace hapsim
