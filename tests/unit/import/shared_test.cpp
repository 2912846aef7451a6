// Recordings of real machines, where they are at hand: the folder realdata below HAPSIM_SHARED, or
// below "shared" beside the sources.
#include <gtest/gtest.h>

#include <filesystem>

#include "support/needs.h"
#include "synthetic.h"

namespace hapsim::test {
namespace {

std::vector<std::filesystem::path> real_recordings(const std::string& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    if (entry.path().extension() == ".csv" || entry.path().extension() == ".tsv")
      files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

TEST(ImportShared, RealRecordingsComeThrough) {
  const std::string folder = shared_path("realdata/a_force");
  HAPSIM_NEEDS_SHARED(folder);
  const auto files = real_recordings(folder);
  ASSERT_FALSE(files.empty()) << folder;
  for (const auto& file : files) {
    SCOPED_TRACE(file.filename().string());
    Input input(file.string());
    const RawTable table = read_raw_table(input);
    ImportResult result;
    ASSERT_NO_THROW(result = import_recording(table, {})) << describe_columns(table, {});
    const Recording& out = result.recording;
    double depth = 0, outward = 0;
    for (std::size_t i = 0; i < out.rows(); ++i) {
      if (!out.in_air(i)) depth = std::max(depth, out.u[i].norm());
      outward -= out.f[i].dot(out.u[i]);
    }
    EXPECT_GT(depth, 1e-4) << describe_columns(table, {});
    EXPECT_LT(depth, 0.05) << describe_columns(table, {});
    EXPECT_GT(outward, 0) << "the force does not push the tool out";
  }
}

}  // namespace
}  // namespace hapsim::test
