// A calibration in sentences.
#pragma once

#include <string>
#include <vector>

#include "calibrate/arm_fit.h"
#include "calibrate/pose_plan.h"
#include "calibrate/sensor_fit.h"
#include "cli/summary.h"
#include "rig/calibration.h"

namespace hapsim {

// What was calibrated; what is null was not asked for.
struct CalibrationParts {
  const StaticPoses* poses = nullptr;
  const SensorFit* sensor = nullptr;
  std::string doubt;  // pose_doubt() of them
  const Recording* presses = nullptr;
  const ArmFit* arm = nullptr;
  const PosePlan* plan = nullptr;
};

// The verdict, each quantity with its standard error, what the poses leave open or cannot tell, the
// poses that do not fit, what a plan is expected to bring.
Summary calibration_summary(const Calibration& calibration, const CalibrationParts& parts);

// One sentence: what these poses do not determine, or their `doubt`, which comes first.
std::string undetermined_words(const SensorFit& fit, const StaticPoses& poses,
                               const std::string& doubt);

}  // namespace hapsim
