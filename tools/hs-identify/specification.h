// The command line of hs-identify.
#pragma once

#include "answer.h"
#include "common_options.h"
#include "effects/catalogue.h"
#include "hs-identify/boundary.h"
#include "hs-identify/flags.h"
#include "hs-identify/follow.h"
#include "hs-identify/image.h"
#include "hs-identify/library.h"
#include "hs-identify/recordings.h"
#include "hs-identify/search.h"
#include "hs-identify/until.h"
#include "marked_points.h"
#include "thinned.h"

namespace hapsim {

inline std::string effect_names() {
  std::string names;
  for (const Effect* e : catalogue()) names += (names.empty() ? "" : ", ") + e->card().name;
  return names;
}

// Effects that several bodies, or several tools, cannot share.
inline std::string unshared(bool EffectCard::*of_one) {
  std::string names;
  for (const Effect* e : catalogue())
    if (e->card().*of_one) names += (names.empty() ? "" : ", ") + e->card().name;
  return names;
}

inline ToolSpec identify_specification() {
  ToolSpec spec;
  spec.name = "hs-identify";
  spec.task = Task::kModel;
  spec.summary = "identify a model from a recording of presses";
  spec.input = "recording CSV (press,t,x,y,z,ux,uy,uz,fx,fy,fz)";
  spec.description = {
      "Fits the free parameters of a model to a recording by bounded Gauss-Newton least squares "
      "with exact derivatives, and writes model.csv with standard errors. Starts from nothing "
      "(--effects) or from a model (--model), to which effects are added or from which they are "
      "removed. The error on data that the fit has not seen comes from refitting with whole "
      "contact positions left out in turn (whole presses, when there is only one position).",
      "Interrupted (SIGINT, SIGTERM) while it fits, it writes the best model so far with the "
      "metadata 'converged: no' and ends with exit code 4; a search from many starts can go on "
      "from there (--resume). While --effects auto diagnoses and adds, or the error on unseen data "
      "is found, it writes the last model that was fitted, with the metadata 'interrupted'. A "
      "second signal ends it at once.",
      "--acfm identifies springs and dashpots at the pressed positions instead, between which "
      "hs-simulate interpolates: no finite elements, so it needs no relaxation common to all "
      "directions, and answers in well under a microsecond. Recordings or forces of hs-simulate "
      "serve alike. A direction that was not moved is derived from the others.",
      "--follow identifies from a stream while it comes: forces are linear in the moduli, so unit "
      "forces of the prepared body and least squares that grow row by row cost about one force "
      "evaluation a row. SIGINT or SIGTERM ends the stream; what was told until then is written.",
      "Recordings of several bodies of one material, or by tools of several radii, are fitted "
      "together with --data and --body: all share the parameters. What belongs to one body "
      "(" +
          unshared(&EffectCard::one_body) + ") or to one tool (" + unshared(&EffectCard::one_tool) +
          ") is refused where there are several.",
      "What the recording's header says of the tool is used: with `tool: sphere` a new model "
      "presses "
      "with a ball of tool_radius, whose curvature (tip) is fixed there and not fitted, unless tip "
      "is among the effects. The body is then solved for a flat disc about as wide as the contact "
      "(metadata contact_radius, which goes with the model), and of at most five presses the depth "
      "at which they began (touch) is fitted too, unless it is removed (--remove touch).",
      "A flat tool that covers the body compresses it between plates, bonded to both: samples "
      "beyond a strain of 0.3, to which finite strain (hyperelastic) was verified, are left out, "
      "here and in hs-diagnose.",
      "Of places that nobody has pressed it is said how far the forces may be off there: metadata "
      "unseen_band, a share of the force's root mean square at a place, the noise aside, and "
      "unseen_chance, with which it holds for a place like those that were pressed, among them. It "
      "is an order statistic of the errors at whole places left out in turn (--folds), so it needs "
      "no law of them, and 19 places for 95 %; of n fewer ones it is their largest error, with a "
      "chance of n/(n+1). Nothing is said where an offset of each press (tare) is solved for, or a "
      "component of the force was not measured.",
      "Measured torques of a six-axis sensor count beside the forces where the recording has them: "
      "tqx,tqy,tqz [N m], of the body on the tool about its tip, the middle of its flat face, in "
      "the frame of the forces; or tx,ty,tz about the sensor's origin, with '# torque_at: X Y Z', "
      "where that lies from the tip [m]. Each has its own noise (metadata torque_noise [N m], else "
      "measured from the data), and both are then weighed by what mesh and shape are worth at each "
      "position (of a lever, --floor times the tool's radius, and what its two meshes differ by). "
      "The forces alone are fitted first; of a model that leaves several times the noise both "
      "noises count as many times larger. A torque about the tip is a lever of the place times the "
      "force, in which a common modulus drops out: it tells Poisson's ratio, and of stiffnesses "
      "beside the tool next to nothing. Places of a block, a tool of 3 mm, beside forces that are "
      "weighed by position as well, forces of 1 N to 4 "
      "mN, torques to 0.016 N mm: the standard error of nu falls by a fifth where presses are "
      "slanted too, by two fifths where all go straight down and some are near edges (0.052 to "
      "0.030; of E from 3.2 to 1.9 %), and stays hopeless (0.43, 0.32) where all are in the "
      "middle. "
      "Torques do not count with a ball, a tool that turns (thx,thy,thz) or covers the body, "
      "friction and other laws of the contact, finite strain, layers and inclusions: a line says "
      "so. Nor do they with a dashpot at the tool, or where the sensor does more to the forces "
      "than "
      "to add an offset (a lag, a rotation), since nobody knows what it does to the torques. A "
      "tare takes each press's mean out of its torques too. Held-out errors are of fits to the "
      "forces alone. Torques in N mm, or about another point, are refused.",
      "Marked points of the surface that a camera sees while the tool presses count too "
      "(--markers): a table of their displacements by time, each with its own noise. Under a "
      "bonded "
      "flat tool a point moves by a constant matrix of place and point times the tool's "
      "displacement; Young's modulus drops out of it, and so does how it relaxes. Times are "
      "matched "
      "to the recording's, between whose rows the tool's displacement is interpolated; the clocks "
      "are taken for one, and no offset between them is sought. The matrix is worth what its two "
      "meshes differ by and --floor of its size. By the Fisher information of twelve points seen "
      "to "
      "0.02 mm, on a block pressed by a tool of 3 mm to 1.5 mm, beside forces that are weighed by "
      "position, standard errors fall: where all presses go straight down, of nu from 0.49 to "
      "0.003 "
      "in the middle, and from 0.064 to 0.005 near edges (of E from 40 to 0.6 and from 3.7 to 0.6 "
      "%, beside the gain that all positions share, --floor once more); where they are slanted "
      "too, "
      "of nu from 0.0073 to 0.0026 or 0.0038, and of E not at all. "
      "Of the ratio of two regions' moduli, and of where they meet, to less than the half with "
      "presses straight down, by a fifth with slanted ones; of how thick a layer of 12 mm is on "
      "its "
      "support from 1.2 to 0.05 mm with slanted presses. A wrong border may pass for another "
      "modulus beyond it, where that is free and all presses are on one side. "
      "Points do not count with a ball, a tool that turns (thx,thy,thz) or covers the body, "
      "several "
      "tools at once, where the tool's own motion is changed (touch, slack, a yielding arm), with "
      "friction and other laws of the contact, finite strain, plasticity, draining, layers, "
      "inclusions and supports, and where regions relax each in its own way: a line says so. "
      "Tables in mm without the unit in the header, and points off the surface, are refused. "
      "Boundaries (--refine-boundary) and the error on unseen data are of forces alone.",
      "--constrain keeps relations between the parameters: = or <=, >= between sums, products, "
      "quotients and powers (+ - * / ^ and parentheses). Parameters are named as the model file "
      "has them: elastic.E, elastic.E[2] of region 2, viscoelastic.tau1, inclusion.z; the effect "
      "may be left out where one effect alone has such a parameter. A region may also be called by "
      "its name (--region-names, or the model's metadata region_names): E(tumour) = 3*E(liver), or "
      "by a point of it: E(20 mm, 25 mm, 10 mm), of which a map over the plan view (regions) needs "
      "x and y alone; of several bodies the point is in the first, and beside a layer or an "
      "inclusion points are refused. Recordings that are fitted "
      "together share their parameters, and so the relations. Numbers are in SI or carry a "
      "unit (50 kPa, -5 mm). Where the fit without them keeps them, it stays as it is. Else it "
      "goes on from there by Gauss-Newton steps under the constraints, and what binds is told with "
      "what it costs: by how much the error would fall if that one were left out, and by how many "
      "standard errors the data contradict it. Standard errors are then along what the binding "
      "ones leave free. The model has them as the metadata constraints and binding. Constraints "
      "that contradict each other or the bounds are refused, and those that do are named.",
      "The model says what it was fitted to: metadata depth (the deepest press), speed (the "
      "fastest "
      "in contact, over ways of 10 ms), places (x y z of up to 64 of them) and reach (how far from "
      "these a place is still among them), all in SI units. hs-simulate --live says of each force "
      "what it is beyond.",
      "Effects: " + effect_names() + "."};
  spec.options = experiment_flags();
  std::erase_if(spec.options, [](const Option& o) { return o.name() == flag::body.name; });
  const std::vector<Option> own{
      {.flag = flag::effects,
       .value = "LIST",
       .help =
           "Effects of a new model, separated by commas. auto: elastic, or --model, is diagnosed "
           "and what is missing added, as long as that helps on unseen presses; of few presses, "
           "as long as it foretells the rest of each from its first part (hs-diagnose(1)). What "
           "judged is told and written as the metadata heldout_by.",
       .group = "Model",
       .default_text = body_effect().card().name,
       .repeatable = true},
      {.flag = flag::model,
       .value = "FILE",
       .help = "Model to start from, instead of --effects.",
       .group = "Model"},
      {.flag = flag::add,
       .value = "LIST",
       .help = "Effects to add; viscoelastic already there gets one more term.",
       .group = "Model",
       .repeatable = true},
      {.flag = flag::diagnosis,
       .value = "FILE",
       .help = "Diagnosis from hs-diagnose: adds the effects that it calls missing, in its order.",
       .group = "Model"},
      {.flag = flag::remove,
       .value = "LIST",
       .help = "Effects to remove.",
       .group = "Model",
       .repeatable = true},
      {.flag = flag::fix,
       .value = "LIST",
       .help = "Parameters to hold, with a value or without: nu=0.45, elastic.E, viscoelastic.",
       .group = "Model",
       .repeatable = true},
      {.flag = flag::free,
       .value = "LIST",
       .help = "Parameters to free again.",
       .group = "Model",
       .repeatable = true},
      {.flag = flag::constrain,
       .value = "FORMULA",
       .help = "A relation that the fit keeps between the model's parameters: 'E >= 2*E1', '3*tau1 "
               "<= tau2', '1 <= E[1]/E <= 4', 'E + E1 = 50 kPa'; several may also stand in one, "
               "apart by semicolons or lines.",
       .group = "Model",
       .repeatable = true},
      {.flag = flag::region_names,
       .value = "LIST",
       .help = "Names of regions 0, 1, ... for --constrain, apart by commas: liver,tumour. The "
               "model keeps them as the metadata region_names.",
       .group = "Model"},
      {.flag = flag::terms,
       .value = "N",
       .help = "Maxwell terms of viscoelastic when it is added, 1 to 5; or auto: one more as long "
               "as both the information criterion and the error on data that the fit has not seen "
               "fall; auto:3 offers at most three.",
       .group = "Model",
       .default_text = "1"},
      {.flag = flag::windows,
       .value = "LIST",
       .help = "Windows of the relaxation times [s], disjoint, from short to long, one a term: "
               "0.05:1,2:30.",
       .group = "Model",
       .repeatable = true},
      {.flag = flag::regions,
       .value = "N",
       .help =
           "Number of regions when regions is added: a number, auto (what the positions' own "
           "moduli ask for; two with a straight, round or other smooth boundary unless more "
           "are told clearly), sites (each position its own stiffness) or labels (those that the "
           "body's tetrahedra are numbered with, hs-tetmesh --region, each with its own E; the "
           "model then has no key points).",
       .group = "Model",
       .default_text = "auto"},
      until_flag(),
      boundary_flag(),
      {.flag = flag::acfm,
       .value = "N",
       .help = "An analytical contact force model instead of one of effects: at every position and "
               "in every direction a spring and N Maxwell elements; --windows bounds their "
               "relaxation times.",
       .group = "Model",
       .minimum = 0,
       .maximum = 8},
      {.flag = flag::stiffening,
       .help = "With --acfm: the springs stiffen with the displacement, exponentially.",
       .group = "Model"},
      {.flag = flag::folds,
       .value = "N",
       .help = "Parts in which positions are held out; 0: no held-out error.",
       .group = "Fit",
       .default_text = "6",
       .minimum = 0,
       .maximum = 1000},
      {.flag = flag::history,
       .value = "FILE",
       .help = "CSV of model versions and their errors to which this one is added; heldout is of "
               "what heldout_by says.",
       .group = "Output",
       .writes = kTableExtensions},
      {.flag = flag::locations,
       .value = "FILE",
       .help =
           "Writes location samples (CSV): E, and nu where the presses tell it, of each contact "
           "position by itself, the model's other parameters held; input of hs-cluster.",
       .group = "Output",
       .writes = kTableExtensions},
      {.flag = flag::field,
       .value = "FILE",
       .help = "Writes the field of learned-place (CSV): the factor of the stiffness with its 95 % "
               "band and the power of the depth, at the pressed places and all over the body.",
       .group = "Output",
       .writes = kTableExtensions},
      {.flag = flag::curves,
       .value = "FILE",
       .help =
           "Writes what the curves of no law (learned-depth, -kernel, -axes, -gain, -drift) have "
           "learned (CSV): each with its 95 % band.",
       .group = "Output",
       .writes = kTableExtensions},
      image_flag(),
      lumps_flag(),
      {.flag = flag::robust,
       .value = "LOSS",
       .help = "Discounts readings that lie far off: huber little by little, tukey in the end "
               "altogether.",
       .group = "Fit",
       .default_text = "none",
       .choices = {"none", "huber", "tukey"}},
      markers_option("Displacements of marked points of the surface, seen while the tool presses: "
                     "point,t,x,y,z,ux,uy,uz[,press]."),
      {.flag = flag::ignore_torques,
       .help = "Leaves measured torques of the tool (tqx,tqy,tqz) out.",
       .group = "Input"},
      {.flag = flag::profile,
       .help =
           "Tells the 95 % interval of each parameter from the profile of the likelihood, which "
           "need not be symmetric.",
       .group = "Output"},
      most_rows_flag("200000")};
  for (const auto& more : {recording_flags(), own, search_flags(), library_flags(), follow_flags()})
    spec.options.insert(spec.options.end(), more.begin(), more.end());
  spec.options.push_back(answer_option("Output"));
  spec.tables = {
      {"Marked points (--markers)", marker_columns()},
      {"Model (output)",
       {{"effect", "name in the catalogue, see hs-effects(7)"},
        {"region", "region that the parameter belongs to, from 0"},
        {"parameter", "name of the parameter"},
        {"value", "in SI units"},
        {"unit", "SI unit"},
        {"std_error",
         "standard error, empty when not estimated; of moduli, times and sizes it is the value "
         "times that of its logarithm: 95 % are the value over and times exp(1.96 std_error / "
         "value). Where finite elements are solved for a size that is hardly known (a layer's "
         "thickness, the radius of an inclusion), from the profile of its likelihood, the bodies "
         "solved anew along it, and its longer side; of models without such sizes so that of the "
         "others where one is at its bound or may be there. At least that by what whole positions "
         "(presses, of fewer than 8 positions) differ by, as where the misfit goes together over "
         "one. Neither with --constrain nor --robust"},
        {"lower, upper", "bounds"},
        {"state", "free, fixed or derived"}}},
      {"Model of --acfm (output)",
       {{"position", "number of the position"},
        {"x, y, z", "where it is [m]"},
        {"nx, ny, nz", "outward normal there, unit"},
        {"axis",
         "n: along the normal; t1, t2: the global x and y, turned by the "
         "shortest way that takes z to the normal"},
        {"parameter",
         "ks: spring; k1, tau1, k2, tau2, ...: Maxwell elements, whose "
         "dashpots are k tau; s: where it stiffens, u (exp(s |u|) - 1)/(s |u|) in place of u"},
        {"value, unit, std_error", "in SI units; the error empty where not estimated"},
        {"state", "free, or derived where these data did not move that way"}}},
      {"--image (CSV)",
       {{"x, y, z", "centre of the tetrahedron [m], in the body's order"},
        {"E", "Young's modulus there [Pa]"}}},
      {"--lumps (output)",
       {{"lump", "number, the strongest first; no row: none is seen"},
        {"x, y, z", "its centre [m]"},
        {"depth", "of the centre below the surface [m]"},
        {"radius", "as a ball [m]"},
        {"ratio", "its modulus over that around it, 0.02 to 50: beyond, nothing changes"},
        {"..._low, ..._high", "of each of these: between them it lies in 95 of 100"},
        {"chance", "that a body without a lump looks so at some place"}}}};
  spec.examples = {
      {"hs-identify data.csv --body body.ply --effects elastic -o m0.csv", "A first model."},
      {"hs-identify data.csv --body body.ply --model m0.csv --add viscoelastic -o m1.csv",
       "Adds relaxation to it."},
      {"hs-identify data.csv --body body.ply --effects auto --history steps.csv -o m.csv",
       "Finds what is missing and adds it, until nothing is."},
      {"hs-identify data.csv --body body.ply --model m0.csv --diagnosis effects.csv -o m1.csv",
       "Adds what hs-diagnose found missing."},
      {"hs-identify data.csv --body body.ply --lumps lumps.csv -o m0.csv",
       "Says what lies inside, how deep, how large and how stiff."},
      {"hs-identify block.csv --body block.ply --data ball.csv --body ball.ply -o m.csv",
       "One material of two bodies."},
      {"hs-identify data.csv --body body.ply --model m1.csv --constrain 'E1 <= E/2' -o m2.csv",
       "Keeps a relation between two moduli."},
      {"hs-identify hold.csv --body block.ply --effects hyperelastic,viscoelastic --terms 2 "
       "--until "
       "4 -o m.csv",
       "Learns from the first 4 s of each press and predicts the rest."},
      {"hs-identify data.csv --body body.ply --fix nu=0.45 --add regions --regions sites -o m.csv",
       "Gives each pressed position its own stiffness."},
      {"hs-identify data.csv --body parts.ply --fix nu=0.45 --add regions --regions labels -o "
       "m.csv",
       "Finds the modulus of each closed region that hs-tetmesh --region has put into the body."},
      {"hs-simulate motion.csv --body body.ply --model m.csv | hs-identify - --body body.ply "
       "--acfm "
       "2 -o acfm.csv",
       "An analytical model of a finite-element model, for loops at a kilohertz and more."}};
  spec.see_also = {"hs-simulate(1)", "hs-compare(1)", "hs-diagnose(1)", "hs-library(1)",
                   "hs-effects(7)"};
  return spec;
}

}  // namespace hapsim
