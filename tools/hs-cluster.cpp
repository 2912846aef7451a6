// hs-cluster: location samples into regions and their boundary.
#include <fmt/format.h>

#include <memory>

#include "answer.h"
#include "base/error.h"
#include "base/shell_words.h"
#include "cli/shared_flags.h"
#include "formats/format_table.h"
#include "formats/tetmesh_io.h"
#include "io/number.h"
#include "regions/region_map.h"
#include "regions/region_report.h"
#include "regions/region_summary.h"

namespace hapsim {
namespace flag {
inline constexpr IntegerFlag regions{"--regions"}, components{"--components"},
    key_points{"--key-points"}, scan_points{"--scan-points"}, seed{"--seed"};
inline constexpr ChoiceFlag linkage{"--linkage"}, features{"--features"}, rule{"--rule"};
inline constexpr NumberFlag significance{"--significance"};
inline constexpr FileFlag write_model{"--write-model"}, boundary{"--boundary"}, labels{"--labels"},
    dendrogram{"--dendrogram"}, svg{"--svg"};
}  // namespace flag

namespace {

ToolSpec specification() {
  ToolSpec spec;
  spec.name = "hs-cluster";
  spec.task = Task::kModel;
  spec.summary = "regions of a body from what each contact position asks for by itself";
  spec.input = "location samples CSV (x,y,z,E,nu,E_std,nu_std[,n]), as hs-identify --locations";
  spec.description = {
      "Clusters log E and nu, scaled by their standard errors, hierarchically; says whether there "
      "is more than one region; and finds the boundary between regions in plan view by quadratic "
      "discriminant analysis of the positions. Writes the samples with their region.",
      "A division is believed when the samples scatter more than their errors allow and cluster "
      "more tightly than samples spread evenly would (gap statistic, tested against one region at "
      "every branch of the tree). A smooth slope of the stiffness is not divided. Samples "
      "beside a boundary are held by both its sides: a group of them, all of which have neighbours "
      "in a softer and in a stiffer region, is no region, and each joins the nearer of the two "
      "by value."};
  spec.options = {
      {.flag = flag::regions,
       .value = "N",
       .help = "Number of regions; otherwise as many as the samples prove.",
       .group = "Clusters",
       .minimum = 1,
       .maximum = 1000},
      {.flag = flag::linkage,
       .value = "NAME",
       .help = "Distance between clusters; auto: the first whose tree keeps the distances "
               "(cophenetic correlation of 0.75), else the best.",
       .group = "Clusters",
       .default_text = "auto",
       .choices = {"auto", "average", "ward", "complete", "single"}},
      {.flag = flag::features,
       .value = "NAMES",
       .help = "What is clustered: E alone, or nu as well where it was estimated.",
       .group = "Clusters",
       .default_text = "E+nu",
       .choices = {"E+nu", "E"}},
      {.flag = flag::components,
       .value = "N",
       .help = "Principal components that are clustered instead; 0: the parameters themselves.",
       .group = "Clusters",
       .default_text = "0",
       .minimum = 0,
       .maximum = 2},
      {.flag = flag::significance,
       .value = "P",
       .help = "Chance of dividing what is one region.",
       .group = "Clusters",
       .default_text = "0.05",
       .minimum = 1e-3,
       .maximum = 0.5},
      {.flag = flag::rule,
       .value = "NAME",
       .help = "Region of a place: by discriminant analysis, or that of the nearest sample.",
       .group = "Regions in space",
       .default_text = "qda",
       .choices = {"qda", "nearest"}},
      {.flag = flag::boundary,
       .value = "FILE",
       .help = "Writes the boundaries as key points (CSV).",
       .group = "Regions in space",
       .writes = kTableExtensions},
      {.flag = flag::key_points,
       .value = "N",
       .help = "Key points along each boundary.",
       .group = "Regions in space",
       .default_text = "8",
       .minimum = 2,
       .maximum = 1000},
      {.flag = flag::scan_points,
       .value = "N",
       .help = "Places that are classified to find the boundary.",
       .group = "Regions in space",
       .default_text = "20000",
       .minimum = 100,
       .maximum = 4000000},
      {.flag = flag::write_model,
       .value = "FILE",
       .help = "Writes a model with these regions, a start for hs-identify --model.",
       .group = "Output",
       .writes = kTableExtensions},
      {.flag = flag::body,
       .value = "FILE",
       .help = "Body from hs-tetmesh, or another mesh of tetrahedra with fixed nodes (" +
               names_to_read(Content::kTetrahedra) + "): its plan view bounds the boundary.",
       .group = "Output"},
      {.flag = flag::labels,
       .value = "FILE",
       .help = "Writes the body with the region of each tetrahedron; needs --body.",
       .group = "Output",
       .writes = extensions_to_write(Content::kTetrahedra)},
      {.flag = flag::dendrogram,
       .value = "FILE",
       .help = "Writes the tree of merges (CSV).",
       .group = "Output",
       .writes = kTableExtensions},
      {.flag = flag::svg,
       .value = "FILE",
       .help = "Draws the tree, branches coloured by region (SVG).",
       .group = "Output",
       .writes = {"svg"}},
      {.flag = flag::seed,
       .value = "N",
       .help = "Seed of the test of one region against more.",
       .group = "Clusters",
       .default_text = "1",
       .minimum = 0}};
  spec.options.push_back(answer_option("Output"));
  spec.tables = {{"Samples (output)",
                  {{"x,y,z", "contact position [m]"},
                   {"E, E_std", "Young's modulus and its standard error [Pa]"},
                   {"nu, nu_std", "Poisson's ratio and its standard error"},
                   {"n", "force components behind the sample"},
                   {"region", "from 0, by ascending E"}}},
                 {"--boundary",
                  {{"line", "number of the connected line, from 0"},
                   {"region_a, region_b", "regions on its two sides"},
                   {"point",
                    "number along the line, from 0; the last equals the first when the "
                    "line is closed"},
                   {"x, y", "plan view [m]"}}},
                 {"--dendrogram",
                  {{"node", "number of the cluster; samples have 0 to n - 1 in order of the file"},
                   {"left, right", "clusters that are joined"},
                   {"height", "their distance, in standard errors"},
                   {"size", "samples below"},
                   {"inconsistency",
                    "height against the merges just below, in their standard "
                    "deviations"}}}};
  spec.examples = {
      {"hs-identify data.csv --body body.ply --locations l.csv -o m0.csv", "Location samples."},
      {"hs-cluster l.csv --boundary boundary.csv --svg tree.svg -o classified.csv",
       "Regions, boundary and tree."},
      {"hs-cluster l.csv --body body.ply --labels regions.ply --write-model start.csv -o "
       "classified.csv",
       "A body with regions, and a model that hs-identify --model can improve."},
      {"hs-identify data.csv --body body.ply --model start.csv --refine-boundary 8 -o m.csv",
       "Improves it: the boundary moves with the moduli, as all forces ask."}};
  spec.see_also = {"hs-identify(1)", "hs-tetmesh(1)", "hs-effects(7)"};
  return spec;
}

RegionOptions region_options(const Arguments& arguments) {
  RegionOptions options;
  for (const Linkage linkage :
       {Linkage::kAverage, Linkage::kWard, Linkage::kComplete, Linkage::kSingle})
    if (arguments[flag::linkage] == linkage_name(linkage)) options.linkage = linkage;
  options.components = static_cast<int>(arguments[flag::components]);
  options.use_nu = arguments[flag::features] == "E+nu";
  if (arguments.given(flag::regions)) options.regions = static_cast<int>(arguments[flag::regions]);
  options.significance = arguments[flag::significance];
  options.seed = static_cast<std::uint64_t>(arguments[flag::seed]);
  return options;
}

int run(const Arguments& arguments) {
  if (arguments.given(flag::labels) && !arguments.given(flag::body))
    fail_usage("--labels needs a body", "add --body FILE");
  const RegionOptions options = region_options(arguments);
  Input input(arguments.input());
  LocationTable table = read_locations(input);
  std::optional<TetMesh> body;
  if (arguments.given(flag::body)) {
    Input body_input(arguments[flag::body]);
    body = read_body(body_input);
  }
  const RegionEstimate regions = estimate_regions(table, options);
  const int count = static_cast<int>(regions.value.size());
  const RegionRule rule = arguments[flag::rule] == "qda" ? RegionRule::kQda : RegionRule::kNearest;
  const PlaneClassifier classify = region_classifier(table, regions.label, count, rule);
  const auto lines =
      region_boundaries(classify, table, body, static_cast<int>(arguments[flag::scan_points]));
  const int keys = static_cast<int>(arguments[flag::key_points]);

  table.region = regions.label;
  table.metadata.set("regions", std::to_string(count));
  table.metadata.set("linkage", linkage_name(regions.linkage));
  table.metadata.set("cophenetic", format_number(regions.correlation));
  table.metadata.set("seed", arguments.text(flag::seed));
  std::vector<std::unique_ptr<Output>> outputs;  // all complete, or none
  const auto write = [&](const std::string& path, const auto& writer) {
    outputs.push_back(std::make_unique<Output>(path));
    writer(outputs.back()->stream());
  };
  const auto write_asked = [&](const AnyFlag& flag, const auto& writer) {
    if (arguments.given(flag)) write(arguments.text(flag), writer);
  };
  write_asked(flag::boundary, [&](std::ostream& out) { write_boundary(out, lines, keys); });
  write_asked(flag::dendrogram, [&](std::ostream& out) { write_dendrogram(out, regions.tree); });
  write_asked(flag::svg, [&](std::ostream& out) { out << dendrogram_svg(regions) << "\n"; });
  write_asked(flag::write_model, [&](std::ostream& out) {
    write_model(out, region_model(table, regions, classify, lines, keys));
  });
  write_asked(flag::labels, [&](std::ostream& out) {
    label_body(*body, classify);
    format_to_write(arguments[flag::labels], Content::kTetrahedra).write_mesh(out, *body, {});
  });
  write(result_file(arguments), [&](std::ostream& out) { write_locations(out, table); });
  for (const auto& output : outputs) output->commit();

  Summary summary = region_summary(regions, table.size(), input.name());
  if (const int wrong = contradicted(classify, table, regions.label); wrong > 0)
    summary.notes.push_back(
        fmt::format("{} of {} samples lie on the other side of the estimated boundary: press more "
                    "places along it, or use --rule nearest",
                    wrong, table.size()));
  if (arguments.given(flag::write_model))
    summary.next =
        fmt::format("hs-identify data.csv --body {} --model {} -o m.csv",
                    arguments.given(flag::body) ? shell_quoted(arguments[flag::body]) : "body.ply",
                    shell_quoted(arguments[flag::write_model]));
  tell_answer(arguments, summary);
  return 0;
}

}  // namespace
}  // namespace hapsim

int main(int argc, char** argv) {
  return hapsim::run_tool(hapsim::specification(), argc, argv, hapsim::run);
}
