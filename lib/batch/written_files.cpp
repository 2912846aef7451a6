#include "batch/written_files.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <functional>
#include <string_view>

namespace hapsim {
namespace {

// Of the tools of kBatchStages; hs-compare reads its --history, from where hs-identify wrote it.
// What is forgotten here is refused when the step runs (io/allowed_outputs.h).
constexpr std::array<std::string_view, 18> kWriting{
    "--contact-meshes", "--events", "--gmsh",      "--history", "--html", "--image", "--inp",
    "--json",           "--junit",  "--locations", "--lumps",   "--ply",  "--plan",  "--scan",
    "--surface",        "--vtu",    "--output",    "-o"};

// Calls `visit` for each path, which may change it.
void for_each_written(
    std::vector<std::string>& words,
    const std::function<void(const std::string& flag, std::string& path)>& visit) {
  for (std::size_t w = 0; w < words.size(); ++w) {
    const std::size_t equals = std::min(words[w].find('='), words[w].size());
    const std::string flag = words[w].substr(0, equals);
    if (std::find(kWriting.begin(), kWriting.end(), flag) == kWriting.end()) continue;
    const bool joined = equals < words[w].size();
    if (!joined && ++w == words.size()) break;
    std::string path = joined ? words[w].substr(equals + 1) : words[w];
    visit(flag, path);
    words[w] = joined ? flag + "=" + path : path;
  }
}

bool leads_out(const std::string& path) {
  const std::filesystem::path parts(path);
  return parts.is_absolute() || std::find(parts.begin(), parts.end(), "..") != parts.end();
}

}  // namespace

bool place_written_files(std::vector<std::string>& words, const std::string& folder) {
  bool any = false;
  for_each_written(words, [&](const std::string&, std::string& path) {
    if (path.empty() || path == "-" || path[0] == '/') return;
    path = folder + "/" + path;
    any = true;
  });
  return any;
}

std::string written_outside(const ManifestRow& row) {
  std::string found;
  const auto look = [&](std::vector<std::string> words) {
    for_each_written(words, [&](const std::string& flag, std::string& path) {
      if (found.empty() && leads_out(path)) found = flag + " " + path;
    });
  };
  for (const auto& words : row.options) look(words);
  look(row.common);
  return found;
}

}  // namespace hapsim
