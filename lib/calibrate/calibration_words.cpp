#include "calibrate/calibration_words.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/counted.h"
#include "calibrate/torque_test.h"

namespace hapsim {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

// Largest standard error of three or six numbers.
double error_of(const Calibration& c, int first, int count) {
  double most = 0;
  for (int k = first; k < first + count; ++k) {
    const CalibratedValue& n = c.numbers[static_cast<std::size_t>(k)];
    if (std::isfinite(n.std_error)) most = std::max(most, n.std_error);
  }
  return most;
}

std::string three(const Vec3& v, double factor, const std::string& unit) {
  return fmt::format("{:.4g}, {:.4g}, {:.4g} {}", factor * v.x(), factor * v.y(), factor * v.z(),
                     unit);
}

std::string plus_minus(double error, const std::string& unit) {
  return error > 0 ? fmt::format("± {:.2g} {}", error, unit) : "";
}

void add_sensor(const Calibration& c, const SensorFit& fit, Summary& s) {
  const Vec3 turn = c.vector(kRotation);
  const Vec3 axis = turn.norm() > 1e-9 ? Vec3(turn.normalized()) : Vec3(Vec3::UnitZ());
  s.items.push_back({"ROTATION",
                     fmt::format("{:.2f} deg about {:.2f}, {:.2f}, {:.2f}", turn.norm() / kDegree,
                                 axis.x(), axis.y(), axis.z()),
                     plus_minus(error_of(c, kRotation, 3) / kDegree, "deg"),
                     {}});
  if (c.has(kCrosstalk)) {
    const Eigen::Matrix3d C = c.crosstalk();
    const double talk = std::max({std::abs(C(0, 1)), std::abs(C(0, 2)), std::abs(C(1, 2))});
    s.items.push_back(
        {"CROSSTALK",
         fmt::format("{:.2f} % at most, gains {}", 100 * talk, three(C.diagonal(), 1, "")),
         plus_minus(100 * error_of(c, kCrosstalk, 6), "%"),
         {}});
    s.items.back().name.pop_back();
  }
  s.items.push_back(
      {"OFFSET", three(c.vector(kOffset), 1, "N"), plus_minus(error_of(c, kOffset, 3), "N"), {}});
  if (c.has(kDrift))
    s.items.push_back({"DRIFT",
                       three(c.vector(kDrift), 1, "N/K"),
                       plus_minus(error_of(c, kDrift, 3), "N/K"),
                       {}});
  SummaryItem tool{"TOOL",
                   fmt::format("{:.4g} kg", c.numbers[kMass].value),
                   plus_minus(error_of(c, kMass, 1), "kg"),
                   {}};
  if (c.has(kCom))
    tool.facts.push_back(fmt::format("its centre at {} from the sensor's origin, ± {:.2g} mm",
                                     three(c.vector(kCom), 1e3, "mm"), 1e3 * error_of(c, kCom, 3)));
  s.items.push_back(tool);
  if (fit.terms.gravity)
    s.items.push_back({"GRAVITY",
                       three(c.vector(kGravity), 1, "m/s2"),
                       plus_minus(error_of(c, kGravity, 3), "m/s2"),
                       {}});
}

void add_arm_item(const Calibration& c, const ArmFit& arm, Summary& s) {
  const Vec3 diagonal = c.symmetric(kArm).diagonal();
  s.items.push_back({"ARM",
                     "along x, y, z " + three(diagonal, 1e3, "mm/N"),
                     plus_minus(1e3 * error_of(c, kArm, 6), "mm/N"),
                     {fmt::format("up to {:.3g} mm in these presses; {:.2g} mm are left",
                                  1e3 * arm.reach, 1e3 * arm.noise)}});
}

std::string scale_note(const SensorFit& fit) {
  if (fit.terms.scale != Scale::kMeanGain) return "";
  return "No weight is known: a heavier tool under a sensor of less gain would show the same, so "
         "the mean gain is taken for 1, and mass and centre are as true as that. Poses with a "
         "known weight (column load) or --mass tell them apart.";
}

std::string left_out_note(SensorGroup group, const StaticPoses& poses) {
  switch (group) {
    case kOfCrosstalk:
      return fmt::format(
          "{} do not determine the cross-talk: it is taken for none. It needs gravity along "
          "directions of the tool that do not lie in a plane or on a cone; see --plan",
          counted(static_cast<std::ptrdiff_t>(poses.poses.size()), "pose", "poses"));
    case kOfDrift:
    case kOfTorqueDrift:
      return fmt::format(
          "these poses do not determine the drift of the {}: it is taken for none. "
          "Record some of them again at another temperature",
          group == kOfDrift ? "force" : "torque");
    default:
      return "";
  }
}

// Unknowns that hardly change but together.
std::string correlated(const SensorFit& fit) {
  constexpr double kTogether = 0.95;
  const Eigen::MatrixXd r = correlations(fit.covariance);
  double most = kTogether;
  std::string words;
  for (Eigen::Index i = 0; i < r.rows(); ++i)
    for (Eigen::Index j = 0; j < i; ++j)
      if (std::abs(r(i, j)) > most) {
        most = std::abs(r(i, j));
        words = fmt::format(
            "{} and {} are known together better than alone (correlation {:.2f}): "
            "--plan has poses that part them",
            fit.unknowns.names[static_cast<std::size_t>(j)],
            fit.unknowns.names[static_cast<std::size_t>(i)], r(i, j));
      }
  return words;
}

// The pose that fits worst, where it is beyond chance.
std::string outlier(const SensorFit& fit, const StaticPoses& poses) {
  constexpr double kFar = 4.5;  // standard deviations: 1 of 1,000 recordings of 100 poses
  Eigen::Index pose = 0, axis = 0;
  const double far = fit.residual.leftCols<3>().cwiseAbs().maxCoeff(&pose, &axis);
  if (far < kFar * fit.force_noise) return "";
  return fmt::format(
      "The pose of line {} is {:.3g} N off, {:.1f} times the noise: did the tool "
      "touch something, or still move?",
      poses.poses[static_cast<std::size_t>(pose)].line, far, far / fit.force_noise);
}

void add_sensor_notes(const SensorFit& fit, const StaticPoses& poses, Summary& s) {
  const auto note = [&s](const std::string& text) {
    if (!text.empty()) s.notes.push_back(text);
  };
  note(scale_note(fit));
  for (const SensorGroup group : fit.left_out)
    if (group != kOfTorqueDrift || fit.left_out.front() == group) note(left_out_note(group, poses));
  if (fit.state.sign < 0)
    note(
        "The sensor shows the force of the tool on the body, or has an axis the other way round: "
        "its gains are negative.");
  note(correlated(fit));
  note(outlier(fit, poses));
  if (poses.repeated > 0)
    note(
        fmt::format("{} rows stand as the row before: where their noise is slow the errors are "
                    "larger than told. Number the poses (column pose) and each counts once.",
                    poses.repeated));
  if (poses.temps && fit.left_out.empty() && !fit.terms.drift)
    note("The temperature is the same in all poses: the drift is not known.");
  constexpr double kSignificant = 1e-3;
  if (const double p = torque_follows_force(fit, poses); p < kSignificant)
    note(
        fmt::format("The torques follow the force as no centre of mass does (chance {:.1g}): the "
                    "sensor shows force in its torques, and the centre is off by that.",
                    p));
}

void add_values(const Calibration& c, Summary& s) {
  for (std::size_t k = 0; k < c.numbers.size(); ++k)
    if (!c.numbers[k].state.empty())
      s.values.push_back({calibrated_names()[k].name, c.numbers[k].value,
                          calibrated_names()[k].unit, c.numbers[k].std_error});
}

void add_plan(const PosePlan& plan, Summary& s) {
  SummaryItem item{
      "PLAN",
      counted(static_cast<std::ptrdiff_t>(plan.poses.size()), "pose", "poses") + " to record",
      "",
      {}};
  // Of each quantity the number that is known worst.
  std::string told;
  const auto add = [&](const std::string& begins, const std::string& name, double factor,
                       const std::string& unit) {
    double now = 0, then = 0;
    bool open = false;
    for (std::size_t k = 0; k < plan.names.size(); ++k) {
      const auto at = static_cast<Eigen::Index>(k);
      if (plan.names[k].rfind(begins, 0) != 0) continue;
      now = std::max(now, plan.error_now[at]);
      then = std::max(then, plan.error_then[at]);
      open = open || plan.error_now[at] > plan.known_below[at];
    }
    if (then == 0) return;
    told += (told.empty() ? "" : ", ") + name + " ± " +
            (open ? "" : fmt::format("{:.2g} to ", factor * now)) +
            fmt::format("{:.2g} {}{}", factor * then, unit, open ? " (open now)" : "");
    s.values.push_back({"plan." + name, factor * then, unit == "%" ? "%" : unit, {}});
  };
  add("rotation", "rotation", 1 / kDegree, "deg");
  add("crosstalk", "cross-talk", 100, "%");
  add("offset", "offset", 1, "N");
  add("mass", "mass", 1, "kg");
  add("com", "centre", 1e3, "mm");
  item.facts.push_back("expected: " + told);
  s.items.push_back(item);
}

}  // namespace

std::string undetermined_words(const SensorFit& fit, const StaticPoses& poses,
                               const std::string& doubt) {
  const std::string count =
      counted(static_cast<std::ptrdiff_t>(poses.poses.size()), "pose", "poses");
  if (!doubt.empty()) return doubt;
  if (fit.blind.empty())
    return fmt::format("{} give {} numbers for {} unknowns: too few to know the errors by", count,
                       fit.residual.size(), fit.unknowns.names.size());
  return count + " do not determine the sensor: " + fit.blind.front().sentence;
}

Summary calibration_summary(const Calibration& c, const CalibrationParts& parts) {
  Summary s;
  if (parts.sensor != nullptr && parts.sensor->determined) {
    s.verdict = parts.poses->name + ": the sensor is calibrated";
    s.size = fmt::format(
        "noise {:.2g} N over {}", parts.sensor->force_noise,
        counted(static_cast<std::ptrdiff_t>(parts.poses->poses.size()), "pose", "poses"));
    add_sensor(c, *parts.sensor, s);
    if (!parts.doubt.empty()) {
      s.mark = Summary::Mark::kOpen;
      s.notes.push_back(parts.doubt);
    }
    add_sensor_notes(*parts.sensor, *parts.poses, s);
    if (!parts.sensor->left_out.empty()) s.mark = Summary::Mark::kOpen;
  } else if (parts.sensor != nullptr) {
    s.mark = Summary::Mark::kBad;
    s.verdict = parts.poses->name + ": the sensor is not calibrated yet";
    s.notes.push_back(undetermined_words(*parts.sensor, *parts.poses, parts.doubt));
  } else if (parts.arm != nullptr) {
    s.verdict = parts.presses->name + ": the arm is calibrated";
  } else {
    s.verdict = "a first plan: nothing is recorded yet";
  }
  if (parts.arm != nullptr) {
    add_arm_item(c, *parts.arm, s);
    s.notes.insert(s.notes.end(), parts.arm->open.begin(), parts.arm->open.end());
  }
  add_values(c, s);
  if (parts.plan != nullptr) add_plan(*parts.plan, s);
  return s;
}

}  // namespace hapsim
