// Forces and displacements as they were, from what an uncalibrated rig recorded.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "base/vec3.h"
#include "recording/recording.h"
#include "rig/calibration.h"

namespace hapsim {

// What was done, and what could not be for want of a column.
struct RigCorrection {
  std::vector<std::string> done;     // "cross-talk", "rotation", ...
  std::vector<std::string> lacking;  // sentences
};

// What the rows of a table tell beside the force; empty where they do not.
struct RigColumns {
  std::vector<Eigen::Matrix3d> orientation;  // tool in the base (rig/orientation.h)
  std::vector<double> temp;                  // [degC]
};

// f in place [N], measured, becomes the force of the body on the tool,
//   f = R_tool (R^T C^-1 (f - offset - drift (temp - temp_ref)) - R_tool^T m g),
// in the base's frame. Without orientations the tool's axes are taken for the recording's and its
// weight stays in the force; without temperatures the drift does.
RigCorrection correct_forces(const Calibration& calibration, const RigColumns& columns,
                             std::vector<Vec3>& f);

// A whole recording, in place: its forces; columns tx,ty,tz [N m], where it has them, become the
// torque of the body about the sensor's origin in the same frame; its displacements,
// u = u_recorded + S f; the metadata force_noise by what the noise has become, and `calibrated`
// names the file. Orientations from its columns or its metadata `orientation` (qw,qx,qy,qz, of all
// rows). Error(kBadInput): it was corrected before.
RigCorrection calibrate_recording(const Calibration& calibration, Recording& recording);

// The arm alone, and the metadata: of a recording whose forces are corrected.
RigCorrection calibrate_displacements(const Calibration& calibration, Recording& recording);

// "by cal.csv: cross-talk, rotation, offset and weight taken out", and what is lacking, a sentence
// each.
std::vector<std::string> correction_words(const Calibration& calibration,
                                          const RigCorrection& correction);

// Error(kBadInput) where the metadata say that a recording was corrected before.
void require_uncorrected(const Metadata& metadata, const std::string& name);

}  // namespace hapsim
