// hs-identify --follow: moduli from a stream, while it comes.
#pragma once

#include <fmt/format.h>

#include <memory>
#include <vector>

#include "base/error.h"
#include "common_options.h"
#include "hs-identify/flags.h"
#include "io/csv.h"
#include "prepared_options.h"
#include "realtime/motion_lines.h"
#include "stream_options.h"
#include "watch/identified_material.h"

namespace hapsim {

inline std::vector<Option> follow_flags() {
  std::vector<Option> flags = online_flags("Follow");
  const std::vector<Option> own{
      {.flag = flag::follow,
       .help = "Identifies E, and the moduli of relaxation at the times of --times, from a "
               "stream of rows, and writes a line of estimates every --every rows at once.",
       .group = "Follow"},
      accuracy_option("Follow"),
      {.flag = flag::every,
       .value = "N",
       .help = "Follow: rows from one line of estimates to the next.",
       .group = "Follow",
       .default_text = "100",
       .minimum = 1,
       .maximum = 1e9},
      {.flag = flag::memory,
       .value = "N",
       .help = "Follow: rows in which older ones fade; otherwise all count.",
       .group = "Follow",
       .minimum = 10,
       .maximum = 1e9}};
  flags.insert(flags.begin(), own.begin(), own.end());
  return flags;
}

inline int run_follow(const Arguments& arguments) {
  const std::vector<double> times =
      parse_relaxation_times(arguments.list(flag::times), flag::times.name);
  const TetMesh mesh = load_body(arguments);
  Input input(arguments.input());
  MotionLines lines(input, true);
  lines.require_contact_points("press,t,x,y,z,ux,uy,uz,fx,fy,fz");
  lines.allow_tools();
  std::shared_ptr<Progress> progress;
  const PreparedBodyOptions options = prepared_options(
      arguments, stream_radius(arguments, lines.metadata(), input.name()), progress);
  lines.within(mesh.nodes);
  const PreparedBody body(mesh, unit_model(arguments[flag::nu]), options);
  progress.reset();
  tell_accuracy(arguments, "hs-identify", body.field());
  struct Followed {  // a tool
    UnitResponse response;
    int press;
  };
  std::vector<std::unique_ptr<Followed>> tools;
  OnlineIdentification identification(static_cast<int>(times.size()) + 1,
                                      arguments.given(flag::memory)
                                          ? static_cast<double>(arguments[flag::memory])
                                          : std::numeric_limits<double>::infinity());
  Output output(arguments.output());
  CsvWriter csv(output.stream(), lines.metadata(), estimate_columns(times.size()));
  output.stream().flush();
  MotionLine line;
  long rows = 0, beside = 0;
  const long every = arguments[flag::every];
  const auto tell = [&] {
    csv.row(estimate_row(line.t, rows, identification.estimate()));
    output.stream().flush();
  };
  answer_stream(
      arguments, "hs-identify", input,
      [&] {
        while (lines.next(line)) {
          const std::size_t k = lines.tool();
          const bool is_new = k == tools.size();
          if (is_new) tools.push_back(std::make_unique<Followed>(UnitResponse(body, times), 0));
          UnitResponse& response = tools[k]->response;
          if (is_new || line.press != tools[k]->press) response.begin(line.point);
          tools[k]->press = line.press;
          response.press(line.t, line.u, line.in_air);
          // Where another tool presses too, the surface is not where this one's contact has it.
          if (!line.in_air && !lines.is_alone())
            ++beside;
          else if (!line.in_air)
            identification.add(response.unit_forces(), lines.force());
          if (++rows % every == 0) tell();
        }
        if (rows == 0 && !input.ended_by_signal())
          fail_input(input.name(), "there are no rows", "send some");
      },
      [&] {
        if (rows == 0) return;
        if (rows % every != 0) tell();
        output.commit();
        const OnlineEstimate e = identification.estimate();
        say(arguments, "hs-identify",
            fmt::format("{} rows: {} at nu = {:g} (--nu); error {:.3g} N", rows,
                        moduli_words(e, times, 4), static_cast<double>(arguments[flag::nu]),
                        e.rmse));
        if (beside > 0)
          say(arguments, "hs-identify",
              fmt::format("{} of them are of a tool beside which another pressed, which moves the "
                          "surface: they do not count",
                          beside));
      });
  return 0;
}

}  // namespace hapsim
