// hs-import: recordings of other people's machines and robots in hapsim's data format.
#include <fmt/format.h>

#include <algorithm>

#include "answer.h"
#include "base/error.h"
#include "base/shell_words.h"
#include "calibration_option.h"
#include "hs-import/flags.h"
#include "hs-import/specification.h"
#include "import/block.h"
#include "import/implausible.h"
#include "import/import_report.h"
#include "import/tip_motion.h"
#include "io/number.h"
#include "io/quantity.h"

namespace hapsim {
namespace {

Vec3 vector_of(const Arguments& arguments, const AnyFlag& flag) {
  const std::string given = arguments.text(flag);
  Vec3 v;
  std::size_t from = 0;
  for (Eigen::Index i = 0; i < 3; ++i) {
    const std::size_t to = std::min(given.find(',', from), given.size());
    if (from > given.size() ||
        !parse_number(std::string_view(given).substr(from, to - from), v[i]) ||
        (to == given.size()) != (i == 2))
      fail_usage(flag + ": '" + given + "' is not three numbers", "write for example 0,0,0.04");
    from = to + 1;
  }
  return v;
}

ImportOptions import_options(const Arguments& arguments, const std::optional<Block>& block) {
  ImportOptions options;
  options.columns = arguments.list(flag::column);
  const auto maybe = [&arguments](const AnyFlag& flag) {
    return arguments.given(flag) ? arguments.text(flag) : "";
  };
  options.units = {maybe(flag::unit), maybe(flag::force_unit), maybe(flag::time_unit)};
  options.split_by = maybe(flag::split_by);
  options.at = contact_place(
      arguments.given(flag::at) ? std::optional(vector_of(arguments, flag::at)) : std::nullopt,
      block ? std::optional(block->size) : std::nullopt);
  options.direction = vector_of(arguments, flag::direction);
  if (options.direction.norm() < 1e-9)
    fail_usage("--direction has no length", "write for example 0,0,-1");
  if (arguments.given(flag::tool_radius)) {
    options.tool_radius = arguments[flag::tool_radius];
    if (!(*options.tool_radius > 0))
      fail_usage("--tool-radius is not above 0", "write it with its unit: 4mm");
  }
  options.tool = maybe(flag::tool);
  if (options.tool == "platen") {
    if (!block)
      fail_usage("--tool platen needs the body between the plates",
                 "add --block LxWxH, or DxH for a cylinder");
    const double least = covering_radius(*block);
    if (options.tool_radius && *options.tool_radius < least)
      fail_usage(
          fmt::format("--tool platen: a radius of {:.4g} m does not cover the block",
                      *options.tool_radius),
          fmt::format("it takes {:.4g} m; --tool flat for a tool that covers a part", least));
    options.tool = "flat";
    if (!options.tool_radius) options.tool_radius = least;
  }
  options.contact = arguments[flag::contact];
  options.tip = arguments[flag::tip];
  options.force = arguments[flag::force];
  options.noise = arguments[flag::estimate_noise];
  if (arguments.given(flag::rate)) options.rate = arguments[flag::rate];
  if (arguments.given(flag::calibration)) options.calibration = load_calibration(arguments);
  options.drop_air = arguments[flag::drop_air];
  options.specimen = maybe(flag::specimen);
  options.units.trusted = arguments[flag::yes];
  if (block) options.block = block->size;
  check_sizes_given(options);
  return options;
}

TableOptions table_options(const Arguments& arguments) {
  TableOptions options;
  options.names = arguments.list(flag::names);
  if (arguments.given(flag::part)) options.part = arguments[flag::part];
  options.topics = arguments.list(flag::topic);
  options.positions_alone = arguments[flag::tip_motion];
  if (arguments.given(flag::unit)) options.length_unit = arguments.text(flag::unit);
  if (arguments.given(flag::encoding)) options.encoding = arguments[flag::encoding];
  const std::string decimal = arguments[flag::decimal];
  if (decimal != "auto") options.decimal = decimal;
  return options;
}

// The body first, where the command has written what it is made of.
std::string next_command(const Arguments& arguments) {
  if (arguments.output() == "-") return "";
  if (arguments.given(flag::surface))
    return "hs-tetmesh " + shell_quoted(arguments[flag::surface]) + " -o body.ply";
  if (arguments.given(flag::scan))
    return "hs-scan2ply " + shell_quoted(arguments[flag::scan]) +
           " | hs-reconstruct --window | hs-tetmesh -o body.ply";
  return "hs-identify " + shell_quoted(arguments.output()) + " --body body.ply -o m0.csv";
}

int write_motion(const RawTable& table, const ImportOptions& options, const Arguments& arguments) {
  Output output(result_file(arguments));
  const TipMotion motion = tip_motion(table, options);
  write_tip_motion(output.stream(), motion);
  output.commit();
  Summary summary = tip_motion_summary(motion);
  if (arguments.output() != "-")
    summary.next = "hs-simulate --live " + shell_quoted(arguments.output()) +
                   " --body body.ply --model model.csv -o forces.csv";
  tell_answer(arguments, summary);
  return 0;
}

// What has no meaning without presses must not be dropped in silence.
void check_motion_options(const Arguments& arguments) {
  for (const AnyFlag& other :
       {AnyFlag(flag::scan), AnyFlag(flag::calibration), AnyFlag(flag::surface),
        AnyFlag(flag::split_by), AnyFlag(flag::contact), AnyFlag(flag::force), AnyFlag(flag::at),
        AnyFlag(flag::estimate_noise), AnyFlag(flag::rate), AnyFlag(flag::drop_air),
        AnyFlag(flag::specimen)})
    if (arguments.given(other))
      fail_usage("--tip-motion makes no presses, " + other + " is for them", "give one of them");
  const bool centre = arguments[flag::tip] == "centre";
  if (centre && !arguments.given(flag::tool_radius))
    fail_usage("--tip-motion --tip centre needs the radius of the ball", "add --tool-radius M");
  if (!centre && arguments.given(flag::direction))
    fail_usage("--tip-motion: --direction says where the tip is from the centre of a ball",
               "add --tip centre, or leave it out");
}

int run(const Arguments& arguments) {
  std::optional<Block> block;
  if (arguments.given(flag::block)) block = parse_block(arguments[flag::block]);
  if (arguments.given(flag::surface) && !block)
    fail_usage("--surface needs the size of the block", "add --block LxWxH, or DxH for a cylinder");
  if (arguments[flag::tip_motion]) check_motion_options(arguments);
  const ImportOptions options = import_options(arguments, block);

  Input input(arguments.input());
  const RawTable table = read_raw_table(input, table_options(arguments));
  if (arguments[flag::list]) {  // for people
    Output output(arguments.output());
    output.write(describe_columns(table, options));
    output.commit();
    return 0;
  }
  if (arguments[flag::tip_motion]) return write_motion(table, options, arguments);
  Output output(result_file(arguments));
  const ImportResult result = import_recording(table, options);
  write_recording(output.stream(), result.recording);
  if (arguments.given(flag::scan)) {
    Output scan(arguments[flag::scan]);
    write_scan(scan.stream(), result);
    scan.commit();
  }
  if (block && arguments.given(flag::surface)) {
    Output surface(arguments[flag::surface]);
    const std::string size = "block, " + block_words(*block);
    format_to_write(arguments[flag::surface], Content::kTriangles)
        .write_surface(surface.stream(), block_surface(*block), {.comments = {size}});
    surface.commit();
  }
  output.commit();
  Summary summary = import_summary(result);
  summary.next = next_command(arguments);
  tell_answer(arguments, summary);
  return 0;
}

}  // namespace
}  // namespace hapsim

int main(int argc, char** argv) {
  return hapsim::run_tool(hapsim::import_specification(), argc, argv, hapsim::run);
}
