#include "io/allowed_outputs.h"

#include <cstdlib>
#include <filesystem>
#include <sstream>

#include "base/error.h"

namespace hapsim {
namespace {

namespace fs = std::filesystem;

// The file that would be written, without links and dots; one that is absent by its folder.
fs::path real(const std::string& path) {
  std::error_code error;
  const fs::path whole = fs::weakly_canonical(fs::absolute(path, error), error);
  return error ? fs::path() : whole;
}

bool lies_in(const fs::path& folder, const fs::path& file) {
  auto at = file.begin();
  for (const fs::path& part : folder) {
    if (part.empty()) continue;  // after a slash at the end
    if (at == file.end() || *at != part) return false;
    ++at;
  }
  return at != file.end();
}

}  // namespace

void require_allowed_output(const std::string& path) {
  const char* allowed = std::getenv(kWritesVariable);
  if (allowed == nullptr) return;
  const fs::path file = real(path);
  // An entry of a cache, whose name and sum are of its content.
  if (file.extension() == ".contact") return;
  std::istringstream names(allowed);
  for (std::string name; std::getline(names, name);) {
    if (name.empty() || file.empty()) continue;
    if (name.back() == '/' ? lies_in(real(name), file) : real(name) == file) return;
  }
  fail_io(path, "this file may not be written from here",
          std::string("name one in the folder of the recording's own files; see ") +
              kWritesVariable + " in hs-batch(1)");
}

}  // namespace hapsim
