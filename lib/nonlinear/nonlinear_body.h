// A body of any material law whose nodes are free, held, or moved by rigid handles, pressed by
// spherical tips: forces at finite strain, their tangent and their derivatives by the material.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "nonlinear/body_assembly.h"
#include "nonlinear/tip_contact.h"

namespace hapsim {

enum class SolveStatus {
  kConverged,
  kUnstable,       // the tangent is not positive definite: the body buckles or its material fails
  kInverted,       // an element turns inside out or the energy overflows
  kNoConvergence,  // Newton's method does not settle
  kOffSurface,     // a tip's contact reaches the rim of the surface prepared for it
};

struct SolveReport {
  SolveStatus status = SolveStatus::kConverged;
  std::string message;  // empty when converged; else what happened, where, and what to do
  double reached = 1;   // share of the way to the target at which the body stands now
  int load_steps = 0, newton_steps = 0;
  bool ok() const { return status == SolveStatus::kConverged; }
};

struct SolveOptions {
  double tolerance = 1e-9;  // free nodes' forces over the handles', both as norms
  int newton_limit = 14;    // a load step
  double least_step = 1.0 / 256;
  // Where the tangent is not positive definite, as where the surface beside a tool's rim creases,
  // down the energy all the same, to the next state that is stable. Without tips.
  bool past_instability = false;
};

// Displacement-controlled path following: Newton's method with the consistent tangent, a line
// search on the energy, load steps that are halved on failure and doubled on success. One symbolic
// analysis for all. Static; a path with the same end gives the same force unless the body loses its
// stability, which the report says. Not to be shared between threads.
class NonlinearBody {
 public:
  // `handle`: one a node, kFreeNode, kHeldNode (elastic_body.h) or a handle's number from 0 on.
  // The mesh must outlive the body. Error(kBadInput) as BodyAssembly.
  NonlinearBody(const BodyModel& model, const std::vector<int>& handle);
  ~NonlinearBody();

  // Moves the handles from where they are to `prescribed` (3 handles) [m]. On failure the body
  // stays at the last equilibrium reached, as the report says: a force read there belongs to that
  // place.
  SolveReport solve(const Eigen::VectorXd& prescribed, const SolveOptions& options = {});
  // New constants or factors; the displacement is kept as the start of the next solve().
  void set_laws(const std::vector<LawPointer>& laws);
  void set_scale(const std::vector<double>& scale);
  // Dead loads, 3 nodes [N]; the next solve() reaches them together with the displacement. Zero at
  // first.
  void set_load(const Eigen::VectorXd& nodal);
  void reset();  // back to the undeformed body

  // Spherical tips (tip_contact.h): unilateral, with or without friction; every load step counts
  // the slip from the one before. With laws of small strain alone the contact is linear but for its
  // area, and the stiffness is factorised once. Tips are added before the first solve().
  int add_tip(const SphericalTip& tip);
  int tips() const;
  void move_tip(int tip, const Vec3& motion);  // where the next solve() brings it [m]
  Vec3 tip_motion(int tip) const;
  Vec3 tip_force(int tip) const;         // that presses it against the body [N]
  double contact_radius(int tip) const;  // of the Hertzian pressure with the same second moment [m]

  // Stresses beside the laws' (BodyAssembly::set_added), for the next solve().
  void set_added(PointStresses added);
  PointStresses elastic_stresses() const;
  void laws_of_stresses(std::vector<int>& of_point, std::vector<int>& of_group) const;
  ElementFields element_fields() const;
  // All that solve() starts from; of this body.
  struct State {
    Eigen::VectorXd u, prescribed, load;
    std::vector<Eigen::VectorXd> traction;
    std::vector<Vec3> motion;
  };
  State state() const;
  void restore(const State& state);

  int handles() const;
  int unknowns() const;
  double energy() const;                        // stored in the body [J]
  const Eigen::VectorXd& field() const;         // 3 nodes [m]
  const Eigen::VectorXd& nodal_forces() const;  // 3 nodes: that hold the nodes, loads included [N]
  Eigen::VectorXd reaction() const;             // 3 handles: force that moves the handles [N]

  // Without the tips. At the present equilibrium, by the implicit function theorem from one field a
  // handle direction: no differences, no further Newton steps.
  struct Linearisation {
    bool stable = true;      // false: not positive definite, the rest is empty
    Eigen::MatrixXd K;       // 3 handles squared: d reaction / d prescribed [N/m]
    Eigen::MatrixXd fields;  // 3 nodes x 3 handles: d field / d prescribed
    std::vector<Eigen::MatrixXd> by_constants;  // by law: 3 handles x its constants
    Eigen::MatrixXd by_foundation;              // 3 handles x 2: by k_n, k_t
    Eigen::MatrixXd by_scale;                   // 3 handles x tetrahedra [N]; empty unless asked
  };
  Linearisation linearise(bool by_scale = false);
  // At the present equilibrium, by directions of handles: after linearise(), of whose `fields`
  // these are some. `inside`: other fields that are asked for, a column each, or none; of a part of
  // the numbers `inside_stressed` is with the last one alone.
  StressResponse stress_response(const Eigen::MatrixXd& fields, const Eigen::MatrixXd& inside,
                                 const StressPart& part = {}) const;
  // What given stresses (StressResponse's numbers, a column each) would move inside beside the
  // present ones, to first order, the handles held: after linearise() [m].
  Eigen::MatrixXd moved_inside(const Eigen::MatrixXd& stresses) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hapsim
