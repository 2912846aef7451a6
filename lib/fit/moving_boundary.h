// A boundary between regions that a fit moves: what lies at a place, by the boundary's numbers.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "cluster/class_boundary.h"
#include "estimate/least_squares.h"
#include "fit/boundary_graph.h"
#include "regions/curve_search.h"

namespace hapsim {

class MovingBoundary {
 public:
  virtual ~MovingBoundary() = default;
  virtual std::vector<Unknown> unknowns() const = 0;
  // `share` of the region `left`, the rest of `right`, going from 0 to 1 over `width` [m]; and its
  // derivative by the unknowns.
  struct Blend {
    int left = 0, right = 0;
    double share = 0;
    Eigen::RowVectorXd by;
  };
  virtual Blend at(const Eigen::Vector2d& p, const Eigen::VectorXd& x, double width) const = 0;
  // What is known before the forces, as whitened residuals and their derivatives.
  virtual void known(const Eigen::VectorXd& x, Eigen::VectorXd& r, Eigen::MatrixXd& J) const = 0;
};

// The key points of lines, each shifted along its normal [m]: within `spacing`, drawn to 0 by half
// of it.
class ShiftedLines : public MovingBoundary {
 public:
  ShiftedLines(const BoundaryGraph& graph, double spacing) : graph_(graph), spacing_(spacing) {}
  std::vector<Unknown> unknowns() const override;
  Blend at(const Eigen::Vector2d& p, const Eigen::VectorXd& x, double width) const override;
  void known(const Eigen::VectorXd& x, Eigen::VectorXd& r, Eigen::MatrixXd& J) const override;

 private:
  const BoundaryGraph& graph_;
  double spacing_;
};

// The curve on which a level is 0, region 1 where it is positive. Its modes vary by `bend`, and its
// mean slope along the curve is 1.
class MovingCurve : public MovingBoundary {
 public:
  // `places`: where the curve's mean slope is taken, those near it.
  MovingCurve(const RegionCurve& curve, std::vector<Eigen::Vector2d> places, double band)
      : curve_(curve), places_(std::move(places)), band_(band) {}
  std::vector<Unknown> unknowns() const override;
  Blend at(const Eigen::Vector2d& p, const Eigen::VectorXd& x, double width) const override;
  void known(const Eigen::VectorXd& x, Eigen::VectorXd& r, Eigen::MatrixXd& J) const override;

 private:
  const RegionCurve& curve_;
  std::vector<Eigen::Vector2d> places_;
  double band_;
};

}  // namespace hapsim
