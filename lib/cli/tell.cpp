#include "cli/tell.h"

#include <cstdio>
#include <cstring>

namespace hapsim {

void say_summary(const Arguments& arguments, const Summary& summary) {
  if (arguments.quiet()) return;
  clear_progress_line();
  Summary told = summary;
  if (!result_is_wanted(arguments) && told.details.empty())
    told.details = "The result is written by -o FILE; -o - shows it here.";
  std::vector<std::string> lines = summary_lines(told);
  if (colourful()) {
    const char* colour = summary.mark == Summary::Mark::kGood  ? "\033[1;32m"
                         : summary.mark == Summary::Mark::kBad ? "\033[1;31m"
                                                               : "\033[1;33m";
    // The sign has three bytes or one, and a blank behind it.
    const std::size_t end = lines.front().find(' ') + 1 + summary.verdict.size();
    lines.front() = colour + lines.front().substr(0, end) + "\033[0m" + lines.front().substr(end);
  }
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  std::fputs(text.c_str(), stderr);  // at once, for the tools of a pipe tell side by side
}

}  // namespace hapsim
