// Measured minus simulated: what it is, how large it is, and what each row was doing.
#pragma once

#include <string>
#include <vector>

#include "recording/recording.h"

namespace hapsim {

// Sensor noise: standard deviation of one force component [N].
struct NoiseLevel {
  double value = 0;
  bool estimated = false;  // from the recording itself, not from `force_noise`
  std::string origin;      // for sentences
};

// As recording/force_noise.h has it; 0 when it is not declared and no press has three rows.
NoiseLevel noise_level(const Recording& measured);

// Error sizes in newtons. rmse = sqrt(mean of all squared component residuals): all rows, the
// components that were measured pooled, so that it compares with the noise of one component.
// force_rms is the same mean of the measured force; force_peak the largest length of the measured
// force vector.
struct ErrorSize {
  double rmse = 0;
  Vec3 rmse_axis = Vec3::Zero();
  double force_rms = 0;
  double force_peak = 0;
};
ErrorSize error_size(const std::vector<Vec3>& measured, const std::vector<Vec3>& simulated);

// Error(kBadInput) unless both have forces, the same rows in the same order, the same presses, and
// contact points and displacements within 1e-5 m; names the first row that differs.
void check_match(const Recording& measured, const Recording& simulated);

// The measured recording with sx,sy,sz (simulated) and rx,ry,rz (measured minus simulated)
// appended; columns of these names that were there are replaced.
Recording with_residuals(const Recording& measured, const std::vector<Vec3>& simulated);
// The same of torques, stqx,stqy,stqz and rtqx,rtqy,rtqz [N m], one each a row.
Recording with_torque_residuals(const Recording& measured, const std::vector<Vec3>& torque,
                                const std::vector<Vec3>& simulated);

enum class Phase { kLoading, kHold, kUnloading, kAir };

// What the tool was doing in each row; from the measured recording alone.
struct RowFacts {
  std::vector<int> press;       // index into press_ids
  std::vector<int> press_ids;   // in order of first appearance
  std::vector<int> position;    // index into positions
  std::vector<Vec3> positions;  // distinct contact points (closer than 1e-4 m are one) [m]
  std::vector<Vec3> normal;     // one a position: unit, out of the body
  std::vector<char> sideways;   // one a press: deepest displacement over 20 degrees off the normal
  std::vector<char> repeated;   // one a press: its position was pressed before
  std::vector<double> depth;    // |u| [m]
  std::vector<double> temperature;  // [degC]; empty when not measured
  std::vector<Phase> phase;
  // The following are empty without a time column.
  std::vector<double> rate;         // |du/dt| over at least 20 ms [m/s]
  std::vector<double> contact_age;  // since the press first touched [s]
  std::vector<double> session;      // t, or with presses laid end to end when t restarts [s]
};

// The normal of a position points against the displacement most of its presses agree on at their
// deepest (the press direction nearest to the others); pressing obliquely everywhere misleads it.
RowFacts row_facts(const Recording& measured);

}  // namespace hapsim
