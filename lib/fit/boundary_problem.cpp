#include "fit/boundary_problem.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "experiment/nearest_region.h"
#include "model/body_parameters.h"
#include "model/model_edit.h"

namespace hapsim {

std::vector<BoundaryLine> long_boundaries(const PlaneClassifier& classify, const TetMesh& mesh,
                                          double tool_radius) {
  constexpr int kScanPoints = 20000;
  auto lines = region_boundaries(classify, {}, mesh, kScanPoints);
  std::erase_if(lines, [&](const BoundaryLine& l) { return length(l) < 2 * tool_radius; });
  return lines;
}

std::vector<BoundaryLine> long_boundaries(const Model& model, const TetMesh& mesh,
                                          double tool_radius) {
  const MaterialSpec material = material_of(model);
  return long_boundaries(
      [&](const Eigen::Vector2d& p) {
        return region_at(material, {p.x(), p.y(), 0});
      },
      mesh, tool_radius);
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

BoundaryProblem::BoundaryProblem(const Fit& fitted, const Model& start,
                                 const Experiment& experiment, const TetMesh& mesh,
                                 const MovingBoundary& boundary, double step,
                                 const BoundaryOptions& options)
    : model_(start),
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

std::vector<Unknown> BoundaryProblem::unknowns() const {
  std::vector<Unknown> result;
  for (const int i : free_) {
    const Parameter& p = model_.parameters[i];
    result.push_back({p.value, std::max(p.lower, 1e-3 * p.value), p.upper, p.value, true});
  }
  const std::vector<Unknown> moving = boundary_.unknowns();
  result.insert(result.end(), moving.begin(), moving.end());
  return result;
}

void BoundaryProblem::residuals(const Eigen::VectorXd& x, Eigen::VectorXd& r, Eigen::MatrixXd* J) {
  // One solution gives the forces and their derivatives; the same place is asked for twice.
  if (x_.size() != x.size() || x_ != x) evaluate(x);
  r = r_;
  if (J != nullptr) *J = J_;
}

Eigen::MatrixXd BoundaryProblem::covariance(const Eigen::VectorXd& x) {
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

const Eigen::MatrixXd& BoundaryProblem::by_shift(const Eigen::VectorXd& x) {
  if (x_.size() != x.size() || x_ != x) evaluate(x);
  return by_shift_;
}

Eigen::VectorXd BoundaryProblem::shifts(const Eigen::VectorXd& x) const {
  return x.tail(x.size() - static_cast<Eigen::Index>(free_.size()));
}

Model BoundaryProblem::with_moduli(Model model, const Eigen::VectorXd& x) const {
  for (std::size_t c = 0; c < free_.size(); ++c) {
    const Parameter& p = model_.parameters[free_[c]];
    model.find(p.effect, p.region, p.name)->value = x[static_cast<Eigen::Index>(c)];
  }
  return model;
}

void BoundaryProblem::evaluate(const Eigen::VectorXd& x) {
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
      stiffness[p].add(static_cast<int>(c), material.modulus[0] * contact.change_of(change.col(c)));
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

LeastSquaresResult BoundaryProblem::minimise(LeastSquaresOptions search, double error) {
  if (options_.fit.watch)
    search.watch = [this, error](double) { return options_.fit.watch({0, 1, error}); };
  return hapsim::minimise(
      unknowns(),
      [this](const Eigen::VectorXd& x, Eigen::VectorXd& r, Eigen::MatrixXd* J) {
        residuals(x, r, J);
      },
      search);
}

}  // namespace hapsim
