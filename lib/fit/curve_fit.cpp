#include "fit/curve_fit.h"

#include <algorithm>
#include <cmath>

#include "experiment/nearest_region.h"
#include "fit/boundary_error.h"
#include "fit/boundary_problem.h"
#include "fit/extend_regions.h"
#include "model/body_parameters.h"
#include "model/model_edit.h"
#include "regions/curve_search.h"
#include "regions/locations.h"
#include "regions/region_map.h"

namespace hapsim {
namespace {

using PlanPoint = Eigen::Vector2d;

constexpr int kCurveKeys = 24;  // at least, along a smooth curve

// The material with one region, fitted.
Fit homogeneous_fit(const Fit& start, const Experiment& experiment,
                    const BoundaryOptions& options) {
  Model model = start.model;
  std::erase_if(model.parameters,
                [](const Parameter& p) { return is_of_map(p) || (is_modulus(p) && p.region > 0); });
  return fit(model, experiment, all_episodes(experiment.dataset), options.fit);
}

// Found from the positions' own moduli; `plain` becomes the fit of one region.
std::optional<RegionCurve> curve_for(const Fit& start, const Experiment& experiment,
                                     const BoundaryOptions& options, Fit& plain) {
  const MaterialSpec material = material_of(start.model);
  const bool two = material.modulus.size() == 2;
  plain = homogeneous_fit(start, experiment, options);
  if (plain.stopped) return std::nullopt;
  const Selection all = all_episodes(experiment.dataset);
  const auto samples = merged_places(location_samples(plain.model, experiment, plain.about, all,
                                                      {options.fit.noise, options.fit.floor}));
  if (samples.empty()) return std::nullopt;
  std::vector<std::vector<float>> share;
  std::vector<int> label;
  for (const LocationSample& s : samples) {
    share.push_back(experiment.places.contact(static_cast<std::size_t>(s.position)).plan_share);
    label.push_back(region_at(material, s.point));
  }
  std::function<int(const PlanPoint&)> side;
  if (two && material.modulus[0] != material.modulus[1])
    side = [&](const PlanPoint& p) {
      const int region = region_at(material, {p.x(), p.y(), 0});
      return material.modulus[region] >= std::max(material.modulus[0], material.modulus[1]) ? 1 : 0;
    };
  auto curve = find_curve(samples, share, experiment.places.setup(0)->grid(), side);
  if (curve && !two && curve->criterion > labels_criterion(samples, label) + kStrongEvidence)
    curve.reset();
  return curve;
}

// `start` with its regions replaced by two along the curve, moved until the forces fit.
BoundaryFit refined_curve(const Fit& start, const Fit& plain, RegionCurve curve,
                          const Experiment& experiment, const TetMesh& mesh,
                          const BoundaryOptions& options) {
  const Dataset& dataset = experiment.dataset;
  const double tool_radius = dataset.recording.disc_radius();
  const std::vector<BoundaryLine> before = long_boundaries(start.model, mesh, tool_radius);
  const int keys = std::max(options.key_points, kCurveKeys);
  BoundaryFit result{start, before, {}, {}, false};
  Fit now = plain;
  // Without key points: where the body has numbers these moduli would be theirs, not the curve's.
  Model from = with_moduli(plain.model, {curve.log_gain[0], curve.log_gain[1]});
  for (int round = 0; round < options.rounds && !result.fitted.stopped; ++round) {
    std::vector<PlanPoint> nodes;
    const FieldGrid grid = plan_nodes(mesh, 0.5 * tool_radius);
    for (std::size_t n = 0; n < grid.size(); ++n) nodes.emplace_back(grid.node(n).head<2>());
    const MovingCurve moving(curve, nodes, tool_radius);
    BoundaryProblem problem(now, from, experiment, mesh, moving, grid.step, options);
    LeastSquaresOptions search;
    search.max_iterations = 15;
    search.step_tolerance = 1e-2;
    search.decrease_tolerance = 1e-2;
    const LeastSquaresResult solution = problem.minimise(search, now.error.pooled);
    curve.theta = problem.shifts(solution.x);
    const Eigen::MatrixXd covariance =
        problem.covariance(solution.x).bottomRightCorner(curve.theta.size(), curve.theta.size());
    const PlaneClassifier classify = [&](const PlanPoint& p) { return curve.region(p); };
    const std::vector<BoundaryLine> lines = long_boundaries(classify, mesh, tool_radius);
    if (lines.empty()) break;
    Model moved = problem.with_moduli(from, solution.x);
    std::erase_if(moved.parameters, is_of_map);
    place_key_points(moved, classify, lines, keys);
    Fit fitted = fit(moved, experiment, all_episodes(dataset), options.fit);
    if (fitted.stopped) {
      result.fitted.stopped = true;
      result.fitted.converged = false;
      result.fitted.message = fitted.message;
      break;
    }
    now = fitted;
    from = fitted.model;
    // More moduli than two fit a little better whatever they are.
    const double allowed = material_of(start.model).modulus.size() > 2 && !result.better ? 1.02 : 1;
    const bool better = fitted.error.pooled < allowed * result.fitted.error.pooled;
    if (!better && result.better) break;
    if (better) {
      result.fitted = std::move(fitted);
      result.lines.clear();
      result.moved.clear();
      result.better = true;
    } else if (material_of(start.model).modulus.size() > 2) {
      break;
    }
    result.error.clear();
    std::vector<BoundaryLine> drawn;
    for (const BoundaryLine& line : better ? lines : before) {
      drawn.push_back({line.a, line.b, key_points(line, keys)});
      for (const PlanPoint& p : drawn.back().points) {
        const Eigen::RowVectorXd by = curve.level.distance(p, curve.theta).by_theta;
        const double variance = (by * covariance * by.transpose()).value();
        const bool repeated =
            &p == &drawn.back().points.back() && (p - drawn.back().points.front()).norm() < 1e-9;
        if (repeated) continue;
        result.error.push_back(std::sqrt(std::max(0.0, variance)));
        if (better) result.moved.push_back(distance_to(before, p));
      }
    }
    if (better) result.lines = drawn;
    add_boundary_error(result.fitted, experiment, problem.by_shift(solution.x), covariance);
    tell_key_point_errors(result.fitted.model, drawn, result.error);
    // How much the modes vary, as those found do (MacKay's fixed point).
    const Eigen::Index modes = curve.theta.size() - PlanLevel::kPlane;
    if (modes > 0) {
      const double told = static_cast<double>(modes) -
                          covariance.diagonal().tail(modes).sum() / (curve.bend * curve.bend);
      const double bend = std::sqrt(curve.theta.tail(modes).squaredNorm() / std::max(1.0, told));
      curve.bend = std::clamp(bend, curve.bend / 2, 2 * curve.bend);
    }
    if (!better) break;
  }
  return result;
}

// The regions' moduli are replaced by two free ones: none may be held, or bound to another.
bool may_be_a_curve(const Model& model, const BoundaryOptions& options) {
  return options.fit.constraints.empty() &&
         std::none_of(model.parameters.begin(), model.parameters.end(), [](const Parameter& p) {
           return is_modulus(p) && p.state != ParameterState::kFree;
         });
}

// Region 0 becomes the stiffer, as it was before.
void turn_round(RegionCurve& curve) {
  curve.theta = -curve.theta;
  std::swap(curve.log_gain[0], curve.log_gain[1]);
}

}  // namespace

std::optional<BoundaryFit> fit_as_curve(const Fit& start, const Experiment& experiment,
                                        const TetMesh& mesh, const BoundaryOptions& options) {
  if (!may_be_a_curve(start.model, options)) return std::nullopt;
  Fit plain;
  auto curve = curve_for(start, experiment, options, plain);
  if (!curve) return std::nullopt;
  const std::vector<double> modulus = material_of(start.model).modulus;
  if (modulus.size() == 2 && modulus[0] > modulus[1]) turn_round(*curve);
  BoundaryFit two = refined_curve(start, plain, *curve, experiment, mesh, options);
  if (!two.better && !two.fitted.stopped) return std::nullopt;
  // Of more than two regions the names are of others.
  if (modulus.size() > 2) two.fitted.model.metadata.remove("region_names");
  return two;
}

}  // namespace hapsim
