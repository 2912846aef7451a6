// hs: hapsim's tools by what they are for, and the help of each.
#include <unistd.h>

#include <array>
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
      "Without a name the tools are listed. hs help is the same, and so is hs help NAME. With what "
      "follows hs identify is hs-identify.",
      "Inputs of the tools are files or pipes, results go to -o FILE or to the next tool, and what "
      "was found "
      "is said on standard error: the verdict, its numbers, the next command."};
  spec.examples = {{"hs", "Lists the tools."},
                   {"hs help identify", "The screen of hs-identify -h."}};
  for (const ListedTool& tool : kTools) spec.see_also.push_back(tool.name + "(1)");
  spec.see_also.push_back("hs-effects(7)");
  return spec;
}

const ListedTool* find_tool(const std::string& name) {
  for (const ListedTool& tool : kTools)
    if (name == tool.name || "hs-" + name == tool.name) return &tool;
  return nullptr;
}

// Becomes a tool, which stands beside this one; argv[0] is passed over. Returns where it cannot.
void become(const ListedTool& tool, char** argv) {
  std::string name = tool.name;
  argv[0] = name.data();
  std::error_code error;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error);
  execv((self.parent_path() / name).c_str(), argv);
  execvp(name.c_str(), argv);
}

// The screen of a tool.
int show_help(const std::string& name) {
  if (const ListedTool* tool = find_tool(name)) {
    std::string help = "-h";
    std::array<char*, 3> argv{nullptr, help.data(), nullptr};
    become(*tool, argv.data());
    fail_io(tool->name, std::string("it does not start: ") + std::strerror(errno),
            "install hapsim whole");
  }
  std::vector<std::string> names;
  for (const ListedTool& tool : kTools) names.push_back(tool.name.substr(3));
  const std::string near = nearest(name, names);
  fail_usage("no tool is named '" + name + "'",
             near.empty() ? "hs lists the tools" : "did you mean '" + near + "'?");
}

int run(const Arguments& arguments) {
  if (arguments.input_given()) return show_help(arguments.input());
  Output output(arguments.output());
  output.write(tool_list(kTools) +
               "\nOne of them:  hs help identify\n"
               "First steps:  README.md: from a scan to what a model lacks\n");
  output.commit();
  return 0;
}

}  // namespace
}  // namespace hapsim

int main(int argc, char** argv) {
  // `hs help NAME` is `hs NAME`, and with more words `hs NAME` is that tool.
  if (argc > 1 && std::strcmp(argv[1], "help") == 0) {
    for (int k = 1; k < argc; ++k) argv[k] = argv[k + 1];
    --argc;
  } else if (argc > 2) {
    if (const hapsim::ListedTool* tool = hapsim::find_tool(argv[1]))
      hapsim::become(*tool, argv + 1);
    if (argv[1][0] != '-') argc = 2;  // no tool has that name
  }
  return hapsim::run_tool(hapsim::specification(), argc, argv, hapsim::run);
}
