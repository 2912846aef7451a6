// hs-calibrate: a force sensor, its tool and its arm, from poses at rest and presses on a rigid
// block.
#include <fmt/format.h>

#include <memory>
#include <numbers>

#include "answer.h"
#include "base/error.h"
#include "base/shell_words.h"
#include "base/units.h"
#include "calibrate/arm_fit.h"
#include "calibrate/calibration_words.h"
#include "calibrate/given_gravity.h"
#include "calibrate/pose_doubt.h"
#include "calibrate/pose_plan.h"
#include "calibrate/sensor_fit.h"
#include "calibrate/sensor_result.h"
#include "calibrate/static_poses.h"
#include "cli/shared_flags.h"
#include "rig/correct.h"
#include "rig/orientation.h"

namespace hapsim {
namespace flag {
inline constexpr FileFlag robot{"--robot"}, rigid{"--rigid"}, plan{"--plan"};
inline constexpr TextFlag root{"--root"}, tip{"--tip-link"}, gravity{"--gravity"};
inline constexpr ChoiceFlag angle_unit{"--angle-unit"}, crosstalk{"--crosstalk"};
inline constexpr NumberFlag mass{"--mass"}, tilt{"--tilt"};
inline constexpr IntegerFlag plan_poses{"--plan-poses"};
}  // namespace flag

namespace {

std::vector<Option> options() {
  return {
      {.flag = flag::robot,
       .value = "URDF",
       .help = "The poses are joint angles q1..qN of this robot.",
       .group = "Poses"},
      {.flag = flag::root,
       .value = "LINK",
       .help = "Link that stands still, else the robot's first.",
       .group = "Poses"},
      {.flag = flag::tip,
       .value = "LINK",
       .help = "Link that carries the sensor, else the robot's only end.",
       .group = "Poses"},
      {.flag = flag::angle_unit,
       .value = "UNIT",
       .help = "Unit of joint angles.",
       .group = "Poses",
       .default_text = "rad",
       .choices = {"rad", "deg"}},
      {.flag = flag::gravity,
       .value = "X,Y,Z",
       .help = "Gravity in the robot's base [m/s2]; 'estimate': its direction is fitted, at "
               "9.80665 m/s2, as for a robot whose base hangs on a wall.",
       .group = "Sensor",
       .default_text = "0,0,-9.80665"},
      {.flag = flag::mass,
       .value = "KG",
       .help = "Mass of what the sensor carries, weighed; otherwise fitted.",
       .group = "Sensor",
       .minimum = 1e-6,
       .maximum = 1e4},
      {.flag = flag::crosstalk,
       .value = "HOW",
       .help = "Whether gains and cross-talk are fitted; auto: where the poses determine them.",
       .group = "Sensor",
       .default_text = "auto",
       .choices = {"auto", "on", "off"}},
      {.flag = flag::rigid,
       .value = "FILE",
       .help = "Recording of presses on a rigid block, in which all that moves is the arm: its "
               "compliance is fitted, after their forces were put right by the sensor's "
               "calibration.",
       .group = "Arm"},
      {.flag = flag::plan,
       .value = "FILE",
       .help = "Writes the poses to record next (CSV): those that tell most of what is known "
               "worst.",
       .group = "Plan",
       .writes = kTableExtensions},
      {.flag = flag::plan_poses,
       .value = "N",
       .help = "Number of poses of the plan.",
       .group = "Plan",
       .default_text = "6",
       .minimum = 1,
       .maximum = 200},
      {.flag = flag::tilt,
       .value = "DEG",
       .help = "The tool may lean so far from the first pose.",
       .group = "Plan",
       .default_text = "180",
       .minimum = 1,
       .maximum = 180},
      answer_option("Output"),
  };
}

ToolSpec specification() {
  ToolSpec spec;
  spec.name = "hs-calibrate";
  spec.task = Task::kRecording;
  spec.summary = "calibrate a force sensor from poses at rest, and an arm from a rigid block";
  spec.input = "poses CSV (fx,fy,fz and the tool's orientation, or joint angles)";
  spec.input_optional = true;
  spec.description = {
      "The robot stands still in several poses and holds the tool in the air; the sensor shows its "
      "weight, turned, through its own faults. In the tool's frame, with R_tool the tool's "
      "orientation in the base, m its mass, g gravity: force = C R R_tool^T (m g) + offset + drift "
      "(temp - temp_ref); torque = R (com x R_tool^T m g) + torque_offset + torque_drift (temp - "
      "temp_ref). All numbers are fitted together, by least squares; standard errors are those of "
      "the linearised fit at the noise that the residuals show, intervals (lower, upper) of 95 % "
      "by Student's t.",
      "R is the rotation from tool to sensor; C, gains and cross-talk, is symmetric: what of a "
      "cross-talk is not symmetric is a rotation that no weight can tell from R (polar "
      "decomposition). The correction needs their product alone.",
      "Without a known weight the scale is not known: a heavier tool under a sensor of less gain "
      "shows the same. Then the mean gain is taken for 1. Poses with a known weight added (column "
      "load, in kg), or --mass, make it known. The drift needs another temperature. What the poses "
      "do not determine is left out and said; rotation, mass and offset cannot be left out.",
      "Three poses in which the tool hangs in directions that are not in one plane tell rotation, "
      "mass and offset; cross-talk takes six or more, all around. --plan writes the poses that "
      "tell "
      "most (D-optimal), by hand or of the --robot within its joint limits; without any poses it "
      "is "
      "the first plan. Neither collisions nor the way between poses are checked.",
      "On a rigid block the tool stays where it touched: u = u0 - S f, and S, the compliance of "
      "the arm along the recording's axes, is told by presses along as many axes as it has.",
      "hs-import, hs-identify, hs-simulate, hs-compare, hs-diagnose and hs-export apply the result "
      "by --calibration. A recording whose tool turns needs its orientation, in the same columns "
      "as "
      "here, or if it stands still as metadata `orientation: qw,qx,qy,qz`; without, the tool's "
      "axes "
      "are taken for the recording's and its weight stays in the force. Corrected torques (columns "
      "tx,ty,tz) are about the sensor's origin. A sensor that is set to zero after its calibration "
      "has another offset: calibrate it again, or fit sensor-bias or tare."};
  spec.options = options();
  spec.tables = {
      {"Poses (input)",
       {{"fx, fy, fz", "force that the sensor shows [N]"},
        {"qw, qx, qy, qz",
         "orientation of the tool in the base; or one of: " + orientation_columns()},
        {"q1, q2, ...", "with --robot: joint angles, or under the joints' names"},
        {"tx, ty, tz", "torque that the sensor shows [N m], optional"},
        {"temp",
         "temperature of the sensor [degC], optional; it counts from metadata temp_ref, "
         "otherwise from the mean"},
        {"load", "known weight that is added to the tool [kg], optional"},
        {"pose", "rows of one number are one pose, their mean; optional"}}},
      {"Calibration (output)",
       {{"parameter",
         "rotation_x to _z (axis times angle) [rad], crosstalk_xx to _yz, mass [kg], gravity "
         "[m/s2], offset [N], drift [N/K], com [m], torque_offset [N m], torque_drift [N m/K], "
         "weight_at [m], arm_xx to _yz [m/N]"},
        {"value, unit, std_error", "and its standard error, in the same unit"},
        {"lower, upper", "interval of 95 %"},
        {"state", "fitted; given; assumed: not determined"}}},
      {"--plan",
       {{"q1, ..., qw, qx, qy, qz", "the pose"},
        {"down_x, down_y, down_z", "where gravity points in the tool's frame"},
        {"load", "weight to add [kg], where the poses have one"},
        {"tells", "what it makes known better than anything else"}}}};
  spec.examples = {
      {"hs-calibrate --plan plan.csv --plan-poses 12", "Poses for a first calibration."},
      {"hs-calibrate poses.csv --plan more.csv -o cal.csv", "The sensor, and what to record next."},
      {"hs-calibrate poses.csv --rigid rigid.csv -o cal.csv", "And the arm."},
      {"hs-calibrate joints.csv --robot arm.urdf --tip-link sensor -o cal.csv",
       "Poses as joint angles."},
      {"hs-diagnose data.csv --calibration cal.csv --body body.ply --model m0.csv",
       "What is missing once the rig is put right."}};
  spec.see_also = {"hs-import(1)", "hs-diagnose(1)", "hs-effects(7)"};
  return spec;
}

SensorOptions sensor_options(const Arguments& arguments) {
  SensorOptions options;
  options.crosstalk = arguments[flag::crosstalk];
  if (arguments.given(flag::mass)) options.mass = arguments[flag::mass];
  options.gravity = given_gravity(arguments[flag::gravity], flag::gravity.name);
  return options;
}

std::optional<Robot> load_robot(const Arguments& arguments) {
  if (!arguments.given(flag::robot)) return std::nullopt;
  Input input(arguments[flag::robot]);
  return Robot(input.read_all(), input.name(), arguments[flag::root], arguments[flag::tip]);
}

std::string next_command(const Arguments& arguments) {
  if (arguments.output() == "-") return "";
  return "hs-import recording.csv --calibration " + shell_quoted(arguments.output()) +
         " -o data.csv";
}

int run(const Arguments& arguments) {
  const bool poses_given = arguments.input_given();
  if (!poses_given && !arguments.given(flag::rigid) && !arguments.given(flag::plan))
    fail_usage("there is nothing to calibrate from",
               "give a table of poses, --rigid presses.csv, or --plan FILE for poses to record");
  const SensorOptions asked = sensor_options(arguments);
  const std::optional<Robot> robot = load_robot(arguments);
  CalibrationParts parts;
  Calibration calibration;
  StaticPoses poses;
  SensorFit sensor;
  if (poses_given) {
    Input input(arguments.input());
    poses = read_static_poses(input, robot ? &*robot : nullptr,
                              unit_factor(Quantity::kAngle, arguments[flag::angle_unit]));
    sensor = fit_sensor(poses, asked);
    parts.poses = &poses;
    parts.sensor = &sensor;
    parts.doubt = pose_doubt(sensor, poses, asked);
    if (sensor.determined) calibration = calibration_of(sensor, poses, asked);
  }
  calibration.name = arguments.output();

  std::vector<std::unique_ptr<Output>> outputs;  // all complete, or none
  PosePlan plan;
  if (arguments.given(flag::plan)) {
    plan = plan_poses(poses, sensor, asked,
                      {.poses = static_cast<std::size_t>(arguments[flag::plan_poses]),
                       .tilt = arguments[flag::tilt] * std::numbers::pi / 180,
                       .robot = robot ? &*robot : nullptr});
    parts.plan = &plan;
    outputs.push_back(std::make_unique<Output>(arguments[flag::plan]));
    write_pose_plan(outputs.back()->stream(), plan, poses.loads);
  }
  // A plan is an answer to poses that do not suffice; a calibration that was asked for is not
  // there.
  const bool calibrated = sensor.determined || (!poses_given && arguments.given(flag::rigid));
  if (poses_given && !calibrated && (parts.plan == nullptr || arguments.output() != "-")) {
    for (const auto& output : outputs) output->commit();
    fail_input(poses.name, undetermined_words(sensor, poses, parts.doubt),
               parts.plan == nullptr
                   ? "add poses: --plan FILE writes which"
                   : "record the poses of " + arguments.text(flag::plan) + " too");
  }
  Recording presses;
  ArmFit arm;
  if (arguments.given(flag::rigid) && calibrated) {
    Input input(arguments[flag::rigid]);
    presses = read_recording(input);
    for (const std::string& lacks : calibrate_recording(calibration, presses).lacking)
      say(arguments, presses.name + ": " + lacks);
    arm = fit_arm(presses);
    add_arm(arm, presses, calibration);
    parts.presses = &presses;
    parts.arm = &arm;
  }
  if (calibrated) {
    outputs.push_back(std::make_unique<Output>(result_file(arguments)));
    write_calibration(outputs.back()->stream(), calibration);
  }
  for (const auto& output : outputs) output->commit();
  Summary summary = calibration_summary(calibration, parts);
  if (calibrated) summary.next = next_command(arguments);
  // Where a terminal was not given the calibration, that is told instead.
  if (parts.plan != nullptr && (!calibrated || result_is_wanted(arguments)))
    summary.details = "The poses: " + arguments.text(flag::plan);
  tell_answer(arguments, summary);
  return 0;
}

}  // namespace
}  // namespace hapsim

int main(int argc, char** argv) {
  return hapsim::run_tool(hapsim::specification(), argc, argv, hapsim::run);
}
