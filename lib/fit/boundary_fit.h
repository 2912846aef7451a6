// Regions' moduli and the boundaries between them, refined in turn from the recording (thesis
// 5.4.3).
#pragma once

#include <functional>
#include <vector>

#include "cluster/class_boundary.h"
#include "fit/fit.h"
#include "mesh/tetmesh.h"

namespace hapsim {

struct BoundaryOptions {
  int key_points = 8;  // along each boundary
  int rounds = 2;      // boundary, then material
  int threads = 0;
  FitOptions fit;
  std::function<void()> progress;  // whenever a position was solved
};

struct BoundaryFit {
  // Its key points on both sides of the moved boundaries; the standard errors of the moduli and of
  // the key points have the boundaries' own in them.
  Fit fitted;
  std::vector<BoundaryLine> lines;  // through the key points
  std::vector<double> moved;        // distance of each key point from the boundaries of `start` [m]
  std::vector<double> error;        // standard error of its place [m]
  bool better =
      false;  // than `start`; else `fitted` is that but for the errors, and nothing has moved
};

// Regions that act on each other through the body, so that where they end is asked.
bool has_boundaries(const Model& model);

// `start`: a fitted model with regions. The boundaries' key points move along their normals, the
// moduli of the regions with them, by Gauss-Newton with exact derivatives: the body's modulus is a
// field that goes from one region's to the other's over two tool radii about the boundary, solved
// by finite elements at every step. Then all free parameters are fitted with the boundary held.
// Forces count by the noise and the gain error `floor` of each position, in place of the thesis's
// weights of the components: across the surface, where the boundary shows, the force is small and
// so is what it may err. Each shift is drawn to 0 by the error of a boundary that is only known to
// lie between presses, half their spacing, and stays within one spacing, thesis (5.43).
// Two regions, or more where the positions' own moduli are explained as well by two, have any
// smooth curve between them instead (find_curve()), drawn by 24 key points at least, where their
// moduli are free and no constraints bind them: its level and the two moduli are what is fitted,
// and how much its modes vary is chosen anew after each round. The softer of two regions stays the
// one it was; of more, the names are gone. One setup only. Error(kBadInput): no boundary between
// the regions of the model lies on the body.
BoundaryFit refine_boundaries(const Fit& start, const Experiment& experiment, const TetMesh& mesh,
                              const BoundaryOptions& options);

}  // namespace hapsim
