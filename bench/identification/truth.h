// What the identification is tried on: bodies, presses, and forces that are not the model's own.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "base/random.h"
#include "contact/contact_stiffness.h"
#include "experiment/experiment.h"
#include "recording/recording.h"

namespace hapsim::bench {

constexpr double kToolRadius = 0.004;  // [m]
constexpr double kFiner = 1.5;         // the truth's meshes against the model's

struct Object {
  std::string name;
  TetMesh exact;   // finely triangulated: the truth
  TetMesh meshed;  // as hs-tetmesh makes it: the model's
};
// "block" (120 x 210 x 60 mm), "ball" (half, radius 50 mm), "organ" (uneven lump).
Object make_object(const std::string& name);

// The stiffness of each position by meshes with 1/kFiner of every length, kept in OUT/NAME.csv.
std::vector<Eigen::Matrix3d> true_stiffness(const std::string& out, const std::string& name,
                                            const Object& object,
                                            const std::vector<Vec3>& positions,
                                            const Material& material);

// The tool moves to `u` at constant speed in `ramp` seconds and stays there for `hold`.
struct TruePress {
  int position = 0;
  Vec3 u = Vec3::Zero();  // [m]
  double ramp = 1, hold = 0;
};
// Samples every `step` seconds; without time when `step` is 0, then at so many `depths`.
Recording record(const std::vector<Vec3>& positions, const std::vector<TruePress>& presses,
                 double step, int depths = 20);

// f = K u E (1 + sum of shares, each relaxing by its time): in closed form for a ramp and a hold,
//   E u (t / T) + sum E_i (u / T) tau_i (1 - exp(-t / tau_i)) while it moves,
//   E u + sum E_i (u / T) tau_i (exp(-(t - T) / tau_i) - exp(-t / tau_i)) while it stays.
using Relaxation = std::vector<std::pair<double, double>>;  // E_i [Pa], tau_i [s]
std::vector<Vec3> true_forces(const Recording& recording, const std::vector<TruePress>& presses,
                              const std::vector<Eigen::Matrix3d>& K, double modulus,
                              const Relaxation& relaxation);

// Forces as measured: each position's stiffness errs by `gain` (relative, each symmetric direction
// by itself), each component by `noise` [N].
void measure(Recording& recording, const std::vector<TruePress>& presses,
             const std::vector<Vec3>& forces, double gain, double noise, Random& random);
// The experiment with forces measured so.
Experiment measured(Experiment experiment, const std::vector<TruePress>& presses,
                    const std::vector<Vec3>& forces, double gain, double noise, Random& random);

double peak(const std::vector<Vec3>& forces);  // [N]

}  // namespace hapsim::bench
