// The torques of a model along the motion of a recording, beside the measured ones.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "experiment/forces.h"
#include "experiment/torque_levers.h"

namespace hapsim {

// Why the model does not say what the tool's torques are in these presses; "" when it does: then
// they are its levers times the body's force, as the tool feels it before the sensor. That holds
// for a bonded flat tool that does not turn, on a body that is linear, of one law of relaxation and
// without layers or inclusions.
std::string torque_refusal(const Model& model, const Dataset& dataset);

// The body's force on the tool before any error of the sensor, with the model's columns: as
// model_forces() for a model that has none of these.
Signal forces_before_sensor(const Model& model, const Experiment& experiment,
                            const Linearisation& about, const Selection& selection,
                            bool derivatives);

// Stacked torques about the tip (3 x rows) [N m] and, where these forces have derivatives, theirs.
Signal model_torques(const Signal& before_sensor, const Dataset& dataset,
                     const TorqueLevers& levers, const MaterialSpec& material,
                     const Selection& selection);

// Such vectors of rows of the recording in the stacked order.
Eigen::VectorXd stacked(const std::vector<Vec3>& of_rows, const Dataset& dataset,
                        const Selection& selection);

// How much a torque counts: V = noise^2 I + sum over positions of doubt^2 Z Z', Z the nine entries
// of the lever as they act on the force: a lever is worth what the meshes and the floor of the
// stiffness (relative, of the tool's radius) let it be. `forces`: stacked, whose derivatives are
// not looked at.
class TorqueWeights {
 public:
  TorqueWeights(const Dataset& dataset, const Selection& selection, const Eigen::VectorXd& forces,
                const TorqueLevers& levers, const MaterialSpec& material, double noise,
                double floor);
  // V^(-1/2) applied to each column (3 x rows), in place.
  void whiten(Eigen::Ref<Eigen::MatrixXd> columns) const;

 private:
  struct Block {
    std::vector<Eigen::Index> rows;  // of one component
    Eigen::MatrixXd Q;               // orthonormal
    Eigen::VectorXd shrink;
  };
  double noise_;
  std::vector<Block> blocks_;
};

// Of measured less modelled torques.
struct TorqueError {
  std::size_t rows = 0;
  double rms = std::numeric_limits<double>::quiet_NaN();       // of a component [N m]
  double whitened = std::numeric_limits<double>::quiet_NaN();  // of TorqueWeights; 1: as expected
  double noise = 0;                                            // [N m]
  std::string noise_origin;
  double size = 0;     // rms of a measured component [N m]
  std::string unused;  // why torques that were measured did not count; "": they did, or were not
};

// The point about which the torques would be the model's: measured = model + offset x force, by
// least squares over the noise. A tool whose tip is taken for another point shows so.
struct TorquePole {
  Vec3 offset = Vec3::Zero();     // of the tip from that point [m]
  Vec3 std_error = Vec3::Zero();  // by the larger of noise and misfit
  double rms_after = 0;           // of a component [N m]
};
TorquePole torque_pole(const Eigen::VectorXd& residual, const Eigen::VectorXd& force, double noise);

}  // namespace hapsim
