// Recordings of real machines, where they are at hand: the folder realdata below HAPSIM_SHARED, or
// below "shared" beside the sources.
#include <gtest/gtest.h>

#include <filesystem>

#include "support/needs.h"
#include "synthetic.h"

namespace hapsim::test {
namespace {

ImportResult import_file(const std::filesystem::path& file) {
  Input input(file.string());
  return import_recording(read_raw_table(input), {});
}

double largest_force(const Recording& recording) {
  double most = 0;
  for (const Vec3& f : recording.f) most = std::max(most, f.norm());
  return most;
}

struct Folder {
  const char* name;
  double least_depth, most_depth;  // [m]
  const char* tool_radius;         // that the table tells, or ""
};

TEST(ImportShared, EveryTableComesThrough) {
  const std::string root = shared_path("realdata");
  HAPSIM_NEEDS_SHARED(root);
  for (const Folder& folder :
       {Folder{"afm", 1e-7, 2e-6, ""}, Folder{"dvrk_liver", 1e-3, 0.01, "0.004"},
        Folder{"dvrk_meat", 1e-3, 0.01, "0.00316"}, Folder{"phantom_balls", 1e-3, 0.01, "0.00316"},
        Folder{"kidney_touch", 1e-3, 0.1, ""}, Folder{"meat_zwick", 1e-3, 0.015, ""},
        Folder{"silicone_compression", 0.01, 0.025, ""}, Folder{"vhb_tension", 0.03, 0.17, ""}}) {
    std::size_t files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(root + "/" + folder.name)) {
      if (entry.path().extension() != ".csv") continue;
      SCOPED_TRACE(entry.path().string());
      ++files;
      ImportResult result;
      ASSERT_NO_THROW(result = import_file(entry.path()));
      const Recording& out = result.recording;
      double depth = 0, outward = 0;
      for (std::size_t i = 0; i < out.rows(); ++i) {
        if (!out.in_air(i)) depth = std::max(depth, out.u[i].norm());
        if (!out.in_air(i)) outward -= out.f[i].dot(out.u[i]);
      }
      EXPECT_GT(depth, folder.least_depth);
      EXPECT_LT(depth, folder.most_depth);
      if (!out.metadata.find("motion")) {
        EXPECT_GT(outward, 0) << "the force does not push the tool out";
      }
      EXPECT_EQ(out.metadata.find("tool_radius").value_or(""), folder.tool_radius);
    }
    EXPECT_GT(files, 0u) << folder.name;
  }
}

TEST(ImportShared, UnitsHeightsAndEncodingsAreRight) {
  const std::string root = shared_path("realdata");
  HAPSIM_NEEDS_SHARED(root);
  // Of the columns as they are written: 0.0709 nN, 1.05 N.
  EXPECT_NEAR(largest_force(import_file(root + "/afm/afm_workshop_single.csv").recording), 7.09e-11,
              1e-13);
  const ImportResult meat = import_file(root + "/meat_zwick/meat_230331_FF1_1A_force.csv");
  EXPECT_NEAR(*meat.recording.metadata.number("thickness", ""), 14.3232814e-3, 1e-7);
  EXPECT_GT(meat.recording.t.back(), 16);
  const ImportResult tape = import_file(root + "/vhb_tension/0d01_1d5.csv");
  EXPECT_TRUE(mentions(tape.notes.facts, "GB18030"));
  EXPECT_NEAR(tape.recording.t.back(), 100.078, 1e-3);
  EXPECT_EQ(import_file(root + "/kidney_touch/kidney_explore_z1-4_every8th.csv")
                .recording.presses()
                .size(),
            4u);
}

}  // namespace
}  // namespace hapsim::test
