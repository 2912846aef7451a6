#include "fem/nonlinear_body.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cassert>
#include <cmath>

#include "fem/coulomb_contact.h"
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
  bool linear = true;          // all laws are of small strain: one tangent for all states
  bool factorised = false;     // the tangent of a linear body is at hand

  struct Tip {
    TipContact contact;
    Vec3 motion = Vec3::Zero(), wanted = Vec3::Zero();
    VectorXd traction;  // 3 hats [Pa]
    // Of a linear body: fields of unit tractions and the compliance of the hats.
    MatrixXd fields;
  };
  std::vector<Tip> tips;

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
    for (const LawPointer& law : model.laws) linear = linear && (!law || law->small_strain());
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
    if (linear && factorised) return true;
    system.clear();
    touched.clear();
    assembly.tangent(system, moved, touched);
    for (Tip& t : tips) t.fields.resize(0, 0);
    return factorised = system.factorise();
  }

  VectorXd residual() const {
    VectorXd r = assembly.forces() - load;
    for (const Tip& t : tips) r -= t.contact.directions() * t.traction;
    return r;
  }
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

  // Columns of a tip's directions() for some hats: the normals alone where there is no friction.
  static std::vector<Index> columns_of(const Tip& t, const std::vector<Index>& hats) {
    std::vector<Index> columns;
    for (const Index h : hats)
      for (Index c = 0; c < (t.contact.tip().friction == 0 ? 1 : 3); ++c)
        columns.push_back(3 * h + c);
    return columns;
  }
  // Fields of unit tractions; a linear body keeps those of all hats.
  MatrixXd fields_of(Tip& t, const std::vector<Index>& columns) {
    if (linear && t.fields.size() == 0) t.fields = system.solve(MatrixXd(t.contact.directions()));
    if (linear) return t.fields(Eigen::all, columns);
    if (columns.empty()) return MatrixXd(u.size(), 0);
    MatrixXd unit(u.size(), static_cast<Index>(columns.size()));
    for (std::size_t c = 0; c < columns.size(); ++c)
      unit.col(static_cast<Index>(c)) = t.contact.directions().col(columns[c]);
    return system.solve(unit);
  }

  // `change`: of u, as the linearised body takes it without the tips' tractions. Adds what those
  // tractions do with which the linearised conditions of contact hold. Only hats that may touch
  // take part; the others are looked at afterwards.
  bool add_contact(VectorXd& change) {
    std::vector<std::vector<Index>> hats(tips.size());
    for (std::size_t k = 0; k < tips.size(); ++k) {
      const VectorXd apart =
          tips[k].contact.apart() + tips[k].contact.directions().transpose() * change;
      for (Index h = 0; h < apart.size() / 3; ++h)
        if (apart[3 * h] < 0 || tips[k].traction[3 * h] > 0) hats[k].push_back(h);
    }
    for (int round = 0; round < 10; ++round) {
      const VectorXd with = settle_contact(hats, change);
      if (with.size() == 0) return false;
      bool all = true;
      for (std::size_t k = 0; k < tips.size(); ++k) {
        const VectorXd apart =
            tips[k].contact.apart() + tips[k].contact.directions().transpose() * with;
        std::vector<Index> next;
        for (Index h = 0; h < apart.size() / 3; ++h)
          if (apart[3 * h] < -1e-9 * tips[k].contact.surface().area[h] * tips[k].contact.give() ||
              std::binary_search(hats[k].begin(), hats[k].end(), h))
            next.push_back(h);
        all = all && next.size() == hats[k].size();
        hats[k] = next;
      }
      if (!all) continue;
      change = with;
      return true;
    }
    return false;
  }
  // The change with tractions on these hats; empty when they do not settle.
  VectorXd settle_contact(const std::vector<std::vector<Index>>& hats, const VectorXd& change) {
    Index places = 0;
    for (const auto& h : hats) places += static_cast<Index>(h.size());
    if (places == 0) {
      for (Tip& t : tips) t.traction.setZero();
      return change;
    }
    MatrixXd compliance = MatrixXd::Identity(3 * places, 3 * places);
    VectorXd apart = VectorXd::Zero(3 * places), traction = apart;
    std::vector<double> friction;
    std::vector<MatrixXd> fields;
    std::vector<std::vector<Index>> columns;
    std::vector<std::vector<Index>> rows;  // of the dense problem, as `columns`
    for (std::size_t k = 0; k < tips.size(); ++k) {
      Tip& t = tips[k];
      const Index first = static_cast<Index>(friction.size());
      friction.insert(friction.end(), hats[k].size(), t.contact.tip().friction);
      columns.push_back(columns_of(t, hats[k]));
      fields.push_back(fields_of(t, columns.back()));
      rows.emplace_back();
      const Index parts = t.contact.tip().friction == 0 ? 1 : 3;
      for (std::size_t c = 0; c < columns[k].size(); ++c) {
        const Index i = static_cast<Index>(c);
        rows[k].push_back(3 * (first + i / parts) + i % parts);
      }
      const VectorXd w = t.contact.apart() + t.contact.directions().transpose() * change;
      apart(rows[k]) = w(columns[k]);
      traction(rows[k]) = t.traction(columns[k]);
    }
    for (std::size_t a = 0; a < tips.size(); ++a)
      for (std::size_t b = 0; b < tips.size(); ++b) {
        const MatrixXd all = tips[a].contact.directions().transpose() * fields[b];
        compliance(rows[a], rows[b]) = all(columns[a], Eigen::all);
      }
    compliance = (0.5 * (compliance + compliance.transpose())).eval();
    if (!solve_coulomb_contact(compliance, apart, friction, traction)) return {};
    VectorXd with = change;
    for (std::size_t k = 0; k < tips.size(); ++k) {
      const VectorXd p = traction(rows[k]);
      tips[k].traction.setZero();
      tips[k].traction(columns[k]) = p;
      with += fields[k] * p;
    }
    return with;
  }
  void evaluate_tips() {
    for (Tip& t : tips) t.contact.evaluate(u, t.motion);
  }
  // The surfaces touch, or are apart, as they should, in the mean over each hat.
  bool fits() const {
    for (const Tip& t : tips) {
      const double allowed = 1e-9 * t.contact.give() + 1e-14 * t.contact.tip().reach;
      for (Index i = 0; i < t.traction.size() / 3; ++i) {
        const double gap = t.contact.apart()[3 * i] / t.contact.surface().area[i];
        if ((t.traction[3 * i] > 0 ? std::abs(gap) : -gap) > allowed) return false;
      }
    }
    return true;
  }

  // With tips there is no energy to search along: whole steps, shorter where an element inverts.
  SolveStatus step_with_tips(VectorXd change) {
    if (!add_contact(change)) return SolveStatus::kNoConvergence;
    const VectorXd start = u;
    for (double share = 1; share > 0.05; share /= 2) {
      u = start + share * change;
      if (!assembly.set_state(u)) continue;
      evaluate_tips();
      return SolveStatus::kConverged;
    }
    return SolveStatus::kInverted;
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
    double before = std::max(norms().constrained, new_load.norm());
    for (const Tip& t : tips)
      before = std::max(before, (t.contact.directions() * t.traction).norm());
    load = new_load;
    ++newton_steps;
    if (tips.empty()) {
      u += field + system.solve(-residual() - times_touched(field));
      if (!assembly.set_state(u)) return SolveStatus::kInverted;
    } else {
      evaluate_tips();
      const SolveStatus found =
          step_with_tips(field + system.solve(load - assembly.forces() - times_touched(field)));
      if (found != SolveStatus::kConverged) return found;
    }
    for (int k = 0; k < (tips.empty() ? 1 : 2) * options.newton_limit; ++k) {
      if (balanced(options, before) && fits()) return settled();
      if (!factorise()) return SolveStatus::kUnstable;
      ++newton_steps;
      const SolveStatus found = tips.empty()
                                    ? line_search(system.solve(-residual()))
                                    : step_with_tips(system.solve(load - assembly.forces()));
      if (found != SolveStatus::kConverged) return found;
    }
    return balanced(options, before) && fits() ? settled() : SolveStatus::kNoConvergence;
  }
  SolveStatus settled() const {
    for (const Tip& t : tips)
      if (t.contact.at_rim(t.traction)) return SolveStatus::kOffSurface;
    return SolveStatus::kConverged;
  }
};

namespace {

std::string explain(SolveStatus status, double reached) {
  const char* what =
      status == SolveStatus::kUnstable
          ? "the stiffness is not positive definite there (the body buckles, nothing "
            "holds it, or its material softens)"
      : status == SolveStatus::kInverted ? "an element turns inside out there"
      : status == SolveStatus::kOffSurface
          ? "the contact reaches the edge of the surface under the tip"
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
  const State first = state();
  double done = 0, step = 1;
  while (done < 1) {
    const State before = state();
    const double next = std::min(1.0, done + step);
    const auto there = [next](const auto& from, const auto& to) {
      return (from + next * (to - from)).eval();
    };
    for (std::size_t t = 0; t < body.tips.size(); ++t) {
      body.tips[t].contact.mark(body.u, body.tips[t].motion);
      body.tips[t].motion = there(first.motion[t], body.tips[t].wanted);
    }
    body.prescribed = there(first.prescribed, prescribed);
    const SolveStatus status =
        body.step(body.prescribed - before.prescribed, there(first.load, body.wanted_load), options,
                  report.newton_steps);
    if (status == SolveStatus::kConverged) {
      ++report.load_steps;
      done = next;
      step *= 2;
      continue;
    }
    restore(before);
    step = (next - done) / 2;
    if (step >= options.least_step && status != SolveStatus::kOffSurface) continue;
    report.status = status;
    report.reached = done;
    report.message = explain(status, done);
    break;
  }
  return report;
}

NonlinearBody::State NonlinearBody::state() const {
  State s{impl_->u, impl_->prescribed, impl_->load, {}, {}};
  for (const Impl::Tip& t : impl_->tips) {
    s.traction.push_back(t.traction);
    s.motion.push_back(t.motion);
  }
  return s;
}

void NonlinearBody::restore(const State& s) {
  Impl& body = *impl_;
  body.u = s.u;
  body.prescribed = s.prescribed;
  body.load = s.load;
  for (std::size_t t = 0; t < body.tips.size(); ++t) {
    body.tips[t].traction = s.traction[t];
    body.tips[t].motion = s.motion[t];
  }
  body.assembly.set_state(body.u);
  body.evaluate_tips();
}

int NonlinearBody::add_tip(const SphericalTip& tip) {
  Impl& body = *impl_;
  body.tips.push_back({TipContact(body.assembly.mesh(), tip, body.linear)});
  body.tips.back().traction = VectorXd::Zero(3 * body.tips.back().contact.hats());
  return tips() - 1;
}
int NonlinearBody::tips() const {
  return static_cast<int>(impl_->tips.size());
}
void NonlinearBody::move_tip(int tip, const Vec3& motion) {
  impl_->tips[static_cast<std::size_t>(tip)].wanted = motion;
}
Vec3 NonlinearBody::tip_motion(int tip) const {
  return impl_->tips[static_cast<std::size_t>(tip)].motion;
}
Vec3 NonlinearBody::tip_force(int tip) const {
  const Impl::Tip& t = impl_->tips[static_cast<std::size_t>(tip)];
  return t.contact.force(t.traction);
}
double NonlinearBody::contact_radius(int tip) const {
  const Impl::Tip& t = impl_->tips[static_cast<std::size_t>(tip)];
  return t.contact.contact_radius(t.traction);
}

void NonlinearBody::set_added(PointStresses added) {
  impl_->assembly.set_added(std::move(added));
  impl_->assembly.set_state(impl_->u);
}
PointStresses NonlinearBody::elastic_stresses() const {
  return impl_->assembly.elastic_stresses();
}

void NonlinearBody::set_laws(const std::vector<LawPointer>& laws) {
  impl_->assembly.set_laws(laws);
  impl_->factorised = false;
  impl_->assembly.set_state(impl_->u);
}

void NonlinearBody::set_scale(const std::vector<double>& scale) {
  impl_->assembly.set_scale(scale);
  impl_->factorised = false;
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
  for (Impl::Tip& t : impl_->tips) {
    t.traction.setZero();
    t.motion.setZero();
  }
  impl_->evaluate_tips();
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

void NonlinearBody::laws_of_stresses(std::vector<int>& of_point, std::vector<int>& of_group) const {
  impl_->assembly.laws_of_stresses(of_point, of_group);
}
ElementFields NonlinearBody::element_fields() const {
  return impl_->assembly.element_fields();
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
