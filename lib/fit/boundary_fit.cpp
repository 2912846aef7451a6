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
#include "imaging/field_contacts.h"
#include "model/body_parameters.h"
#include "model/model_edit.h"
#include "regions/region_map.h"

namespace hapsim {
namespace {

using PlanPoint = Eigen::Vector2d;

constexpr int kScanPoints = 20000;

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
                  const BoundaryGraph& graph, double spacing, const BoundaryOptions& options)
      : model_(fitted.model),
        dataset_(experiment.dataset),
        selection_(all_episodes(dataset_)),
        graph_(graph),
        spacing_(spacing),
        options_(options),
        contacts_(mesh, experiment.places, dataset_.recording.disc_radius(), material_of(model_).nu,
                  plan_nodes(mesh, dataset_.recording.disc_radius()), Memo::kDefaultBudget),
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
    for (std::size_t k = 0; k < graph_.size(); ++k)
      result.push_back({0, -spacing_, spacing_, 0.1 * spacing_, false});
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
  // Derivatives of the forces by the shifts at x, stacked rows x shifts [N/m].
  const Eigen::MatrixXd& by_shift(const Eigen::VectorXd& x) {
    if (x_.size() != x.size() || x_ != x) evaluate(x);
    return by_shift_;
  }

  Eigen::VectorXd shifts(const Eigen::VectorXd& x) const {
    return x.tail(static_cast<Eigen::Index>(graph_.size()));
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
    for (Eigen::Index n = 0; n < nodes; ++n) {
      const auto blend =
          graph_.at(grid.node(static_cast<std::size_t>(n)).head<2>(), shifts(x), width);
      const double left = std::log(material.modulus[blend.left] / material.modulus[0]);
      const double right = std::log(material.modulus[blend.right] / material.modulus[0]);
      field[n] = blend.share * left + (1 - blend.share) * right;
      const auto by_modulus = [&](int region, double share) {
        const int column = material.modulus_column[region];
        if (column >= 0) by_unknown(n, column) += share / material.modulus[region];
      };
      by_modulus(blend.left, blend.share);
      by_modulus(blend.right, 1 - blend.share);
      for (int k = 0; k < 2; ++k)
        by_unknown(n, static_cast<Eigen::Index>(free_.size() + blend.key[k])) +=
            blend.by_shift[k] * (left - right);
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
        options_.threads, static_cast<Eigen::Index>(graph_.size()));
    const Eigen::Index rows = measured_.size();
    const auto shifted = static_cast<Eigen::Index>(graph_.size());
    Eigen::MatrixXd all(rows, 1 + unknowns);
    all.col(0) = signal.f - measured_;
    all.rightCols(unknowns) = signal.df;
    by_shift_ = all.rightCols(shifted);
    weights_.whiten(all);
    r_.resize(rows + shifted);
    J_ = Eigen::MatrixXd::Zero(rows + shifted, unknowns);
    r_.head(rows) = all.col(0);
    J_.topRows(rows) = all.rightCols(unknowns);
    const double known = 0.5 * spacing_;
    r_.tail(shifted) = shifts(x) / known;
    J_.bottomRightCorner(shifted, shifted).diagonal().setConstant(1 / known);
    x_ = x;
  }

  Model model_;
  const Dataset& dataset_;
  Selection selection_;
  const BoundaryGraph& graph_;
  double spacing_;
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
  const std::vector<BoundaryLine> before = result.lines;
  for (int round = 0; round < options.rounds && !result.fitted.stopped; ++round) {
    const MaterialSpec material = material_of(result.fitted.model);
    const PlaneClassifier classify = [&](const PlanPoint& p) {
      return region_at(material, {p.x(), p.y(), 0});
    };
    const BoundaryGraph graph(result.lines, classify, options.key_points, 4 * tool_radius);
    BoundaryProblem problem(result.fitted, experiment, mesh, graph, spacing, options);
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
