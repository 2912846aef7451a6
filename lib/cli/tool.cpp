#include "cli/tool.h"

#include <fcntl.h>
#include <malloc.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <stdexcept>

#include "base/blas.h"
#include "base/error.h"
#include "cli/check.h"
#include "cli/completion.h"
#include "cli/failure.h"
#include "cli/help.h"
#include "cli/parse.h"
#include "io/number.h"
#include "io/stream.h"
#include "io/temp_files.h"

namespace hapsim {

bool colourful() {
  const char* no_color = std::getenv("NO_COLOR");
  const char* term = std::getenv("TERM");
  return isatty(STDERR_FILENO) == 1 && (no_color == nullptr || *no_color == '\0') &&
         term != nullptr && std::strcmp(term, "dumb") != 0;
}

namespace {

// A file opened later must not become standard output because that was closed.
void occupy_standard_streams() {
  for (const int fd : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(fd, F_GETFD) < 0) open("/dev/null", fd == STDIN_FILENO ? O_WRONLY : O_RDONLY);
}

// Text out of files may hold what would steer a terminal.
std::string printable(std::string text) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = c == '\n' ? ' ' : '?';
  return text;
}

int report(const ToolSpec& spec, ExitCode code, const std::string& message) {
  const bool colour = colourful();
  clear_progress_line();
  std::fprintf(stderr, "%s%s:%s %s\n", colour ? "\033[1;31m" : "", spec.name.c_str(),
               colour ? "\033[0m" : "", printable(message).c_str());
  return static_cast<int>(code);
}

int print(const std::string& text) {
  Output out("-");
  out.write(text);
  out.commit();
  return static_cast<int>(ExitCode::kDone);
}

// A line a flag that has values.
std::string parsed_text(const Arguments& arguments) {
  std::string text;
  for (const Arguments::Value& v : arguments.values_) {
    if (v.texts.empty()) continue;
    text += v.flag;
    for (const std::string& one : v.texts) text += " " + one;
    text += "\n";
  }
  return text;
}

int parse_and_run(const ToolSpec& spec, int argc, char** argv,
                  const std::function<int(const Arguments&)>& run) {
  const CommandLine line = parse_command_line(spec, argc, argv);
  switch (line.request) {
    case Request::kShortHelp:
      return print(short_help_text(spec));
    case Request::kHelp:
      return print(help_text(spec));
    case Request::kMan:
      return print(man_page(spec));
    case Request::kVersion:
      return print(spec.name + " (hapsim) " + version() + "\n" +
                   (line.verbose ? "BLAS: " + blas_name() + "\n" : ""));
    case Request::kCompletion:
      return print(completion(spec, line.shell));
    case Request::kAbout:
      return print(about_text(spec));
    case Request::kParsed:
      return print(parsed_text(line.arguments));
    case Request::kRun:
      break;
  }
  const bool reads_stdin = !spec.input.empty() && !spec.input_optional;
  if (reads_stdin && !line.arguments.input_given() && isatty(STDIN_FILENO) == 1)
    fail_usage("there is no input", "name a file or pipe data in; " + spec.name + " --help");
  check_outputs(spec, line.arguments);
  return run(line.arguments);
}

}  // namespace

std::string version() {
  return HAPSIM_VERSION;
}

const Arguments::Value& Arguments::value(const AnyFlag& flag) const {
  for (const Value& v : values_)
    if (v.flag == flag.name) return v;
  throw std::logic_error("the specification has no flag " + flag);
}

bool Arguments::given(const AnyFlag& flag) const {
  return value(flag).given;
}
bool Arguments::has(const AnyFlag& flag) const {
  return !value(flag).texts.empty();
}

std::string Arguments::text(const AnyFlag& flag) const {
  const Value& v = value(flag);
  return v.texts.empty() ? "" : v.texts.front();
}

double Arguments::number(const AnyFlag& flag) const {
  double result;
  if (!parse_number(text(flag), result))
    throw std::logic_error(flag + " is read as a number and has no value");
  return result;
}

std::vector<std::string> Arguments::list(const AnyFlag& flag) const {
  return value(flag).texts;
}

void say(const Arguments& arguments, const std::string& tool, const std::string& text) {
  if (!arguments.quiet()) tell(tool, text);
}

void say(const Arguments& arguments, const std::string& text) {
  say(arguments, arguments.tool(), text);
}

bool result_is_wanted(const Arguments& arguments) {
  return arguments.given(flag::output) || isatty(STDOUT_FILENO) != 1;
}

std::string result_file(const Arguments& arguments) {
  return result_is_wanted(arguments) ? arguments.output() : "/dev/null";
}

void tell(const std::string& tool, const std::string& text) {
  clear_progress_line();
  std::fprintf(stderr, "%s: %s\n", tool.c_str(), text.c_str());
}

namespace {

// OpenBLAS, which is loaded with the tool, takes memory for each thread from the start and asks for
// it again without end where the address space has no more; its threads then hold up the end of the
// process, too. Ends it at once where that is bound to happen.
void require_address_space(const ToolSpec& spec) {
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return;
  const double threads = std::max(1L, sysconf(_SC_NPROCESSORS_ONLN));
  const double needed = 256e6 + 64e6 * threads;
  if (static_cast<double>(limit.rlim_cur) >= needed) return;
  char text[200];
  std::snprintf(text, sizeof text,
                "the address space is limited to %.0f MB, and at least %.0f MB are needed; raise "
                "ulimit -v, or limit the memory by ulimit -m or a control group",
                1e-6 * static_cast<double>(limit.rlim_cur), 1e-6 * needed);
  _exit(report(spec, ExitCode::kNoConvergence, text));
}

// Fits take and give back vectors of some hundred kilobytes all the time. Below this size what is
// given back stays with the program: without, the kernel clears the same pages again and again, a
// tenth of a diagnosis.
void keep_freed_memory() {
#ifdef __GLIBC__
  constexpr int kKept = 32 << 20;
  mallopt(M_TRIM_THRESHOLD, kKept);
  mallopt(M_MMAP_THRESHOLD, kKept);
#endif
}

}  // namespace

int run_tool(const ToolSpec& spec, int argc, char** argv,
             const std::function<int(const Arguments&)>& run) {
  require_address_space(spec);
  keep_freed_memory();
  occupy_standard_streams();
  clean_up_on_signals();
  try {
    return parse_and_run(spec, argc, argv, run);
  } catch (...) {
    const Failure failure = current_failure();
    if (failure.words.empty()) return static_cast<int>(failure.code);
    return report(spec, failure.code, failure.words);
  }
}

}  // namespace hapsim
