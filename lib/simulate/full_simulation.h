// The forces of a model along a motion by finite elements at every step: finite strain, growing
// contact, friction and relaxation as the elements have them, not as condensed laws.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "contact/contact_stiffness.h"
#include "model/model.h"
#include "nonlinear/tool_body.h"
#include "recording/recording.h"

namespace hapsim {

// A solved row: for pictures.
struct FullView {
  std::size_t row = 0;                     // of the recording
  const TetMesh* mesh = nullptr;           // undeformed
  const Eigen::VectorXd* field = nullptr;  // displacements, 3 nodes [m]
  ElementFields elements;
};

struct FullOptions {
  // On the body's own mesh; else each press on a mesh graded to its tool's rim, as the condensed
  // stiffnesses are. Several tools at once always press the body's own.
  bool own_mesh = false;
  double rim_edge = 1.0 / 6;  // of that mesh, over the tool's radius
  double growth = 0;          // of its edges with the distance from there; 0: with rim_edge
  // At the rim, which follow the stress of the linear body there. At finite strain forces converge
  // more slowly with them, and the tangent fails at half the depth or less: of a flat tool that
  // slips there are none then.
  bool quarter_points = true;
  bool averaged = true;  // mean dilatation (dilatation.h), so that elements do not lock
  const ContactBase* base = nullptr;  // of the body; null: it is made
  SolveOptions solve;
  bool force_control = false;  // the recording's forces are given, its displacements are found
  std::function<void(std::size_t rows_done)> step;
  std::function<void(const FullView&)> observe;
};

struct FullResult {
  std::vector<Vec3> force;   // of the body on the tool, one a row [N]
  std::vector<Vec3> motion;  // the tool's displacement, one a row [m]
  int unknowns = 0;          // of the largest mesh
  int newton_steps = 0;
};

// Rows of one press are one body in time. Several tools: a column `tool_id`; rows that follow one
// another with the same press and time and different tool_id are one step, the same tools in every
// step of a press; tools that press at once in presses of their own are one body in time
// (simulate/tool_steps.h). Body, support and contact effects are solved (Effect::full()), effects
// on the motion and of the sensor act before and after it, tool by tool. A flat tool is bonded;
// with friction it is a flat punch that may part and slip; the tip is a whole ball of radius
// 1/kappa. Error(kBadInput): an effect that has no such form. Error(kBadInput) with line: tools
// that change within a press, no node under a tool. Error(kNoConvergence) with line: a step that
// does not converge, and how far it came.
FullResult simulate_full(const TetMesh& body, const Model& model, const Recording& recording,
                         const FullOptions& options);

// One press of one tool, step by step, where the motion is not known beforehand. Errors as above;
// also Error(kBadInput): effects on the motion or of the sensor. `body` must outlive it. Not to be
// shared between threads.
class FullPress {
 public:
  FullPress(const TetMesh& body, const Model& model, const Vec3& contact, double tool_radius,
            const FullOptions& options);
  ~FullPress();
  // To the displacement u [m], dt [s] after the last step: the force on the tool [N].
  Vec3 step(const Vec3& u, double dt);
  void reset();  // back to the undeformed body, at rest
  // Of the bonded tool where it stands, as the mesh has it.
  const Vec3& normal() const;                  // outward, unit
  std::optional<Eigen::Matrix3d> stiffness();  // ToolBody::stiffness() [N/m]
  // Of a body without memory (ToolBody::stress_response(), fields(), moved_inside()), and its
  // stresses in the same numbers.
  std::optional<StressResponse> stress_response(const Eigen::MatrixXd& inside = {});
  std::optional<Eigen::MatrixXd> fields();
  StressResponse stress_response(const Eigen::MatrixXd& fields, const Eigen::MatrixXd& inside,
                                 const StressPart& part) const;
  std::optional<Eigen::MatrixXd> moved_inside(const Eigen::MatrixXd& stresses);
  Eigen::VectorXd stresses() const;
  // All that the next step starts from.
  const ToolBody::State& state() const;
  void restore(const ToolBody::State& state);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hapsim
