// A body under tools, in time: what it is made of relaxes, tools are moved or pressed with a force.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "nonlinear/nonlinear_body.h"

namespace hapsim {

// Bonded to nodes of the body, or a spherical tip.
struct BodyTool {
  std::vector<int> nodes;  // that move with it; empty for a tip
  std::optional<SphericalTip> tip;
};

// One Maxwell element beside a law: its share of the law's stress, and its relaxation time [s].
struct Relaxation {
  double share = 0;
  double tau = 1;
};

// What a tool does in a step: to a place (its motion since the start [m]), or with a force of the
// body on the tool [N], whose place is found; of a tip without friction the force's part along its
// normal counts alone, and it keeps its place sideways.
struct ToolTarget {
  Vec3 value = Vec3::Zero();
  bool force = false;
};

// Generalised Maxwell material of each law at finite strain (Simo, Comput. Methods Appl. Mech. Eng.
// 60, 1987; Holzapfel, Int. J. Numer. Methods Eng. 39, 1996, in the form in which all of the stress
// relaxes): S = S_e + sum_k H_k, dH_k/dt = share_k dS_e/dt - H_k/tau_k, S_e the law's second
// Piola-Kirchhoff stress and the pressure of its change of volume alike. Exact where S_e is
// straight in time within a step, else of second order in the step. The algorithmic stress has an
// energy, so each step is a static problem. Not to be shared between threads.
class ToolBody {
 public:
  // `relaxation`: of each law, or empty. The mesh's fixed nodes are held unless `free_base`.
  // Error(kBadInput) as BodyAssembly.
  ToolBody(const BodyModel& model, const std::vector<BodyTool>& tools,
           const std::vector<std::vector<Relaxation>>& relaxation = {}, bool free_base = false);
  ~ToolBody();

  // `dt` [s] since the last step; 0: a jump. On failure the body stays as it was. Forces are met to
  // 1e-8 (1e-7 with tips) by Broyden's method (Math. Comput. 19, 1965), each trial a whole
  // solution: exact at once where the body is linear.
  SolveReport step(const std::vector<ToolTarget>& targets, double dt);
  void set_options(const SolveOptions& options);  // of later steps

  int tools() const;
  Vec3 motion(int tool) const;  // since the start [m]
  Vec3 force(int tool) const;   // of the body on the tool [N]
  const NonlinearBody& body() const;
  // Minus d force / d motion at the last step, of a bonded tool [N/m], the other tools held: of
  // what relaxes as stiff as in that step. Nothing where the tangent is not positive definite.
  std::optional<Eigen::Matrix3d> stiffness(int tool);
  // At the last step, by the three directions of a bonded tool, of a body that does not relax.
  // Nothing as above. `inside`: as NonlinearBody::stress_response().
  std::optional<StressResponse> stress_response(int tool, const Eigen::MatrixXd& inside);
  // The same in two: the fields of the three directions, and from them, at the same step, a part.
  std::optional<Eigen::MatrixXd> fields(int tool);
  StressResponse stress_response(const Eigen::MatrixXd& fields, const Eigen::MatrixXd& inside,
                                 const StressPart& part) const;
  // NonlinearBody::moved_inside() at the last step. Nothing as above.
  std::optional<Eigen::MatrixXd> moved_inside(const Eigen::MatrixXd& stresses);

  // All that the next step starts from.
  struct State {
    NonlinearBody::State body;
    std::vector<Vec3> motion;
    std::vector<Vec3> force;
    PointStresses elastic;              // S_e, of factors 1
    std::vector<PointStresses> memory;  // H_k
  };
  const State& state() const;
  void restore(const State& state);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hapsim
