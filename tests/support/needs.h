// What a test needs besides the sources: programs, which run-tests.sh installs and without which a
// test fails, and the recordings of real machines and of other solvers, without which it is
// skipped.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

// Fails the test, or the whole fixture from SetUp, where the program is not installed.
#define HAPSIM_NEEDS_PROGRAM(name)                                 \
  ASSERT_EQ(std::system("command -v " name " >/dev/null 2>&1"), 0) \
      << name " is not installed: share/install-deps.sh --tests"

// Skips it where the file or folder of shared recordings is not there, and says so.
#define HAPSIM_NEEDS_SHARED(path)                   \
  if (!std::filesystem::exists(path))               \
  GTEST_SKIP() << "SKIPPED: there is no " << (path) \
               << "; set HAPSIM_SHARED to the folder of shared recordings"

namespace hapsim::test {

// A file or folder of HAPSIM_SHARED, by default of "shared" beside the sources; it need not be
// there.
inline std::string shared_path(const std::string& name) {
  const char* folder = std::getenv("HAPSIM_SHARED");
  return (folder != nullptr ? std::string(folder) : std::string(HAPSIM_SOURCE_DIR "/../shared")) +
         "/" + name;
}

}  // namespace hapsim::test
