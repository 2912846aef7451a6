// hs: hapsim's tools by what they are for, and the help of each.
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "base/error.h"
#include "base/nearest.h"
#include "cli/tool_list.h"
#include "io/stream.h"

namespace hapsim {
namespace {

// Written by the tools themselves when they are built.
const std::vector<ListedTool> kTools{
#include "tool_list.inc"
};

ToolSpec specification() {
  ToolSpec spec;
  spec.name = "hs";
  spec.summary = "list hapsim's tools by what they are for";
  spec.input = "name of a tool, as identify or hs-identify: its help on a screen";
  spec.input_optional = true;
  spec.task = Task::kMany;
  spec.description = {
      "Without a name the tools are listed. hs help is the same, and so is hs help NAME.",
      "Inputs of the tools are files or pipes, results go to -o FILE or to the next tool, and what "
      "was found "
      "is said on standard error: the verdict, its numbers, the next command."};
  spec.examples = {{"hs", "Lists the tools."},
                   {"hs help identify", "The screen of hs-identify -h."}};
  for (const ListedTool& tool : kTools) spec.see_also.push_back(tool.name + "(1)");
  spec.see_also.push_back("hs-effects(7)");
  return spec;
}

// The screen of a tool, which stands beside this one.
int show_help(const std::string& name) {
  std::vector<std::string> names;
  for (const ListedTool& tool : kTools) {
    names.push_back(tool.name.substr(3));
    if (name != tool.name && name != names.back()) continue;
    std::error_code error;
    const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error);
    const std::string beside = (self.parent_path() / tool.name).string();
    execl(beside.c_str(), tool.name.c_str(), "-h", nullptr);
    execlp(tool.name.c_str(), tool.name.c_str(), "-h", nullptr);
    fail_io(tool.name, std::string("it does not start: ") + std::strerror(errno),
            "install hapsim whole");
  }
  const std::string near = nearest(name, names);
  fail_usage("no tool is named '" + name + "'",
             near.empty() ? "hs lists the tools" : "did you mean '" + near + "'?");
}

int run(const Arguments& arguments) {
  if (arguments.input_given()) return show_help(arguments.input());
  Output output(arguments.output());
  output.write(tool_list(kTools) +
               "\nOne of them:  hs help identify\n"
               "First steps:  man hs-identify, and README.md: from a scan to what a model lacks\n");
  output.commit();
  return 0;
}

}  // namespace
}  // namespace hapsim

int main(int argc, char** argv) {
  // `hs help NAME` is `hs NAME`.
  if (argc > 1 && std::strcmp(argv[1], "help") == 0) {
    for (int k = 1; k < argc; ++k) argv[k] = argv[k + 1];
    --argc;
  }
  return hapsim::run_tool(hapsim::specification(), argc, argv, hapsim::run);
}
