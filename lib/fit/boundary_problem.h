// The moduli of the regions and what moves the boundaries between them, fitted together.
#pragma once

#include <vector>

#include "estimate/least_squares.h"
#include "experiment/weights.h"
#include "fit/boundary_fit.h"
#include "fit/moving_boundary.h"
#include "imaging/field_contacts.h"
#include "regions/region_boundary.h"

namespace hapsim {

// Those between the regions of `classify` that are longer than the tool is wide.
std::vector<BoundaryLine> long_boundaries(const PlaneClassifier& classify, const TetMesh& mesh,
                                          double tool_radius);
std::vector<BoundaryLine> long_boundaries(const Model& model, const TetMesh& mesh,
                                          double tool_radius);

class BoundaryProblem {
 public:
  // `start`: the moduli to begin with and all else that the forces need; `fitted` weighs them.
  BoundaryProblem(const Fit& fitted, const Model& start, const Experiment& experiment,
                  const TetMesh& mesh, const MovingBoundary& boundary, double step,
                  const BoundaryOptions& options);

  // The watch is told `error`.
  LeastSquaresResult minimise(LeastSquaresOptions search, double error);

  // Of the unknowns at x, their bounds left aside: the noise (or the misfit, where that is larger)
  // and the gain error of each position.
  Eigen::MatrixXd covariance(const Eigen::VectorXd& x);
  // Derivatives of the forces by the boundary's unknowns at x, stacked rows x unknowns.
  const Eigen::MatrixXd& by_shift(const Eigen::VectorXd& x);

  Eigen::VectorXd shifts(const Eigen::VectorXd& x) const;
  // `model` with the moduli of x.
  Model with_moduli(Model model, const Eigen::VectorXd& x) const;

 private:
  std::vector<Unknown> unknowns() const;
  void residuals(const Eigen::VectorXd& x, Eigen::VectorXd& r, Eigen::MatrixXd* J);
  void evaluate(const Eigen::VectorXd& x);

  Model model_;
  const Dataset& dataset_;
  Selection selection_;
  const MovingBoundary& boundary_;
  const BoundaryOptions& options_;
  FieldContacts contacts_;
  Eigen::VectorXd measured_;
  Weights weights_;
  std::vector<int> free_;
  Eigen::VectorXd x_, r_;
  Eigen::MatrixXd J_, by_shift_;
};

// Of cells of that size over the body in plan view, corners.
FieldGrid plan_nodes(const TetMesh& mesh, double step);

}  // namespace hapsim
