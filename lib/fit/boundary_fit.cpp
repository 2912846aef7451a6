#include "fit/boundary_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "base/error.h"
#include "experiment/nearest_region.h"
#include "fit/boundary_error.h"
#include "fit/boundary_graph.h"
#include "fit/boundary_problem.h"
#include "fit/curve_fit.h"
#include "fit/extend_regions.h"
#include "model/body_parameters.h"
#include "model/model_edit.h"
#include "regions/region_map.h"

namespace hapsim {
namespace {

using PlanPoint = Eigen::Vector2d;

// Mean distance of the positions from their nearest neighbour.
double spacing_of(const std::vector<Vec3>& positions) {
  double sum = 0;
  for (const Vec3& p : positions) {
    double least = std::numeric_limits<double>::infinity();
    for (const Vec3& q : positions)
      if (&p != &q) least = std::min(least, (p - q).norm());
    sum += least;
  }
  return sum / static_cast<double>(positions.size());
}

}  // namespace

bool has_boundaries(const Model& model) {
  const MaterialSpec material = material_of(model);
  return !material.local &&
         std::set<int>(material.key_region.begin(), material.key_region.end()).size() > 1;
}

BoundaryFit refine_boundaries(const Fit& start, const Experiment& experiment, const TetMesh& mesh,
                              const BoundaryOptions& options) {
  const Dataset& dataset = experiment.dataset;
  const double tool_radius = dataset.recording.disc_radius();
  const double spacing = spacing_of(dataset.positions);
  BoundaryFit result{start, long_boundaries(start.model, mesh, tool_radius), {}, {}, false};
  if (result.lines.empty())
    fail_input(start.model.name, "the model has no boundary between regions on this body",
               "give a model of hs-cluster --write-model, or --add regions");
  if (auto curve = fit_as_curve(start, experiment, mesh, options)) return *std::move(curve);
  const std::vector<BoundaryLine> before = result.lines;
  for (int round = 0; round < options.rounds && !result.fitted.stopped; ++round) {
    const MaterialSpec material = material_of(result.fitted.model);
    const PlaneClassifier classify = [&](const PlanPoint& p) {
      return region_at(material, {p.x(), p.y(), 0});
    };
    const BoundaryGraph graph(result.lines, classify, options.key_points, 4 * tool_radius);
    const ShiftedLines moving(graph, spacing);
    BoundaryProblem problem(result.fitted, result.fitted.model, experiment, mesh, moving,
                            tool_radius, options);
    LeastSquaresOptions search;
    search.max_iterations = 12;
    search.step_tolerance = 0.1;       // of a tenth of the spacing
    search.decrease_tolerance = 1e-2;  // a tenth of a standard error
    const LeastSquaresResult solution = problem.minimise(search, result.fitted.error.pooled);
    const Eigen::VectorXd shift = problem.shifts(solution.x);
    const Eigen::MatrixXd covariance =
        problem.covariance(solution.x).bottomRightCorner(shift.size(), shift.size());
    const std::vector<BoundaryLine> lines = graph.lines(shift);
    Model moved = problem.with_moduli(result.fitted.model, solution.x);
    std::erase_if(moved.parameters, is_of_map);
    place_key_points(
        moved, [&](const PlanPoint& p) { return graph.region(p, shift); }, lines,
        options.key_points);
    Fit fitted = fit(moved, experiment, all_episodes(dataset), options.fit);
    const auto tell_errors = [&](const std::vector<BoundaryLine>& where) {
      result.error.clear();
      for (Eigen::Index k = 0; k < shift.size(); ++k)
        result.error.push_back(std::sqrt(std::max(0.0, covariance(k, k))));
      add_boundary_error(result.fitted, experiment, problem.by_shift(solution.x), covariance);
      tell_key_point_errors(result.fitted.model, where, result.error);
    };
    if (fitted.error.pooled >= result.fitted.error.pooled) {
      if (!fitted.stopped && round == 0)
        tell_errors(graph.lines(0 * shift));  // where they stay, no better known
      if (!fitted.stopped) break;
      result.fitted.stopped = true;
      result.fitted.converged = false;
      result.fitted.message = fitted.message;
      break;
    }
    result.fitted = std::move(fitted);
    result.lines = lines;
    result.better = true;
    result.moved.clear();
    for (const BoundaryLine& line : lines)
      for (const PlanPoint& p : line.points) result.moved.push_back(distance_to(before, p));
    tell_errors(lines);
  }
  return result;
}

}  // namespace hapsim
