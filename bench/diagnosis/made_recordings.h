// Recordings whose truth is known: motions, the bodies that are pressed, and what a sensor adds.
#pragma once

#include <map>
#include <string>
#include <tuple>

#include "experiment/experiment.h"
#include "mesh/tetmesh.h"
#include "truths.h"

namespace hapsim::bench {

inline constexpr double kNoise = 0.01;  // [N] per component

struct Pair {
  Experiment truth, diagnosed;
};

// Bodies prepared once for each kind of recording.
class Pairs {
 public:
  // Files: the body that is diagnosed, the true one, and the motion.
  Pairs(const std::string& diagnosed, const std::string& truth, const std::string& motion);
  const Pair& of(const Truth& truth);

 private:
  TetMesh diagnosed_, truth_;
  std::string motion_;
  std::map<std::tuple<bool, int, double>, Pair> pairs_;
};

// To the forces `f` [N] of the truth's body, as they are stacked: a relative error of each
// position's stiffness, and noise, both by the seed.
void measure(const Truth& truth, const Experiment& body, int seed, Eigen::VectorXd& f);

// The experiment, had it measured these forces.
Experiment with_forces(Experiment experiment, const Eigen::VectorXd& forces);

}  // namespace hapsim::bench
