// The inside of NonlinearBody, shared by its two files: Newton's method, and contact.
#pragma once

#include <algorithm>
#include <cassert>
#include <cmath>

#include "nonlinear/nonlinear_body.h"
#include "solid/elastic_body.h"

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
    std::size_t first_clique = 0;  // of its hats' in `system`, once `holds`
  };
  std::vector<Tip> tips;
  bool holds = false;  // hold_contact()

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
    if (holds) add_contact_springs();
    return factorised = system.factorise();
  }
  // The tangent, or the least stiffened one that has a way down.
  bool factorise(const SolveOptions& options) {
    if (factorise()) return true;
    if (!tips.empty() && !holds) {
      hold_contact();
      if (factorise()) return true;
    }
    if (!options.past_instability || !tips.empty()) return false;
    for (double share = 1e-4; share < 1; share *= 4) {
      system.clear();
      touched.clear();
      assembly.tangent(system, moved, touched);
      assembly.stiffen(system, share);
      if (system.factorise()) return true;
    }
    return false;
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

  // Contact (nonlinear_contact.cpp). `change`: of u, as the linearised body takes it without the
  // tips' tractions; adds what those do with which the linearised conditions of contact hold. Only
  // hats that may touch take part; the others are looked at afterwards. False: it does not settle.
  bool add_contact(VectorXd& change);
  // The change with tractions on these hats of each tip; empty when they do not settle.
  VectorXd settle_contact(const std::vector<std::vector<Index>>& hats, const VectorXd& change);
  // Fields of unit tractions; a linear body keeps those of all hats.
  MatrixXd fields_of(Tip& tip, const std::vector<Index>& columns);
  void evaluate_tips();
  // A surface under dead tractions turns over as a column does from some pressure on, where under a
  // tool that keeps its place it is stable. From here on springs between tool and body stand in the
  // tangent where hats touch (normal) and stick (tangential): the conditions of contact leave these
  // ways no freedom, so a change that meets them is the same with the springs and without (an
  // augmented Lagrangian's tangent; Wriggers, Computational Contact Mechanics, 2006, 6.3).
  void hold_contact();
  void add_contact_springs();
  // The surfaces touch, or are apart, as they should, in the mean over each hat.
  bool fits() const;
  // With tips there is no energy to search along: whole steps, shorter where an element inverts.
  SolveStatus step_with_tips(VectorXd change);
  // kConverged, unless a contact has left its surface.
  SolveStatus settled() const;

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
    if (!factorise(options)) return SolveStatus::kUnstable;
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
    const int rounds = !tips.empty() ? 2 : options.past_instability ? 4 : 1;
    for (int k = 0; k < rounds * options.newton_limit; ++k) {
      if (balanced(options, before) && fits()) return settled();
      if (!factorise(options)) return SolveStatus::kUnstable;
      ++newton_steps;
      const SolveStatus found = tips.empty()
                                    ? line_search(system.solve(-residual()))
                                    : step_with_tips(system.solve(load - assembly.forces()));
      if (found != SolveStatus::kConverged) return found;
    }
    return balanced(options, before) && fits() ? settled() : SolveStatus::kNoConvergence;
  }
};

}  // namespace hapsim
