// Measured torques of the tool against simulated ones.
#pragma once

#include <string>
#include <vector>

#include "experiment/torques.h"
#include "recording/recording.h"

namespace hapsim {

struct TorqueComparison {
  // Torques about the tip by row, measured and simulated [N m]; empty where one of both lacks them.
  std::vector<Vec3> measured, simulated;
  TorqueError error;
  double mesh = 0;  // what the meshes of the simulated ones leave open [N m]; 0: not known
  TorquePole pole;  // about which the residuals would be least
  bool compared() const { return !measured.empty(); }
};

// Of recordings that match. Nothing where no torques were measured.
TorqueComparison compare_torques(const Recording& measured, const Recording& simulated);

// No more is left than noise, and what the meshes leave open; true where nothing was compared.
bool torques_explained(const TorqueComparison& torque);
// That their tip is taken for another point, where that takes most of it away: "they are as if the
// tool stood 1.0 mm from where it is said to, at (...) mm"; "" where it does not.
std::string pole_words(const TorquePole& pole, double rms);
// A line or two for people; none where no torques were measured.
std::vector<std::string> torque_facts(const TorqueComparison& torque);

}  // namespace hapsim
