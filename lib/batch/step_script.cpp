#include "batch/step_script.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <fstream>
#include <sstream>

namespace hapsim {
namespace {

std::string inputs_and_command(const BatchStep& step) {
  std::string script;
  for (const std::string& path : step.given) {
    struct stat info {};
    if (stat(path.c_str(), &info) == 0)
      script += fmt::format("# {}: {} bytes, {}.{:09}\n", path, info.st_size, info.st_mtim.tv_sec,
                            info.st_mtim.tv_nsec);
  }
  // In place of the shell, so that what ends the step by its time ends the tool.
  return script + "exec " + step.command + "\n";
}

}  // namespace

std::filesystem::path script_path(const Batch& batch, const BatchStep& step) {
  return std::filesystem::path(batch.options.folder) / step.folder / (step.name + ".sh");
}

std::string script_of(const BatchStep& step, const std::string& version) {
  return "# hapsim " + version + "\n" + inputs_and_command(step);
}

bool is_current(const Batch& batch, const BatchStep& step) {
  std::ifstream file(script_path(batch, step), std::ios::binary);
  std::string version;
  std::ostringstream rest;
  return std::getline(file, version) && rest << file.rdbuf() &&
         rest.str() == inputs_and_command(step);
}

}  // namespace hapsim
