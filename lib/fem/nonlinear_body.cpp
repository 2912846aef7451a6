#include "fem/nonlinear_body.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cassert>
#include <cmath>

#include "fem/elastic_body.h"

namespace hapsim {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

struct NonlinearBody::Impl {
  BodyAssembly assembly;
  std::vector<int> handle;
  int handles = 0;
  std::vector<char> moved;  // 1: on a handle
  NodeSystem system;
  std::vector<BodyAssembly::CliqueMatrix> touched;
  VectorXd u, prescribed;
  VectorXd load, wanted_load;  // dead loads now and at the end of the next solve()

  static std::vector<char> free_nodes(const std::vector<int>& handle) {
    std::vector<char> free;
    for (const int h : handle) free.push_back(h == kFreeNode);
    return free;
  }

  Impl(const BodyModel& model, const std::vector<int>& node_handle)
      : assembly(model), handle(node_handle), system(free_nodes(node_handle), assembly.cliques()) {
    assert(handle.size() == model.mesh->nodes.size());
    for (const int h : handle) {
      handles = std::max(handles, h + 1);
      moved.push_back(h >= 0);
    }
    u = VectorXd::Zero(3 * static_cast<Index>(handle.size()));
    prescribed = VectorXd::Zero(3 * handles);
    load = wanted_load = VectorXd::Zero(u.size());
    assembly.set_state(u);
  }

  // The handles' displacements (3 handles x m) as a field that is zero elsewhere.
  MatrixXd spread(const MatrixXd& by_handle) const {
    MatrixXd field = MatrixXd::Zero(u.size(), by_handle.cols());
    for (std::size_t n = 0; n < handle.size(); ++n)
      if (handle[n] >= 0)
        field.middleRows(3 * static_cast<Index>(n), 3) = by_handle.middleRows(3 * handle[n], 3);
    return field;
  }
  MatrixXd gather(const MatrixXd& field) const {
    MatrixXd sum = MatrixXd::Zero(3 * handles, field.cols());
    for (std::size_t n = 0; n < handle.size(); ++n)
      if (handle[n] >= 0)
        sum.middleRows(3 * handle[n], 3) += field.middleRows(3 * static_cast<Index>(n), 3);
    return sum;
  }
  // Tangent times field, of the cliques that touch a handle.
  MatrixXd times_touched(const MatrixXd& field) const {
    MatrixXd result = MatrixXd::Zero(field.rows(), field.cols());
    for (const auto& [clique, K] : touched) {
      const int count = system.cliques().count(clique);
      const int* nodes = system.cliques().nodes(clique);
      MatrixXd local(3 * count, field.cols());
      for (int a = 0; a < count; ++a)
        local.middleRows(3 * a, 3) = field.middleRows(3 * nodes[a], 3);
      local = (K * local).eval();
      for (int a = 0; a < count; ++a)
        result.middleRows(3 * nodes[a], 3) += local.middleRows(3 * a, 3);
    }
    return result;
  }
  bool factorise() {
    system.clear();
    touched.clear();
    assembly.tangent(system, moved, touched);
    return system.factorise();
  }

  VectorXd residual() const { return assembly.forces() - load; }
  double potential() const { return assembly.energy() - load.dot(u); }

  // Norms of the forces on the free and on the other nodes.
  struct Norms {
    double free, constrained;
  };
  Norms norms() const {
    Norms n{0, 0};
    const VectorXd r = residual();
    for (std::size_t i = 0; i < handle.size(); ++i) {
      const double s = r.segment<3>(3 * static_cast<Index>(i)).squaredNorm();
      (system.is_free(static_cast<int>(i)) ? n.free : n.constrained) += s;
    }
    return {std::sqrt(n.free), std::sqrt(n.constrained)};
  }
  // `before`: the constrained forces at the start of the load step, which a press that returns to
  // the undeformed body is judged by.
  bool balanced(const SolveOptions& options, double before) const {
    const Norms n = norms();
    const double rounding = 1e-15 * assembly.force_unit();
    return n.free <= options.tolerance * std::max(n.constrained, before) + rounding;
  }

  SolveStatus line_search(const VectorXd& direction) {
    const VectorXd start = u;
    const double energy = potential(), before = norms().free;
    const double slope = residual().dot(direction);
    SolveStatus why = SolveStatus::kInverted;
    for (double share = 1; share > 0.02; share /= 2) {
      u = start + share * direction;
      if (!assembly.set_state(u)) continue;
      why = SolveStatus::kNoConvergence;
      // Close to the solution the energy's decrease drowns in rounding; there the forces decide.
      if (potential() <= energy + 1e-4 * share * slope || norms().free < 0.5 * before)
        return SolveStatus::kConverged;
    }
    u = start;
    assembly.set_state(u);
    return why;
  }

  // One load step: predictor along the tangent, then Newton's method.
  SolveStatus step(const VectorXd& change, const VectorXd& new_load, const SolveOptions& options,
                   int& newton_steps) {
    if (!factorise()) return SolveStatus::kUnstable;
    const MatrixXd field = spread(change);
    const double before = std::max(norms().constrained, new_load.norm());
    load = new_load;
    ++newton_steps;
    u += field + system.solve(-residual() - times_touched(field));
    if (!assembly.set_state(u)) return SolveStatus::kInverted;
    for (int k = 0; k < options.newton_limit; ++k) {
      if (balanced(options, before)) return SolveStatus::kConverged;
      if (!factorise()) return SolveStatus::kUnstable;
      ++newton_steps;
      const SolveStatus found = line_search(system.solve(-residual()));
      if (found != SolveStatus::kConverged) return found;
    }
    return balanced(options, before) ? SolveStatus::kConverged : SolveStatus::kNoConvergence;
  }
};

namespace {

std::string explain(SolveStatus status, double reached) {
  const char* what =
      status == SolveStatus::kUnstable
          ? "the stiffness is not positive definite there (the body buckles, nothing "
            "holds it, or its material softens)"
      : status == SolveStatus::kInverted ? "an element turns inside out there"
                                         : "Newton's method does not settle there";
  return fmt::format(
      "the body was deformed to {:.3g} % of the displacement only: {}; press less deep, or use a "
      "finer or smoother mesh",
      100 * reached, what);
}

}  // namespace

NonlinearBody::NonlinearBody(const BodyModel& model, const std::vector<int>& handle)
    : impl_(std::make_unique<Impl>(model, handle)) {}

NonlinearBody::~NonlinearBody() = default;

SolveReport NonlinearBody::solve(const VectorXd& prescribed, const SolveOptions& options) {
  Impl& body = *impl_;
  assert(prescribed.size() == 3 * body.handles);
  SolveReport report;
  const VectorXd from = body.prescribed, way = prescribed - from;
  const VectorXd first_load = body.load;
  double done = 0, step = 1;
  while (done < 1) {
    const VectorXd u = body.u;
    const double next = std::min(1.0, done + step);
    const VectorXd load = first_load + next * (body.wanted_load - first_load), before = body.load;
    const SolveStatus status = body.step((next - done) * way, load, options, report.newton_steps);
    if (status == SolveStatus::kConverged) {
      ++report.load_steps;
      done = next;
      step *= 2;
      continue;
    }
    body.u = u;
    body.load = before;
    body.assembly.set_state(u);
    step = (next - done) / 2;
    if (step >= options.least_step) continue;
    report.status = status;
    report.reached = done;
    report.message = explain(status, done);
    break;
  }
  body.prescribed = done < 1 ? VectorXd(from + done * way) : prescribed;
  return report;
}

void NonlinearBody::set_laws(const std::vector<LawPointer>& laws) {
  impl_->assembly.set_laws(laws);
  impl_->assembly.set_state(impl_->u);
}

void NonlinearBody::set_scale(const std::vector<double>& scale) {
  impl_->assembly.set_scale(scale);
  impl_->assembly.set_state(impl_->u);
}

void NonlinearBody::set_load(const VectorXd& nodal) {
  assert(nodal.size() == impl_->u.size());
  impl_->wanted_load = nodal;
}

void NonlinearBody::reset() {
  impl_->load.setZero();
  impl_->u.setZero();
  impl_->prescribed.setZero();
  impl_->assembly.set_state(impl_->u);
}

int NonlinearBody::handles() const {
  return impl_->handles;
}
int NonlinearBody::unknowns() const {
  return impl_->system.unknowns();
}
double NonlinearBody::energy() const {
  return impl_->assembly.energy();
}
const VectorXd& NonlinearBody::field() const {
  return impl_->u;
}
const VectorXd& NonlinearBody::nodal_forces() const {
  return impl_->assembly.forces();
}
VectorXd NonlinearBody::reaction() const {
  return impl_->gather(impl_->assembly.forces());
}

NonlinearBody::Linearisation NonlinearBody::linearise(bool by_scale) {
  Impl& body = *impl_;
  Linearisation result;
  result.stable = body.factorise();
  if (!result.stable) return result;
  // Fields of unit displacements of the handles: phi = (1 on the handle, -K_ff^-1 K_fh inside).
  MatrixXd phi = body.spread(MatrixXd::Identity(3 * body.handles, 3 * body.handles));
  phi += body.system.solve(-body.times_touched(phi));
  result.K = body.gather(body.times_touched(phi));
  // d reaction / dc = phi' d forces / dc: the free nodes' part is the adjoint solution.
  BodyAssembly::Derivatives d = body.assembly.derivatives(phi, by_scale);
  result.by_constants = std::move(d.constants);
  result.by_foundation = std::move(d.foundation);
  result.by_scale = std::move(d.scale);
  result.fields = std::move(phi);
  return result;
}

}  // namespace hapsim
