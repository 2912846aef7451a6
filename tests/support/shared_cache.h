// One cache of prepared contacts for all tests of a process, which goes away with it.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

namespace hapsim::test {

inline const std::string& shared_cache() {
  struct Directory {
    Directory() { mkdtemp(path.data()); }
    ~Directory() { std::filesystem::remove_all(path); }
    std::string path = (std::filesystem::temp_directory_path() / "hapsim-test-XXXXXX").string();
  };
  static const Directory directory;
  return directory.path;
}

}  // namespace hapsim::test
