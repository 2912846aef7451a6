// Measured torques as rows of a fit beside the forces.
#pragma once

#include <memory>
#include <string>

#include "fit/fit.h"

namespace hapsim {

// The torques of a selection, and what a model says of them. Empty where none were measured or the
// model does not say what they are. Where each press has an offset of its own (`offsets`), their
// means are taken out as those of the forces are.
class TorqueRows {
 public:
  TorqueRows() = default;
  TorqueRows(const Model& start, const Experiment& experiment, const Selection& selection,
             const FitOptions& options, bool offsets);

  bool empty() const { return measured_.size() == 0; }
  Eigen::Index size() const { return measured_.size(); }
  const std::string& unused() const { return unused_; }  // why measured ones do not count

  // The levers anew, for the regions of this material.
  void solve(const MaterialSpec& material);
  // Whitened residuals (model less measured) after those of the forces, and their derivatives;
  // `forces` are the model's, with derivatives where `J` is wanted.
  void append(const Model& model, const Linearisation& about, const Signal& forces,
              Eigen::VectorXd& r, Eigen::MatrixXd* J) const;
  TorqueError error(const Model& model, const Linearisation& about) const;

 private:
  Signal modelled(const Model& model, const Linearisation& about, const Signal* forces,
                  bool derivatives) const;

  const Experiment* experiment_ = nullptr;
  const Selection* selection_ = nullptr;
  bool exact_regions_ = true, offsets_ = false;
  Eigen::VectorXd measured_;
  Noise noise_;
  double floor_ = 0;
  TorqueLevers levers_;
  std::shared_ptr<const TorqueWeights> weights_;
  std::string unused_;
};

// What a fitted model leaves of measured torques, whether or not they counted in its fit.
TorqueError torque_error(const Fit& fitted, const Experiment& experiment,
                         const Selection& selection, const FitOptions& options);

}  // namespace hapsim
