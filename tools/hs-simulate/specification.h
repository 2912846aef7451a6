// The command line of hs-simulate.
#pragma once

#include "answer.h"
#include "common_options.h"
#include "hs-simulate/flags.h"
#include "marked_points.h"
#include "prepared_options.h"

namespace hapsim {

inline ToolSpec simulate_specification() {
  ToolSpec spec;
  spec.name = "hs-simulate";
  spec.task = Task::kForces;
  spec.summary = "contact forces of a model along a motion";
  spec.input = "motion or recording CSV (press,t,x,y,z,ux,uy,uz; forces in it are ignored)";
  spec.description = {
      "Writes the recording with the forces replaced by the model's. Each contact position is "
      "solved on second-order tetrahedra graded to the tool's rim; relaxation is integrated "
      "exactly for motion that is straight between samples "
      "and for any time steps.",
      "Measured and simulated recordings have one format, so the output feeds hs-compare and "
      "hs-identify alike. Where the motion has places that the model was not fitted to, this mode "
      "tells what the model says of such places (its metadata unseen_band, see hs-identify(1)), "
      "which stands in the recording's metadata too. Its metadata mesh_uncertainty is the share of "
      "the force that the contact "
      "meshes leave open, the median over the positions.",
      "Torques (--torques) are those about the tool's tip, the middle of its flat face, which "
      "moves with it: by finite elements a lever of each place times the body's force, to a few "
      "hundredths of a millimetre (metadata torque_uncertainty, root mean square over the rows [N "
      "m]). They are of a flat tool that does not turn, on a body that is linear, relaxes by one "
      "law and has no layers or inclusions; what the sensor does acts on the force alone. Where a "
      "model does not say what they are, torques of the motion are left out, with a line that "
      "says why. The live mode's are those of a half-space beside them: the same far from edges "
      "and regions.",
      "Displacements of marked points of the surface (--markers, --markers-out) are those of the "
      "contacts' meshes, interpolated in their surface elements, at the times of the table, or at "
      "all of the motion where it has points alone (point,x,y,z). They are of a flat tool that "
      "does not turn "
      "and moves as given, on a body that is linear, relaxes by one law and has no layers or "
      "inclusions; another model is refused. The table's metadata marker_uncertainty is what the "
      "two meshes "
      "leave open of a component, root mean square over the rows [m].",
      "With --live every motion line is answered by its force line at once, from a body prepared "
      "beforehand: its stiffness is sampled on contact meshes as those of the batch mode, where "
      "edges, curvature, thin parts, the support and regions ask for it, and interpolated by a "
      "Gaussian process until what lies between the samples is expected to be within --accuracy. "
      "At most 2500 places are tried (most bodies need 70 to 200, some 10 to 20 s of two "
      "processors; "
      "one with limbs and thin parts some four minutes), and it is said where they "
      "do not reach that accuracy; a second start finds them in the cache. What the samples expect "
      "of themselves, root mean square over the surface, stands in the metadata off_contacts, as a "
      "share of the force. Limbs and thin parts, which yield as a whole, are known from one coarse "
      "mesh beside the samples. "
      "The header comes first, and comes back when the body is ready. "
      "Lines are press,t,x,y,z,ux,uy,uz[,contact], or t,x,y,z, the positions of the tool's tip, of "
      "which contacts are found, with temp or without. Every effect runs live, those of the force "
      "sensor too, and at the positions of --contacts the forces are those of the batch mode (to "
      "1e-6 of the largest; where a step cannot be, hs-effects(7) says why; but of "
      "--large-strain). A body that has "
      "moved (shift) needs --contacts. Every touch of a tip "
      "is a press of its own; lines before the first one are of press 0. SIGINT or SIGTERM ends "
      "the motion; what was answered until then, or before a bad row, is written.",
      "With --large-strain a body of finite strain (hyperelastic, finite 1) has the forces of "
      "finite elements that were pressed beforehand, not those of a law of what lies under the "
      "tool, which is off beside edges and deep in thin bodies. At each of some tens of places "
      "thirteen ways down to 2.5 tool radii, or 0.35 of the way through, and sideways to a quarter "
      "of a radius and half the depth, a radius at most, give an energy; between places it is "
      "interpolated until those left out are foretold within --accuracy, or 96 were pressed (it "
      "says what was reached). That takes some 3 to 13 s of a processor a place, by --threads at "
      "once; each place is kept in the cache when it is done, so a start that was ended goes on. "
      "With --contacts the places lie within three radii of those alone. A body that relaxes "
      "(viscoelastic, fractional) remembers its stresses, as elements of finite strain do, not the "
      "force: each place then has what the stresses of every state do at every other, too (some "
      "three times as long a place), and along nine fields what the inside then does otherwise "
      "than at rest. What these leave, up to 1 % of the largest force where the tool leaves and "
      "the "
      "force passes through zero, is in the uncertainty. Two places are solved by finer elements, "
      "too; how far these are apart at each depth is in the uncertainty of all: where the surface "
      "folds beside the tool (a Neo-Hookean body, s = 0, from one radius or so on) every mesh "
      "folds in its way, and they are 4 to 17 % apart at 30 % of the thickness. Where folds keep "
      "what is "
      "remembered from a smooth law, a place is sampled a third as far aside, and what "
      "goes farther is flagged. A flat tool that slips (friction) is pressed so too, at two of "
      "the places (at one, and by coarse elements alone, from --accuracy 0.1 on): its rim slips "
      "long before it does, which takes up to a fifth of the normal force. Rings of springs that "
      "slip, drawn inwards by the depth, are fitted to these and laid under the held force of "
      "every place; what they leave of the presses is in the uncertainty. To 0.75 radii, where "
      "elements of a quarter of a radius converge, the force is compared with --full (to 0.65), "
      "of a block (nu 0.4, s 0.2, at rest) at a friction of 0.4: 98 % of 380 samples within 2 %, "
      "also along kinds of ways that no "
      "place was pressed along, and all within what is stated, some 3.5 %. Where a tool has been "
      "deeper, until it leaves, other rings take over, of elements of half a radius, to 2.25 "
      "radii: "
      "62 % of 239 samples are within 2 % of such elements, which are up to 4 % too stiff "
      "themselves, and 99 % within what is stated, some 7.7 % (at 0.8: 75 and 62 %, and 99 and "
      "100 %). Deeper still rows are flagged 32, "
      "and for every radius the uncertainty grows by what slip takes. Where the tool was not seen "
      "to slip as a whole (large "
      "friction), rows that bear more than was seen are flagged 32. The sensor and all else act "
      "on that force as on the linear one. Farther than was pressed the force goes on along its "
      "tangent, with 32 in beyond.",
      "With --hand the forces go through the last layer before a hand: within the limits they are "
      "what they were; where no motion comes for --hold, lines go out of their own until the force "
      "is zero, and an end after that has exit code 5; so where the loop itself does not answer. "
      "The "
      "last line is zero, whatever ends the motion. Columns safety, ax, ay, az say why a force is "
      "not "
      "what was asked for, and that (atqx, atqy, atqz: the torque); records of tip and press have "
      "256 times safety in contact. Lines and records that nobody asked for have 512 in safety; of "
      "records with a header none goes to version 2 but the last. Several tools have limits each, "
      "a "
      "torque that of its force at the device's lever, 0.03 m.",
      "Forces deeper than half of the way through the body, or than the model was fitted to (its "
      "metadata depth), are said to be so; presses through the body are an error. Live there is a "
      "column beyond: 1 for such a depth; 2 where the tool is held at nine tenths of the way, ux, "
      "uy, uz and the force being those of the tool as it is held; 4 beside the support, where no "
      "contact mesh can be made and the force is extrapolated; 8 farther from the places that the "
      "model was fitted to (its metadata places, where many are some of them, with all others "
      "within "
      "its metadata covers) than its metadata reach: than nine in ten of them "
      "are from their next one, and than two tool radii; 16 faster than it was fitted (its "
      "metadata speed; over ways of 10 ms); 32 farther into the surface than 1.6 tool radii or "
      "along it than half of one, to which the linear law was compared with finite strain (a "
      "whole radius with hyperelastic); sums of these. What a model does not say of itself is "
      "not flagged. Of --large-strain 32 is beyond what was pressed beforehand, a slip of more "
      "than half a radius, and every row of a ball: places were pressed by a flat tool, and the "
      "uncertainty says nothing of another. With --uncertainty "
      "there is a column uncertainty besides: the standard "
      "uncertainty of the force [N] that the "
      "interpolation and the meshes leave, 1.96 times of which covers the difference to the batch "
      "mode in some 95 of 100 places; the model's own error is not in it.",
      "A column contact is 0 where the tool is off the body, and the force zero; without it every "
      "row is in contact, and a displacement out of the body pulls.",
      "Rows of the viscoelastic effect with a region above 0 give each region Maxwell elements of "
      "its own (none where it has no rows), in every mode; without such rows all regions have "
      "those "
      "of region 0. Some thirty bodies are solved for it, and the forces are exact in time.",
      "A model with E of regions 1, 2, ... and no key points of the effect regions has these "
      "moduli "
      "where the body's tetrahedra have these numbers (hs-tetmesh --region, or the regions of "
      "another program's mesh), in every mode; region 0 is what has no other. In the meshes of "
      "contacts an element that a boundary cuts is of the mixture of its moduli, by volume. A "
      "number of which the model has no E is refused; E of a number that the body does not have is "
      "told to act nowhere. Compared with CalculiX this was for regions that are no sheets (bench/"
      "regions): of a thin one contact meshes take a part only, which is told, but is in no stated "
      "error.",
      "With --binary, motion and forces are records of fixed size, little-endian, without header "
      "or "
      "padding: i is an integer of 32 bits, the others are numbers of 64 bits (IEEE 754) in SI "
      "units. In, tip (32 bytes): t x y z; press (64 bytes): i press, i contact (0: in the air), t "
      "x "
      "y z ux uy uz. Out (88 bytes): i press, i contact (0 in the air, else 1 and twice what 1, 2 "
      "and 4 of beyond would be), t x y z ux uy uz fx fy fz. Give --tool-radius.",
      "Live, up to four tools press one body at once with a column tool_id, lines of one time, one "
      "a tool, being one step: pressing with one moves the surface under the others. Say with "
      "--tools, or in metadata tools, how many there are, so that a step is answered as soon as "
      "its "
      "last line is there; else it is when the next begins. Two tools nearer than twice the radius "
      "have 64 added to beyond. Columns thx, thy, thz are the tool's rotation vector in the body's "
      "frame [rad] (with contact points: since it touched); a flat tool's patch turns with it, and "
      "tqx, tqy, tqz is the torque on the tool about its tip, the middle of the patch [N m]. Of "
      "tips, "
      "touches of all tools are counted together, and before its first a tool has press 0, -1, "
      "...; "
      "so each tool's lines are presses of their own to every tool that reads them. Contact laws "
      "and the sensor change forces alone; torques are those of the linear body and relax as it "
      "does.",
      "Records of --binary extended are versioned, and of one or more tools with orientation, "
      "torque "
      "and what a force is beyond. Both directions begin with a header of 32 bytes: 8 bytes "
      "hapsimIO, i version, i bytes of a record, i tools, i kind (0: tips, 1: presses), 8 bytes of "
      "0. Who asks gives the newest version that it knows; the answer says the one that is spoken "
      "(4), and how large its records are. What a record has beyond its version is passed over. In "
      "(16 + 80 tools bytes): t, temp (NaN: not known); of each tool i press, i contact, x y z, ux "
      "uy uz, thx thy thz. Out (16 + 144 tools bytes): t, temp; of each tool i press, i contact, i "
      "beyond, i safety, x y z, ux uy uz, thx thy thz, fx fy fz, tqx tqy tqz, and the standard "
      "uncertainty of the force (NaN: not known); from version 3 on then 48 tools bytes more, of "
      "each "
      "tool ax ay az, atqx atqy atqz; from version 4 on beyond has 8, 16 and 32. Records of tip "
      "and press stay as they were, so older programs go on.",
      "A model of hs-identify --acfm is springs and dashpots by position; between positions they "
      "are "
      "interpolated by inverse distances. It is answered by the same flags, in batch and live.",
      "With --own-mesh nothing is meshed: the body's own tetrahedra, of either order, are pressed "
      "at the nodes under the tool, by a sparse factorisation or by conjugate gradients, whichever "
      "is faster for the size (it says which). The force is as good as that mesh is fine there; "
      "elements "
      "of first order are too stiff where Poisson's ratio is above 0.4.",
      "With --full finite elements are solved at every step, tool and body as they are: a body of "
      "hyperelastic (finite) at finite strain, a tip of the effect tip as a ball whose contact "
      "grows, friction on the contact itself, relaxation in every element; each press on a mesh "
      "graded to its tool's rim, or with --own-mesh on the body's. It takes seconds a step and is "
      "what the quick laws are judged by. Several tools press one body at once with a column "
      "tool_id: rows of one press and time, one a tool, are one step, and tools that press at once "
      "in presses of their own, as live output has them, press one body too."};
  spec.options = experiment_flags();
  for (Option& option : spec.options)
    if (option.name() == flag::body.name) {
      option.required = false;
      option.help += " An analytical model needs it only where contacts are to be found.";
    }
  spec.options.push_back({.flag = flag::model,
                          .value = "FILE",
                          .help = "Model from hs-identify, also one of its --acfm.",
                          .group = "Input",
                          .required = true});
  spec.options.push_back({.flag = flag::add_noise,
                          .value = "N",
                          .help = "Adds Gaussian noise of this standard deviation [N] to every "
                                  "force component and declares it as force_noise.",
                          .group = "Output",
                          .minimum = 0});
  spec.options.push_back(
      {.flag = flag::torques,
       .help = "Writes the torque of the body on the tool about its tip too, tqx,tqy,tqz [N m]; "
               "of itself where the motion has these columns.",
       .group = "Output"});
  spec.options.push_back({.flag = flag::torque_noise,
                          .value = "N",
                          .help = "Adds Gaussian noise of this standard deviation [N m] to every "
                                  "torque component and declares it as torque_noise.",
                          .group = "Output",
                          .minimum = 0});
  spec.options.push_back(
      markers_option("Marked points of the surface (point,x,y,z, or a table as hs-identify(1) "
                     "takes it, whose times are then kept).",
                     "Output"));
  spec.options.push_back({.flag = flag::markers_out,
                          .value = "FILE",
                          .help = "Writes their displacements by the model.",
                          .group = "Output",
                          .writes = kTableExtensions});
  spec.options.push_back({.flag = flag::marker_noise,
                          .value = "M",
                          .help = "Adds Gaussian noise of this standard deviation [m] to every "
                                  "component of these and declares it as marker_noise.",
                          .group = "Output",
                          .minimum = 0});
  spec.options.push_back({.flag = flag::seed,
                          .value = "N",
                          .help = "Seed of the added noise.",
                          .group = "Output",
                          .default_text = "1",
                          .minimum = 0});
  spec.options.push_back({.flag = flag::own_mesh,
                          .help = "Presses the body's own mesh instead of meshes of its contacts.",
                          .group = "Solution"});
  spec.options.push_back({.flag = flag::full,
                          .help = "Finite elements at every step; a step that does not converge "
                                  "ends it (exit 4).",
                          .group = "Solution"});
  spec.options.push_back({.flag = flag::force_control,
                          .help = "The motion's forces are given, its displacements are found and "
                                  "written in the place of its columns ux, uy, uz; --own-mesh by "
                                  "any --solver.",
                          .group = "Solution"});
  spec.options.push_back({.flag = flag::solver,
                          .value = "NAME",
                          .help = "Own mesh: how it is solved.",
                          .group = "Solution",
                          .default_text = "by-size",
                          .choices = {"by-size", "direct", "iterative"}});
  spec.options.push_back({.flag = flag::vtu,
                          .value = "PREFIX",
                          .help = "Own mesh: writes PREFIX-ROW.vtu with displacement, stress and "
                                  "energy density at the deepest row of each press, or at --rows.",
                          .group = "Output"});
  spec.options.push_back({.flag = flag::rows,
                          .value = "LIST",
                          .help = "Rows of the motion to write with --vtu, from 1: 20,40,60.",
                          .group = "Output"});
  spec.options.push_back({.flag = flag::live,
                          .help = "Answers each line as it comes; latencies on standard error.",
                          .group = "Live"});
  spec.options.push_back({.flag = flag::contacts,
                          .value = "FILE",
                          .help = "Live: a recording whose contact positions are solved finely "
                                  "before the first line.",
                          .group = "Live"});
  spec.options.push_back(accuracy_option("Live"));
  spec.options.push_back({.flag = flag::large_strain,
                          .help = "Live: large strain (hyperelastic with finite = 1) by finite "
                                  "elements that were pressed beforehand, instead of by a law of "
                                  "what lies under the tool.",
                          .group = "Live"});
  spec.options.push_back({.flag = flag::uncertainty,
                          .help = "Live: the standard uncertainty of each force, in a column.",
                          .group = "Live"});
  spec.options.push_back({.flag = flag::rate,
                          .value = "HZ",
                          .help = "Live: takes the lines at this rate by the clock, with memory "
                                  "locked and real-time scheduling where they are permitted.",
                          .group = "Live",
                          .minimum = 0.001,
                          .maximum = 100000});
  spec.options.push_back({.flag = flag::binary,
                          .value = "KIND",
                          .help = "Live: records instead of lines in and out; tip positions or "
                                  "presses come in, or records of a version and size that they "
                                  "say.",
                          .group = "Live",
                          .choices = {"tip", "press", "extended"}});
  spec.options.push_back({.flag = flag::tools,
                          .value = "N",
                          .help = "Live: how many tools the lines are of, one each at every time.",
                          .group = "Live",
                          .minimum = 1,
                          .maximum = 4});
  for (const Option& option : hand_flags()) spec.options.push_back(option);
  spec.options.push_back(answer_option("Output"));
  spec.examples = {
      {"hs-simulate data.csv --body body.ply --model m0.csv -o forces.csv", "Forces of a model."},
      {"hs-simulate data.csv --body body.ply --model m0.csv | hs-compare data.csv --simulated -",
       "Where the model fails."},
      {"hs-simulate --live --rate 1000 motion.csv --contacts data.csv --body body.ply --model "
       "m0.csv",
       "A recorded motion at 1 kHz."}};
  spec.writes.emplace_back("bin");  // --binary
  spec.see_also = {"hs-identify(1)", "hs-compare(1)", "hs-diagnose(1)"};
  return spec;
}

}  // namespace hapsim
