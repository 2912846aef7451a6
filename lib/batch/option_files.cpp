#include "batch/option_files.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace hapsim {
namespace {

// Of the tools of kBatchStages. Those that a tool writes are none: what it made would then seem to
// have changed. A --library, which every fit reads and adds to, is left out for the same reason.
constexpr std::array<std::string_view, 12> kReading{
    "--body",  "--calibration", "--contacts", "--curved-to", "--data",      "--diagnosis",
    "--fixed", "--model",       "--region",   "--robot",     "--simulated", "--zone"};

// Where in `value`, from `begin` on, the first path stands; its length 0: nowhere.
struct Place {
  std::size_t begin = 0, length = 0;
};
Place next_path(const std::string& flag, const std::string& value, std::size_t begin) {
  if (flag == "--fixed") {  // conditions joined by +
    const std::size_t file = value.find("file:", begin);
    if (file == value.npos) return {};
    const std::size_t path = file + 5;
    return {path, std::min(value.find('+', path), value.size()) - path};
  }
  if (begin > 0) return {};
  const bool named = flag == "--simulated" || flag == "--diagnosis";
  const std::size_t equals = named ? value.find('=') : value.npos;
  const std::size_t path = equals == value.npos ? 0 : equals + 1;
  return {path, value.size() - path};
}

}  // namespace

std::vector<std::string> name_files(
    std::vector<std::string>& words,
    const std::function<std::string(const std::string&)>& from_here) {
  std::vector<std::string> files;
  for (std::size_t w = 0; w < words.size(); ++w) {
    const std::size_t equals = std::min(words[w].find('='), words[w].size());
    const std::string flag = words[w].substr(0, equals);
    if (std::find(kReading.begin(), kReading.end(), flag) == kReading.end()) continue;
    const bool joined = equals < words[w].size();
    if (!joined && ++w == words.size()) break;
    std::string value = joined ? words[w].substr(equals + 1) : words[w];
    std::size_t begin = 0;
    for (Place at = next_path(flag, value, begin); at.length > 0;
         at = next_path(flag, value, begin)) {
      const std::string path = value.substr(at.begin, at.length);
      if (path == "-") break;
      files.push_back(from_here(path));
      value.replace(at.begin, at.length, files.back());
      begin = at.begin + files.back().size();
    }
    words[w] = joined ? flag + "=" + value : value;
  }
  return files;
}

}  // namespace hapsim
