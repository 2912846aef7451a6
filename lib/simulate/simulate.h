// The forces of a model along a motion, each contact position solved on its own graded mesh.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "experiment/experiment.h"
#include "experiment/forces.h"
#include "experiment/markers.h"
#include "model/model.h"

namespace hapsim {

struct Simulated {
  Recording recording;          // the motion with the model's forces, marked (mark_simulated())
  double mesh_uncertainty = 0;  // share of the force, the median over the positions
  std::size_t positions = 0;
  MarkerTable markers;  // where points were asked for
};

// The motion's forces are given and its displacements are found (traction.h), instead of the other
// way round.
enum class Control { kDisplacement, kForce };

// `motion` as it was read, with its tool's radius. `say` is told what was left out, is beyond what
// the model is valid for, or how regions relax; may be empty. Torques of the tool (tqx,tqy,tqz) are
// written where the motion has them or `torques` asks for them; metadata torque_uncertainty is what
// the meshes leave open of a component, root mean square [N m]. The displacements of `points` at
// the table's times, or at all of the motion's where it has none, with marker_uncertainty [m]
// likewise. Errors of make_experiment();
// Error(kBadInput) where torques are asked for that the model does not say (torque_refusal()), or
// points (marker_refusal()).
Simulated simulate(const TetMesh& body, const Model& model, Recording motion,
                   ExperimentOptions options, const std::function<void(const std::string&)>& say,
                   Control control = Control::kDisplacement, bool torques = false,
                   const MarkerTable* points = nullptr);

// The dataset's recording with the stacked forces `f` of these episodes, zero elsewhere;
// `mesh_uncertainty` as its metadata, none where it is 0.
Recording with_forces(Dataset dataset, const Selection& episodes, const Eigen::VectorXd& f,
                      double mesh_uncertainty = 0);

// Forces from here on are those of `label`; what was declared of the noise of measured ones goes.
void mark_simulated(Metadata& metadata, const std::string& label);

// Gaussian noise of this standard deviation [N] on every component of every force, declared.
void add_noise(Recording& recording, double noise, std::uint64_t seed);
// The same of torques [N m], independent of the forces'. Error(kUsage): there are none.
void add_torque_noise(Recording& recording, double noise, std::uint64_t seed);
// Takes away torques that are measured ones; a sentence where there were any, with the reason.
std::string without_torques(Recording& recording, const std::string& why);

}  // namespace hapsim
