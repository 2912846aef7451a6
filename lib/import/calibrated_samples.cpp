#include "import/calibrated_samples.h"

#include "base/error.h"
#include "rig/orientation.h"

namespace hapsim {

void calibrate_samples(const RawTable& table, const Calibration& calibration, Samples& samples,
                       Notes& notes) {
  require_uncorrected(table.metadata, table.name);
  std::vector<Vec3>& f = samples.vectors[static_cast<std::size_t>(VectorRole::kForce)];
  if (f.empty() && calibration.has_sensor())
    fail_input(table.name, "a sensor's calibration is of three components of force",
               "leave --calibration out, or name them by --column fx=NAME");
  RigColumns columns{read_orientations({table.name, table.header, table.columns, table.line}),
                     samples[ScalarRole::kTemperature]};
  if (const auto text = table.metadata.find("orientation"); text && columns.orientation.empty())
    columns.orientation.assign(table.rows(), orientation_of(*text, table.name));
  RigCorrection correction = correct_forces(calibration, columns, f);
  if (calibration.has(kArm)) correction.done.emplace_back("arm");
  const std::vector<std::string> words = correction_words(calibration, correction);
  notes.facts.push_back(words.front());
  notes.warnings.insert(notes.warnings.end(), words.begin() + 1, words.end());
}

}  // namespace hapsim
