#include "fit/boundary_fit.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/parallel.h"
#include "estimate/least_squares.h"
#include "experiment/nearest_region.h"
#include "fit/boundary_error.h"
#include "fit/boundary_graph.h"
#include "fit/extend_regions.h"
#include "fit/moving_boundary.h"
#include "imaging/field_contacts.h"
#include "model/body_parameters.h"
#include "model/model_edit.h"
#include "regions/curve_search.h"
#include "regions/locations.h"
#include "regions/region_boundary.h"
#include "regions/region_map.h"

namespace hapsim {
namespace {

using PlanPoint = Eigen::Vector2d;

constexpr int kScanPoints = 20000;
constexpr int kCurveKeys = 24;  // at least, along a smooth curve

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

FieldGrid plan_nodes(const TetMesh& mesh, double step) {
  Eigen::AlignedBox3d box;
  for (const Vec3& node : mesh.nodes) box.extend(node);
  FieldGrid grid;
  grid.low = box.min();
  grid.step = step;
  for (int c = 0; c < 2; ++c)
    grid.count[c] = 1 + static_cast<int>(std::ceil(box.sizes()[c] / step - 1e-9));
  return grid;
}

// The moduli of the regions and the shifts of the boundaries, fitted together.
class BoundaryProblem {
 public:
  BoundaryProblem(const Fit& fitted, const Experiment& experiment, const TetMesh& mesh,
                  const MovingBoundary& boundary, double step, const BoundaryOptions& options)
      : model_(fitted.model),
        dataset_(experiment.dataset),
        selection_(all_episodes(dataset_)),
        boundary_(boundary),
        options_(options),
        contacts_(mesh, experiment.places, dataset_.recording.disc_radius(), material_of(model_).nu,
                  plan_nodes(mesh, step), Memo::kDefaultBudget),
        measured_(measured_forces(dataset_, selection_)),
        weights_(dataset_, selection_, model_forces(fitted, experiment, selection_, false).f,
                 options.fit.noise, options.fit.floor) {
    for (Parameter& p : model_.parameters) {
      if (p.state == ParameterState::kFree && !is_modulus(p)) p.state = ParameterState::kFixed;
    }
    free_ = model_.free_parameters();
  }

  std::vector<Unknown> unknowns() const {
    std::vector<Unknown> result;
    for (const int i : free_) {
      const Parameter& p = model_.parameters[i];
      result.push_back({p.value, std::max(p.lower, 1e-3 * p.value), p.upper, p.value, true});
    }
    const std::vector<Unknown> moving = boundary_.unknowns();
    result.insert(result.end(), moving.begin(), moving.end());
    return result;
  }

  void residuals(const Eigen::VectorXd& x, Eigen::VectorXd& r, Eigen::MatrixXd* J) {
    // One solution gives the forces and their derivatives; the same place is asked for twice.
    if (x_.size() != x.size() || x_ != x) evaluate(x);
    r = r_;
    if (J != nullptr) *J = J_;
  }

  // Of the unknowns at x, their bounds left aside: the noise (or the misfit, where that is larger)
  // and the gain error of each position.
  Eigen::MatrixXd covariance(const Eigen::VectorXd& x) {
    if (x_.size() != x.size() || x_ != x) evaluate(x);
    const Eigen::VectorXd scale =
        J_.colwise().norm().transpose().cwiseMax(std::numeric_limits<double>::min());
    const Eigen::MatrixXd scaled = J_ * scale.cwiseInverse().asDiagonal();
    const Eigen::Index n = x.size();
    const Eigen::MatrixXd inverse =
        (scaled.transpose() * scaled).ldlt().solve(Eigen::MatrixXd::Identity(n, n));
    const double freedom = std::max<double>(1, static_cast<double>(J_.rows() - n));
    return std::max(1.0, r_.squaredNorm() / freedom) * scale.cwiseInverse().asDiagonal() * inverse *
           scale.cwiseInverse().asDiagonal();
  }
  // Derivatives of the forces by the boundary's unknowns at x, stacked rows x unknowns.
  const Eigen::MatrixXd& by_shift(const Eigen::VectorXd& x) {
    if (x_.size() != x.size() || x_ != x) evaluate(x);
    return by_shift_;
  }

  Eigen::VectorXd shifts(const Eigen::VectorXd& x) const {
    return x.tail(x.size() - static_cast<Eigen::Index>(free_.size()));
  }
  // `model` with the moduli of x.
  Model with_moduli(Model model, const Eigen::VectorXd& x) const {
    for (std::size_t c = 0; c < free_.size(); ++c) {
      const Parameter& p = model_.parameters[free_[c]];
      model.find(p.effect, p.region, p.name)->value = x[static_cast<Eigen::Index>(c)];
    }
    return model;
  }

 private:
  void evaluate(const Eigen::VectorXd& x) {
    for (std::size_t c = 0; c < free_.size(); ++c)
      model_.parameters[free_[c]].value = x[static_cast<Eigen::Index>(c)];
    const MaterialSpec material = material_of(model_);
    const FieldGrid& grid = contacts_.grid();
    const auto nodes = static_cast<Eigen::Index>(grid.size());
    const auto unknowns = x.size();
    // log E at the nodes over that of region 0, and its derivative by the unknowns.
    Eigen::VectorXd field(nodes);
    Eigen::MatrixXd by_unknown = Eigen::MatrixXd::Zero(nodes, unknowns);
    const double width = 2 * grid.step;
    const Eigen::VectorXd shift = shifts(x);
    for (Eigen::Index n = 0; n < nodes; ++n) {
      const MovingBoundary::Blend blend =
          boundary_.at(grid.node(static_cast<std::size_t>(n)).head<2>(), shift, width);
      const double left = std::log(material.modulus[blend.left] / material.modulus[0]);
      const double right = std::log(material.modulus[blend.right] / material.modulus[0]);
      field[n] = blend.share * left + (1 - blend.share) * right;
      const auto by_modulus = [&](int region, double share) {
        const int column = material.modulus_column[region];
        if (column >= 0) by_unknown(n, column) += share / material.modulus[region];
      };
      by_modulus(blend.left, blend.share);
      by_modulus(blend.right, 1 - blend.share);
      by_unknown.row(n).tail(shift.size()) += (left - right) * blend.by;
    }
    std::vector<PositionStiffness> stiffness(dataset_.positions.size());
    in_parallel(stiffness.size(), options_.threads, [&](std::size_t p) {
      const FieldContacts::Contact contact = contacts_.at(p, field);
      stiffness[p].K = material.modulus[0] * contact.K();
      const Eigen::MatrixXd change = contact.by_node * by_unknown;
      for (Eigen::Index c = 0; c < unknowns; ++c)
        stiffness[p].add(static_cast<int>(c),
                         material.modulus[0] * contact.change_of(change.col(c)));
      if (options_.progress) options_.progress();
    });
    const Signal signal = model_forces(
        model_, dataset_, [&](std::size_t p) { return stiffness[p]; }, selection_, true,
        options_.threads, shift.size());
    const Eigen::Index rows = measured_.size();
    Eigen::MatrixXd all(rows, 1 + unknowns);
    all.col(0) = signal.f - measured_;
    all.rightCols(unknowns) = signal.df;
    by_shift_ = all.rightCols(shift.size());
    weights_.whiten(all);
    Eigen::VectorXd known;
    Eigen::MatrixXd by_known;
    boundary_.known(shift, known, by_known);
    r_.resize(rows + known.size());
    J_ = Eigen::MatrixXd::Zero(rows + known.size(), unknowns);
    r_.head(rows) = all.col(0);
    J_.topRows(rows) = all.rightCols(unknowns);
    r_.tail(known.size()) = known;
    J_.bottomRightCorner(known.size(), shift.size()) = by_known;
    x_ = x;
  }

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

std::vector<BoundaryLine> boundaries_of(const Model& model, const TetMesh& mesh,
                                        double tool_radius) {
  const MaterialSpec material = material_of(model);
  const PlaneClassifier classify = [&](const PlanPoint& p) {
    return region_at(material, {p.x(), p.y(), 0});
  };
  auto lines = region_boundaries(classify, {}, mesh, kScanPoints);
  std::erase_if(lines, [&](const BoundaryLine& l) { return length(l) < 2 * tool_radius; });
  return lines;
}

// The material with one region, fitted.
Fit homogeneous_fit(const Fit& start, const Experiment& experiment,
                    const BoundaryOptions& options) {
  Model model = start.model;
  std::erase_if(model.parameters,
                [](const Parameter& p) { return is_of_map(p) || (is_modulus(p) && p.region > 0); });
  return fit(model, experiment, all_episodes(experiment.dataset), options.fit);
}

// Two regions with a smooth curve between them, where the positions' own moduli ask for no more
// than that: the regions of `start` are two, or more that explain them no better.
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
  const std::vector<BoundaryLine> before = boundaries_of(start.model, mesh, tool_radius);
  const int keys = std::max(options.key_points, kCurveKeys);
  BoundaryFit result{start, before, {}, {}, false};
  Fit now = plain;
  now.model = with_moduli(plain.model, {curve.log_gain[0], curve.log_gain[1]});
  for (int round = 0; round < options.rounds && !result.fitted.stopped; ++round) {
    std::vector<PlanPoint> nodes;
    const FieldGrid grid = plan_nodes(mesh, 0.5 * tool_radius);
    for (std::size_t n = 0; n < grid.size(); ++n) nodes.emplace_back(grid.node(n).head<2>());
    const MovingCurve moving(curve, nodes, tool_radius);
    BoundaryProblem problem(now, experiment, mesh, moving, grid.step, options);
    LeastSquaresOptions search;
    search.max_iterations = 15;
    search.step_tolerance = 1e-2;
    search.decrease_tolerance = 1e-2;
    if (options.fit.watch)
      search.watch = [&](double) { return options.fit.watch({0, 1, now.error.pooled}); };
    const LeastSquaresResult solution = minimise(
        problem.unknowns(),
        [&](const Eigen::VectorXd& x, Eigen::VectorXd& r, Eigen::MatrixXd* J) {
          problem.residuals(x, r, J);
        },
        search);
    curve.theta = problem.shifts(solution.x);
    const Eigen::MatrixXd covariance =
        problem.covariance(solution.x).bottomRightCorner(curve.theta.size(), curve.theta.size());
    const PlaneClassifier classify = [&](const PlanPoint& p) { return curve.region(p); };
    auto lines = region_boundaries(classify, {}, mesh, kScanPoints);
    std::erase_if(lines, [&](const BoundaryLine& l) { return length(l) < 2 * tool_radius; });
    if (lines.empty()) break;
    Model moved = problem.with_moduli(now.model, solution.x);
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
    std::vector<PlanPoint> where;
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

}  // namespace

BoundaryFit refine_boundaries(const Fit& start, const Experiment& experiment, const TetMesh& mesh,
                              const BoundaryOptions& options) {
  const Dataset& dataset = experiment.dataset;
  const double tool_radius = dataset.recording.disc_radius();
  const double spacing = spacing_of(dataset.positions);
  BoundaryFit result{start, boundaries_of(start.model, mesh, tool_radius), {}, {}, false};
  if (result.lines.empty())
    fail_input(start.model.name, "the model has no boundary between regions on this body",
               "give a model of hs-cluster --write-model, or --add regions");
  Fit plain;
  if (const auto curve = curve_for(start, experiment, options, plain)) {
    BoundaryFit two = refined_curve(start, plain, *curve, experiment, mesh, options);
    if (two.better || two.fitted.stopped || !two.error.empty()) return two;
  }
  const std::vector<BoundaryLine> before = result.lines;
  for (int round = 0; round < options.rounds && !result.fitted.stopped; ++round) {
    const MaterialSpec material = material_of(result.fitted.model);
    const PlaneClassifier classify = [&](const PlanPoint& p) {
      return region_at(material, {p.x(), p.y(), 0});
    };
    const BoundaryGraph graph(result.lines, classify, options.key_points, 4 * tool_radius);
    const ShiftedLines moving(graph, spacing);
    BoundaryProblem problem(result.fitted, experiment, mesh, moving, tool_radius, options);
    LeastSquaresOptions search;
    search.max_iterations = 12;
    search.step_tolerance = 0.1;       // of a tenth of the spacing
    search.decrease_tolerance = 1e-2;  // a tenth of a standard error
    if (options.fit.watch)
      search.watch = [&](double) { return options.fit.watch({0, 1, result.fitted.error.pooled}); };
    const LeastSquaresResult solution = minimise(
        problem.unknowns(),
        [&](const Eigen::VectorXd& x, Eigen::VectorXd& r, Eigen::MatrixXd* J) {
          problem.residuals(x, r, J);
        },
        search);
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
