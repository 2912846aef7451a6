#include "rig/correct.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "io/csv.h"
#include "io/number.h"
#include "recording/torque_columns.h"
#include "rig/orientation.h"

namespace hapsim {
namespace {

constexpr const char* kMark = "calibrated";  // metadata
constexpr const char* kTorques[] = {"tx", "ty", "tz"};

// What is behind the offset of the sensor: the drift by row.
struct Drift {
  Vec3 per_kelvin = Vec3::Zero();
  double temp_ref = 0;
  const std::vector<double>& temp;
  Vec3 at(std::size_t row) const {
    return temp.empty() ? Vec3(Vec3::Zero()) : Vec3((temp[row] - temp_ref) * per_kelvin);
  }
};

// A sentence where the recording is warmer or colder than the calibration ever was, by a fifth of
// its range.
std::string beyond_range(const Calibration& c, const std::vector<double>& temp) {
  const std::string text = c.metadata.find("temp_range").value_or("");
  const std::size_t comma = std::min(text.find(','), text.size());
  double cold = 0, warm = 0;
  if (comma == text.size() || !parse_number(text.substr(0, comma), cold) ||
      !parse_number(text.substr(comma + 1), warm))
    return "";
  const auto [low, high] = std::minmax_element(temp.begin(), temp.end());
  const double slack = 0.2 * (warm - cold);
  if (*low >= cold - slack && *high <= warm + slack) return "";
  return fmt::format(
      "temperatures of {:.3g} to {:.3g} degC reach beyond those of the calibration, "
      "{:.3g} to {:.3g}: the drift is extrapolated",
      *low, *high, cold, warm);
}

RigColumns columns_of(const Recording& r) {
  RigColumns columns{read_orientations({r.name, r.extra_header, r.extra, r.line}), r.temp};
  if (const auto text = r.metadata.find("orientation"); text && columns.orientation.empty())
    columns.orientation.assign(r.rows(), orientation_of(*text, r.name));
  return columns;
}

// The extra columns tx,ty,tz as numbers, and back.
void correct_torques(const Calibration& c, const RigColumns& columns, Recording& r) {
  std::array<std::size_t, 3> at{};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto found = std::find(r.extra_header.begin(), r.extra_header.end(), kTorques[k]);
    if (found == r.extra_header.end()) return;
    at[k] = static_cast<std::size_t>(found - r.extra_header.begin());
  }
  const Eigen::Matrix3d back = c.sign() * c.rotation().transpose();
  const Drift drift{c.vector(kTorqueDrift), c.temp_ref(), columns.temp};
  BadCells bad;
  for (std::size_t row = 0; row < r.rows() && !bad.full(); ++row) {
    Vec3 torque;
    for (std::size_t k = 0; k < 3; ++k)
      if (!parse_number(r.extra[at[k]][row], torque[static_cast<Eigen::Index>(k)]))
        bad.add(kTorques[k], r.line[row], r.extra[at[k]][row]);
    torque = back * (torque - c.vector(kTorqueOffset) - drift.at(row));
    if (!columns.orientation.empty()) {
      const Eigen::Matrix3d& R = columns.orientation[row];
      torque -= c.vector(kCom).cross(c.numbers[kMass].value * (R.transpose() * c.vector(kGravity)));
      torque = (R * torque).eval();
    }
    for (std::size_t k = 0; k < 3; ++k)
      r.extra[at[k]][row] = format_number(torque[static_cast<Eigen::Index>(k)]);
  }
  bad.fail_if_any(r.name);
}

}  // namespace

RigCorrection correct_forces(const Calibration& c, const RigColumns& columns,
                             std::vector<Vec3>& f) {
  RigCorrection correction;
  if (!c.has_sensor() || f.empty()) return correction;
  const Eigen::Matrix3d back = c.rotation().transpose() * c.crosstalk().inverse();
  const Drift drift{c.vector(kDrift), c.temp_ref(), columns.temp};
  for (std::size_t row = 0; row < f.size(); ++row) {
    f[row] = back * (f[row] - c.vector(kOffset) - drift.at(row));
    if (!columns.orientation.empty())
      f[row] =
          (columns.orientation[row] * f[row] - c.numbers[kMass].value * c.vector(kGravity)).eval();
  }
  if (c.has(kCrosstalk)) correction.done.emplace_back("cross-talk");
  correction.done.insert(correction.done.end(), {"rotation", "offset"});
  if (!columns.orientation.empty())
    correction.done.emplace_back("weight");
  else if (c.numbers[kMass].value > 0)
    correction.lacking.emplace_back(
        "the recording does not say how the tool was turned: its axes are taken for the "
        "recording's, and its weight stays in the force (columns qw,qx,qy,qz, or metadata "
        "orientation)");
  if (!c.has(kDrift) || c.numbers[kDrift].state == "assumed") return correction;
  if (!columns.temp.empty()) {
    correction.done.emplace_back("drift");
    if (const std::string beyond = beyond_range(c, columns.temp); !beyond.empty())
      correction.lacking.push_back(beyond);
  } else {
    correction.lacking.emplace_back(
        "the recording has no column temp: the drift by temperature stays in the force");
  }
  return correction;
}

void require_uncorrected(const Metadata& metadata, const std::string& name) {
  if (const auto by = metadata.find(kMark))
    fail_input(name, "its forces were corrected before, by " + *by, "leave --calibration out");
}

RigCorrection calibrate_displacements(const Calibration& c, Recording& r) {
  RigCorrection correction;
  r.metadata.set(kMark, c.name);
  if (c.has(kArm) && !r.f.empty()) {
    const Eigen::Matrix3d S = c.symmetric(kArm);
    for (std::size_t row = 0; row < r.rows(); ++row) r.u[row] += S * r.f[row];
    correction.done.emplace_back("arm");
  }
  return correction;
}

RigCorrection calibrate_recording(const Calibration& c, Recording& r) {
  require_uncorrected(r.metadata, r.name);
  const RigColumns columns = columns_of(r);
  RigCorrection correction = correct_forces(c, columns, r.f);
  if (c.has(kTorqueOffset)) correct_torques(c, columns, r);
  // Torques in another frame than the forces are none.
  if (has_tip_torques(r) || (has_torques(r) && !c.has(kTorqueOffset))) {
    forget_torques_because(r, "the calibration does not correct them");
    correction.lacking.emplace_back("the calibration does not correct the recording's torques");
  }
  if (const auto noise = r.force_noise(); noise && c.has(kCrosstalk)) {
    const double factor = c.crosstalk().inverse().norm() / std::sqrt(3.0);
    r.metadata.set("force_noise", fmt::format("{:.4g}", factor * *noise));
  }
  const RigCorrection arm = calibrate_displacements(c, r);
  correction.done.insert(correction.done.end(), arm.done.begin(), arm.done.end());
  return correction;
}

std::vector<std::string> correction_words(const Calibration& c, const RigCorrection& correction) {
  std::string all;
  for (std::size_t i = 0; i < correction.done.size(); ++i)
    all += (i == 0 ? "" : i + 1 == correction.done.size() ? " and " : ", ") + correction.done[i];
  std::vector<std::string> words{all.empty() ? fmt::format("by {}: nothing is changed", c.name)
                                             : fmt::format("by {}: {} taken out", c.name, all)};
  words.insert(words.end(), correction.lacking.begin(), correction.lacking.end());
  return words;
}

}  // namespace hapsim
