// What hs-compare takes and gives, for --help and the man page.
#pragma once

#include "calibration_option.h"
#include "cli/tool.h"
#include "formats/format_table.h"
#include "hs-compare/flags.h"
#include "hs-compare/follow.h"
#include "marked_points.h"

namespace hapsim {

inline ToolSpec compare_specification() {
  ToolSpec spec;
  spec.name = "hs-compare";
  spec.task = Task::kModel;
  spec.summary = "measured against simulated forces, and what the difference depends on";
  spec.input = "measured recording CSV (press,t,x,y,z,ux,uy,uz,fx,fy,fz)";
  spec.description = {
      "Subtracts simulated from measured forces, row by row, and tells how large the difference "
      "is, "
      "how it compares with the sensor's noise, where it is largest, and what it depends on: "
      "position, depth, speed, time since contact, session time, temperature, direction, loading "
      "or "
      "unloading, the first or a later press of a place.",
      "The typical error (rmse) is the root of the mean of all squared component residuals: all "
      "rows, the measured components pooled (those that are not 0 in every row). So it compares "
      "with the noise of one component. Per cent "
      "are of the same mean of the measured force, and of its peak.",
      "Noise is the recording's metadata force_noise, otherwise estimated as hs-import does: from "
      "second differences in time, median(|d2|) / (0.6745 sqrt 6), of third ones where presses "
      "have "
      "few rows, or from the samples in the air where their scatter is larger. Without such "
      "samples "
      "it is too small when the noise is not white.",
      "Within a group of rows the measured force is fitted as gain times simulated force; 'too "
      "stiff by 18 %' is a simulated force 18 % too large. Standard errors are clustered by press. "
      "A sentence is told only when pure noise would bring forth any in under 2 of 100 recordings; "
      "the largest is told first and taken off before the next is sought.",
      "The simulated file must have the rows of the measured one in the same order: presses, "
      "contact points and displacements are checked to 0.01 mm.",
      "On a terminal the residuals themselves are not printed unless asked for with -o.",
      "With --follow a stream of rows is compared with a model as they come. The usual error is "
      "learned at the beginning; then a cumulative sum of it, press by press, raises an alarm, "
      "tuned "
      "to the false alarms an hour that are put up with; what the model states of its force at a "
      "place is no change. What follows the alarm tells whether the body has "
      "moved "
      "or is gone, its stiffness has changed or the sensor's zero has; the model goes on with "
      "that, "
      "without a jump in the force. A shift is named from three presses and refined with each "
      "further one, up to fifteen; a changed material is given one factor at once, and its "
      "relaxation is identified anew from whole presses, up to six, where they tell it. What the "
      "model is usually off decides what is noticed: the change of stiffness that goes unnoticed "
      "is "
      "told, and a model that fits better sees more. Along a face a shift rests on how the model's "
      "stiffness goes with the place; there its standard error may be too small.",
      "Of several tools (a column tool_id) each is watched by itself, with the false alarms that "
      "are "
      "put up with. From where two touch at once the rest of their presses is left out, and how "
      "many "
      "lines that are is told.",
      "Where both files have torques of the tool (tqx,tqy,tqz, or of the measured one tx,ty,tz "
      "with "
      "'# torque_at: X Y Z', see hs-identify(1)) they are compared too, with their own noise; a "
      "model that has the forces and misses the torques is said to, and whether the tool seems to "
      "touch at another point.",
      "With --markers and --simulated-markers displacements of marked points are compared too, "
      "with "
      "their own noise, and of each point: a model that has the forces and misses the points is "
      "said to.",
      "Rows of a stream have a column contact, 0 where the tool is off the body; without it every "
      "row is in contact, and a displacement out of the body pulls. SIGINT or SIGTERM ends the "
      "stream; what was answered until then, or before a bad row, is written."};
  spec.options = {
      {.flag = flag::simulated,
       .value = "[NAME=]FILE",
       .help = "Simulated forces of the same rows, from hs-simulate ('-': standard input). Given "
               "several times, the last is compared and the others are drawn beside it.",
       .group = "Input",
       .repeatable = true},
      calibration_option("Input"),
      markers_option("Measured displacements of marked points of the surface "
                     "(point,t,x,y,z,ux,uy,uz; hs-identify(1))."),
      {.flag = flag::simulated_markers,
       .value = "FILE",
       .help = "The same points by the model, from hs-simulate --markers-out.",
       .group = "Input"},
      {.flag = flag::html,
       .value = "FILE",
       .help = "Writes the report: one file that needs no network.",
       .group = "Output",
       .writes = {"html", "htm"}},
      {.flag = flag::figures,
       .value = "PREFIX",
       .help = "Writes the plots as SVG files for papers: PREFIXversions.svg, PREFIXresidual-1.svg "
               "..., PREFIXpress-ID.svg of the six presses with the largest error.",
       .group = "Output"},
      {.flag = flag::json,
       .value = "FILE",
       .help = "Writes numbers, observations and breakdowns as JSON.",
       .group = "Output",
       .writes = {"json"}},
      {.flag = flag::body,
       .value = "FILE",
       .help = "Body from hs-tetmesh, another mesh of tetrahedra (" +
               names_to_read(Content::kTetrahedra) + "), or a surface (" +
               names_to_read(Content::kTriangles) + "), for --ply and the report's picture.",
       .group = "Input"},
      {.flag = flag::ply,
       .value = "FILE",
       .help =
           "Writes the body's surface coloured by the local error (vertex properties red, green, "
           "blue, and float error [N], NaN where nothing was pressed near). Needs --body.",
       .group = "Output",
       .writes = {"ply"}},
      {.flag = flag::reach,
       .value = "M",
       .help = "How far from a pressed position the surface is coloured [m]; otherwise one and a "
               "half times the usual distance between positions.",
       .group = "Output",
       .minimum = 1e-6,
       .maximum = 10},
      {.flag = flag::history,
       .value = "FILE",
       .help = "CSV of model versions and their errors (any columns; step, model, effects, rmse, "
               "heldout, noise are known), shown in the report.",
       .group = "Input"},
      {.flag = flag::diagnosis,
       .value = "FILE",
       .help = "effects.csv from hs-diagnose, shown in the report; NAME=FILE names the model "
               "version it belongs to, and may be repeated. The last one gives the verdict.",
       .group = "Input",
       .repeatable = true},
      {.flag = flag::model,
       .value = "FILE",
       .help = "model.csv of the compared version: the report shows its parameters with their "
               "intervals, and its regions on the body. With --follow the model that the stream is "
               "compared with.",
       .group = "Input"},
      {.flag = flag::inside,
       .value = "FILE",
       .help = "The body with its image from hs-identify --image image.ply: the report cuts it "
               "open, with the standard errors of the image beside it, pale where no difference "
               "from the model is seen and hatched where the presses do not tell, and says how "
               "finely and how deep it sees. Needs --html; stands for --body where that is not "
               "given.",
       .group = "Input"},
      {.flag = flag::junit,
       .value = "FILE",
       .help = "Writes the verdict of --fail-above as JUnit's XML, for CI servers.",
       .group = "Output",
       .writes = {"xml"}},
      {.flag = flag::title, .value = "TEXT", .help = "Title of the report.", .group = "Output"},
      {.flag = flag::fail_above,
       .value = "X",
       .help = "Exit code 1 when the typical error exceeds X: 0.05N, 5% (of the force's rms), or "
               "1.5noise.",
       .group = "Output"}};
  for (const Option& option : follow_flags()) spec.options.push_back(option);
  spec.tables = {
      {"Residuals (output)",
       {{"...", "the columns of the measured recording"},
        {"sx, sy, sz", "simulated force [N]"},
        {"rx, ry, rz", "measured minus simulated force [N]"},
        {"stqx, stqy, stqz", "simulated torque about the tip [N m], where both have torques"},
        {"rtqx, rtqy, rtqz", "measured minus simulated torque [N m]"}}},
      {"Changes (--events)",
       {{"begun, alarm, named", "when it changed, was noticed and was named [s]"},
        {"change", "moved, gone, material, sensor or unexplained"},
        {"stiffness",
         "factor of all moduli from now on; of a moved body as the presses before have shown it"},
        {"bias_x ...", "of the sensor [N]"},
        {"shift_x ...", "of the body [m]"},
        {"error", "left by the correction [N]"},
        {"shift_error_x ...", "standard error of the shift [m]: large where no press tells"},
        {"presses", "that the correction rests on; a shift is refined with each"},
        {"updated",
         "when it was known to 0.4 of the usual error [s]; empty before, and where the error has "
         "stayed above twice the usual: the correction does not explain it"},
        {"relaxation", "factor of the moduli that relax, beside stiffness"},
        {"slowness", "factor of their times"},
        {"tool_id", "the tool that noticed it, where the stream has several"}}}};
  spec.examples = {
      {"hs-compare data.csv --simulated forces.csv -o residuals.csv", "Residuals and a summary."},
      {"hs-simulate data.csv --body body.ply --model m0.csv | hs-compare data.csv --simulated - "
       "--body body.ply --html report.html -o residuals.csv",
       "The report, from a model at once."},
      {"hs-compare data.csv --simulated m0=f0.csv --simulated m1=f1.csv --history history.csv "
       "--diagnosis effects.csv --html report.html -o residuals.csv",
       "Two model versions in one report."},
      {"hs-compare data.csv --simulated forces.csv --fail-above 1.5noise -q -o residuals.csv",
       "A check in CI."}};
  spec.examples.push_back(
      {"hs-compare --follow - --body body.ply --model m.csv --events changes.csv",
       "Watches a robot's stream."});
  spec.see_also = {"hs-simulate(1)", "hs-diagnose(1)", "hs-identify(1)"};
  return spec;
}

}  // namespace hapsim
