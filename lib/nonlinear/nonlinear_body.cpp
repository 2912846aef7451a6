#include "nonlinear/nonlinear_body.h"

#include <fmt/format.h>

#include <Eigen/Dense>

#include "nonlinear/nonlinear_body_impl.h"

namespace hapsim {
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

StressResponse NonlinearBody::stress_response(const MatrixXd& fields, const MatrixXd& inside,
                                              const StressPart& part) const {
  const Impl& body = *impl_;
  const Index m = fields.cols(), more = inside.cols();
  if (more == 0) return body.assembly.stress_response(fields, part);
  MatrixXd both(body.u.size(), m + more);
  both << fields, inside;
  StressResponse result = body.assembly.stress_response(both, part);
  result.inside_changes = result.changes.rightCols(more);
  result.inside_work = result.work.rightCols(more);
  result.changes.conservativeResize(Eigen::NoChange, m);
  result.work.conservativeResize(Eigen::NoChange, m);
  // Exact for forces of second degree, as those of S; of the pressure's to rounding for a small h.
  if (part.index + 1 < part.count) return result;
  const double h = 0.01;
  const VectorXd stress = body.assembly.elastic_stresses().numbers();
  result.inside_stressed.resize(more, more);
  for (Index k = 0; k < more; ++k) {
    const VectorXd by = h * inside.col(k);
    const VectorXd change =
        body.assembly.forces_of(stress, body.u + by) - body.assembly.forces_of(stress, body.u - by);
    result.inside_stressed.col(k) = inside.transpose() * change / (2 * h);
  }
  return result;
}

MatrixXd NonlinearBody::moved_inside(const MatrixXd& stresses) const {
  const Impl& body = *impl_;
  MatrixXd load(body.u.size(), stresses.cols());
  for (Index c = 0; c < stresses.cols(); ++c)
    load.col(c) = -body.assembly.forces_of(stresses.col(c), body.u);
  return body.system.solve(load);
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
