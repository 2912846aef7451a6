// From argv to Arguments, checked against the specification.
#pragma once

#include "cli/tool.h"

namespace hapsim {

enum class Request { kRun, kShortHelp, kHelp, kMan, kVersion, kCompletion, kAbout, kParsed };

struct CommandLine {
  Request request = Request::kRun;
  Arguments arguments;
  std::string shell;     // kCompletion
  bool verbose = false;  // kVersion: beside -v
};

// Throws Error(kUsage): unknown flag (with the nearest), missing or repeated value, number out of
// bounds, unknown choice, more than one input. -h, --help, --man, --version and --completion-SHELL
// (bash, zsh, fish) and --about (for the build, so no help names them) win over all of these.
// --parsed, for tests, asks to print what was understood instead of doing it.
CommandLine parse_command_line(const ToolSpec& spec, int argc, char** argv);

}  // namespace hapsim
