#include "nonlinear/tool_body.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cassert>
#include <cmath>

#include "base/error.h"
#include "material/maxwell_memory.h"
#include "solid/elastic_body.h"

namespace hapsim {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kRounding = 1e-12;  // of the largest force

struct ToolBody::Impl {
  std::vector<BodyTool> tools;
  std::vector<int> number;                          // of each tool: its handle or its tip
  std::vector<std::vector<Relaxation>> relaxation;  // by law
  std::size_t terms = 0;
  std::vector<int> law_of_tet, law_of_point, law_of_group;
  std::vector<double> scale;   // one a tetrahedron
  std::vector<double> factor;  // by law: 1 + sum of share c of the step at hand
  NonlinearBody body;
  SolveOptions options;
  State now;
  MatrixXd
      compliance;  // of the freedoms under force control, by Broyden's method; empty: not known
  double most_force = 0;  // of any tool until now [N]

  static std::vector<int> handles(const TetMesh& mesh, const std::vector<BodyTool>& tools,
                                  bool free_base) {
    std::vector<int> handle(mesh.nodes.size(), kFreeNode);
    for (std::size_t n = 0; n < handle.size(); ++n)
      if (mesh.fixed[n] && !free_base) handle[n] = kHeldNode;
    int count = 0;
    for (const BodyTool& t : tools) {
      if (t.tip) continue;
      if (t.nodes.empty())
        fail_input("", "no node of the body lies under a tool", "refine the mesh there");
      for (const int n : t.nodes) handle[n] = count;
      ++count;
    }
    return handle;
  }

  Impl(const BodyModel& model, const std::vector<BodyTool>& given,
       const std::vector<std::vector<Relaxation>>& terms_of_law, bool free_base)
      : tools(given),
        relaxation(terms_of_law),
        law_of_tet(model.law_of_tet.empty() ? model.mesh->region : model.law_of_tet),
        scale(model.scale.empty() ? std::vector<double>(model.mesh->tets.size(), 1.0)
                                  : model.scale),
        body(model, handles(*model.mesh, given, free_base)) {
    int handle = 0;
    for (const BodyTool& t : tools) number.push_back(t.tip ? body.add_tip(*t.tip) : handle++);
    relaxation.resize(model.laws.size());
    for (const auto& r : relaxation) terms = std::max(terms, r.size());
    factor.assign(model.laws.size(), 1.0);
    now.body = body.state();
    now.motion.assign(tools.size(), Vec3::Zero());
    now.force = now.motion;
    if (terms == 0) return;
    body.laws_of_stresses(law_of_point, law_of_group);
    now.elastic = body.elastic_stresses();
    now.memory.assign(terms, now.elastic);  // zero: the body is undeformed
  }

  // The stress at the end of a step is factor S_e + sum_k (a H_k - share c S_e of its start).
  void prepare(double dt) {
    if (terms == 0) return;
    std::vector<double> factors(relaxation.size(), 1.0);
    PointStresses added = now.elastic;
    for (Voigt& s : added.S) s.setZero();
    for (double& p : added.pressure) p = 0;
    for (std::size_t k = 0; k < terms; ++k) {
      const auto by_law = coefficients(k, dt);
      for (std::size_t l = 0; l < factors.size(); ++l) factors[l] += by_law[l].second;
      for (std::size_t i = 0; i < added.S.size(); ++i) {
        const auto [a, c] = by_law[law_of_point[i]];
        added.S[i] += a * now.memory[k].S[i] - c * now.elastic.S[i];
      }
      for (std::size_t g = 0; g < added.pressure.size(); ++g) {
        const auto [a, c] = by_law[law_of_group[g]];
        added.pressure[g] += a * now.memory[k].pressure[g] - c * now.elastic.pressure[g];
      }
    }
    if (factors != factor) {
      factor = factors;
      std::vector<double> all = scale;
      for (std::size_t t = 0; t < all.size(); ++t) all[t] *= factor[law_of_tet[t]];
      body.set_scale(all);
    }
    body.set_added(std::move(added));
  }
  // a and share c of term k in each law.
  std::vector<std::pair<double, double>> coefficients(std::size_t k, double dt) const {
    std::vector<std::pair<double, double>> result;
    for (const auto& r : relaxation) {
      if (k >= r.size()) {
        result.emplace_back(1, 0);
        continue;
      }
      const MemoryStep m = memory_step(dt, r[k].tau);
      result.emplace_back(m.a, r[k].share * m.c);
    }
    return result;
  }

  // The step's history, once it is accepted.
  void commit(const std::vector<Vec3>& motion, double dt) {
    now.body = body.state();
    now.motion = motion;
    for (std::size_t t = 0; t < tools.size(); ++t) {
      now.force[t] = force(t);
      most_force = std::max(most_force, now.force[t].norm());
    }
    if (terms == 0) return;
    PointStresses elastic = body.elastic_stresses();
    for (std::size_t i = 0; i < elastic.S.size(); ++i) elastic.S[i] /= factor[law_of_point[i]];
    for (std::size_t g = 0; g < elastic.pressure.size(); ++g)
      elastic.pressure[g] /= factor[law_of_group[g]];
    for (std::size_t k = 0; k < terms; ++k) {
      const auto by_law = coefficients(k, dt);
      for (std::size_t i = 0; i < elastic.S.size(); ++i) {
        const auto [a, c] = by_law[law_of_point[i]];
        now.memory[k].S[i] = a * now.memory[k].S[i] + c * (elastic.S[i] - now.elastic.S[i]);
      }
      for (std::size_t g = 0; g < elastic.pressure.size(); ++g) {
        const auto [a, c] = by_law[law_of_group[g]];
        now.memory[k].pressure[g] =
            a * now.memory[k].pressure[g] + c * (elastic.pressure[g] - now.elastic.pressure[g]);
      }
    }
    now.elastic = std::move(elastic);
  }

  Vec3 force(std::size_t tool) const {
    return tools[tool].tip ? Vec3(-body.tip_force(number[tool]))
                           : Vec3(-body.reaction().segment<3>(3 * number[tool]));
  }

  // From the present state to these places.
  SolveReport move(const std::vector<Vec3>& motion) {
    body.restore(now.body);
    VectorXd prescribed(3 * body.handles());
    for (std::size_t t = 0; t < tools.size(); ++t) {
      if (tools[t].tip)
        body.move_tip(number[t], motion[t]);
      else
        prescribed.segment<3>(3 * number[t]) = motion[t];
    }
    return body.solve(prescribed, options);
  }

  // A part of the motion that follows a force.
  struct Freedom {
    std::size_t tool;
    Vec3 direction;
  };
  // All three of a tool; only the normal's of a tip without friction, which bears nothing sideways.
  std::vector<Freedom> freedoms(const std::vector<int>& which, bool normals_alone) const {
    std::vector<Freedom> all;
    for (const int t : which) {
      const auto& tip = tools[static_cast<std::size_t>(t)].tip;
      if (tip && (normals_alone || tip->friction == 0))
        all.push_back({static_cast<std::size_t>(t), tip->normal.normalized()});
      else
        for (int c = 0; c < 3; ++c) all.push_back({static_cast<std::size_t>(t), Vec3::Unit(c)});
    }
    return all;
  }
  VectorXd forces(const std::vector<Freedom>& free) const {
    VectorXd f(static_cast<Index>(free.size()));
    for (std::size_t k = 0; k < free.size(); ++k)
      f[static_cast<Index>(k)] = force(free[k].tool).dot(free[k].direction);
    return f;
  }
  static void add(std::vector<Vec3>& motion, const std::vector<Freedom>& free, const VectorXd& by) {
    for (std::size_t k = 0; k < free.size(); ++k)
      motion[free[k].tool] += by[static_cast<Index>(k)] * free[k].direction;
  }

  // Finds the places at which the tools `which` bear the forces `wanted`.
  SolveReport press(std::vector<Vec3>& motion, const std::vector<int>& which,
                    const std::vector<ToolTarget>& targets) {
    SolveReport report = move(motion);
    if (!report.ok()) return report;
    // A tip that does not touch has no stiffness to start from: down until it touches.
    for (const int t : which) {
      const auto tool = static_cast<std::size_t>(t);
      const auto& tip = tools[tool].tip;
      if (!tip || targets[tool].value.norm() == 0) continue;
      Vec3& place = motion[tool];
      if (force(tool).norm() == 0) place -= place.dot(tip->normal) * tip->normal;
      for (double deeper = 1e-3 * tip->reach; force(tool).norm() == 0 && deeper < tip->reach;
           deeper *= 2) {
        place -= deeper * tip->normal;
        if (!(report = move(motion)).ok()) return report;
      }
    }
    // First how deep: a tip that barely touches slips, and has no stiffness sideways.
    report = press(motion, freedoms(which, true), targets, 1e-2);
    if (!report.ok()) return report;
    return press(motion, freedoms(which, false), targets, body.tips() > 0 ? 1e-7 : 1e-8);
  }
  SolveReport press(std::vector<Vec3>& motion, const std::vector<Freedom>& free,
                    const std::vector<ToolTarget>& targets, double tolerance) {
    VectorXd wanted(static_cast<Index>(free.size()));
    for (std::size_t k = 0; k < free.size(); ++k)
      wanted[static_cast<Index>(k)] = targets[free[k].tool].value.dot(free[k].direction);
    SolveReport report = move(motion);
    if (!report.ok()) return report;
    VectorXd rest = wanted - forces(free);
    double largest = most_force;
    for (std::size_t t = 0; t < tools.size(); ++t) largest = std::max(largest, force(t).norm());
    const double allowed = tolerance * wanted.norm() + kRounding * largest;
    if (compliance.rows() != static_cast<Index>(free.size()) &&
        !(report = probe(motion, free)).ok())
      return report;
    for (int k = 0; k < 60; ++k) {
      if (rest.norm() <= allowed) return report;
      if (k % 15 == 14 && !(report = probe(motion, free)).ok()) return report;
      VectorXd by = compliance * rest;
      bool moved = false;
      for (int halving = 0; halving < 12 && !moved; ++halving, by /= 2) {
        std::vector<Vec3> there = motion;
        add(there, free, by);
        report = move(there);
        if (!report.ok()) continue;
        const VectorXd next = wanted - forces(free);
        if (!(next.norm() < (1 - 1e-3) * rest.norm())) continue;
        const VectorXd change = rest - next;  // of the force
        const VectorXd back = compliance.transpose() * by;
        if (std::abs(back.dot(change)) > 1e-300)
          compliance += (by - compliance * change) * back.transpose() / back.dot(change);
        motion = there;
        rest = next;
        moved = true;
      }
      if (!moved && !(report = probe(motion, free)).ok()) return report;
    }
    report.status = SolveStatus::kNoConvergence;
    report.reached = 0;
    report.message = fmt::format(
        "no place of the tool bears the given force, the nearest found leaves {:.2g} of it; press "
        "less hard or in smaller steps, or check that the force points out of the body",
        rest.norm() / wanted.norm());
    return report;
  }
  // The compliance by small moves of each tool along each axis.
  SolveReport probe(const std::vector<Vec3>& motion, const std::vector<Freedom>& free) {
    const Index size = static_cast<Index>(free.size());
    SolveReport report = move(motion);
    if (!report.ok()) return report;
    const VectorXd here = forces(free);
    MatrixXd K(size, size);
    const double h = 1e-6 * body_size;
    for (Index c = 0; c < size; ++c) {
      std::vector<Vec3> there = motion;
      add(there, free, h * VectorXd::Unit(size, c));
      if (!(report = move(there)).ok()) return report;
      K.col(c) = (forces(free) - here) / h;
    }
    compliance = Eigen::CompleteOrthogonalDecomposition<MatrixXd>(K).pseudoInverse();
    return move(motion);
  }
  double body_size = 0;  // [m]
};

ToolBody::ToolBody(const BodyModel& model, const std::vector<BodyTool>& tools,
                   const std::vector<std::vector<Relaxation>>& relaxation, bool free_base)
    : impl_(std::make_unique<Impl>(model, tools, relaxation, free_base)) {
  impl_->body_size = std::cbrt(volume(*model.mesh));
}

ToolBody::~ToolBody() = default;

SolveReport ToolBody::step(const std::vector<ToolTarget>& targets, double dt) {
  Impl& b = *impl_;
  assert(targets.size() == b.tools.size());
  std::vector<Vec3> motion = b.now.motion;
  std::vector<int> which;
  b.compliance.resize(0, 0);
  for (std::size_t t = 0; t < targets.size(); ++t) {
    if (targets[t].force)
      which.push_back(static_cast<int>(t));
    else
      motion[t] = targets[t].value;
  }
  VectorXd wanted(3 * static_cast<Index>(which.size()));
  for (std::size_t k = 0; k < which.size(); ++k)
    wanted.segment<3>(3 * static_cast<Index>(k)) =
        targets[static_cast<std::size_t>(which[k])].value;
  b.prepare(dt);
  const SolveReport report = which.empty() ? b.move(motion) : b.press(motion, which, targets);
  if (report.ok())
    b.commit(motion, dt);
  else
    b.body.restore(b.now.body);
  return report;
}

void ToolBody::set_options(const SolveOptions& options) {
  impl_->options = options;
}
int ToolBody::tools() const {
  return static_cast<int>(impl_->tools.size());
}
Vec3 ToolBody::motion(int tool) const {
  return impl_->now.motion[static_cast<std::size_t>(tool)];
}
Vec3 ToolBody::force(int tool) const {
  return impl_->now.force[static_cast<std::size_t>(tool)];
}
const NonlinearBody& ToolBody::body() const {
  return impl_->body;
}
std::optional<Eigen::Matrix3d> ToolBody::stiffness(int tool) {
  assert(!impl_->tools[static_cast<std::size_t>(tool)].tip);
  const NonlinearBody::Linearisation about = impl_->body.linearise();
  if (!about.stable) return std::nullopt;
  const Index at = 3 * impl_->number[static_cast<std::size_t>(tool)];
  return Eigen::Matrix3d(about.K.block<3, 3>(at, at));
}
std::optional<StressResponse> ToolBody::stress_response(int tool, const MatrixXd& inside) {
  const std::optional<MatrixXd> by = fields(tool);
  if (!by) return std::nullopt;
  return stress_response(*by, inside, {});
}
std::optional<MatrixXd> ToolBody::fields(int tool) {
  assert(!impl_->tools[static_cast<std::size_t>(tool)].tip);
  assert(impl_->terms == 0);
  const NonlinearBody::Linearisation about = impl_->body.linearise();
  if (!about.stable) return std::nullopt;
  const Index at = 3 * impl_->number[static_cast<std::size_t>(tool)];
  return MatrixXd(about.fields.middleCols<3>(at));
}
StressResponse ToolBody::stress_response(const MatrixXd& fields, const MatrixXd& inside,
                                         const StressPart& part) const {
  return impl_->body.stress_response(fields, inside, part);
}
std::optional<MatrixXd> ToolBody::moved_inside(const MatrixXd& stresses) {
  assert(impl_->terms == 0);
  if (!impl_->body.linearise().stable) return std::nullopt;
  return impl_->body.moved_inside(stresses);
}
const ToolBody::State& ToolBody::state() const {
  return impl_->now;
}
void ToolBody::restore(const State& state) {
  impl_->now = state;
  impl_->body.restore(state.body);
}

}  // namespace hapsim
