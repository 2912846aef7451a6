#include "reconstruct/surface_record.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "support/shapes.h"
#include "support/told.h"

namespace hapsim {
namespace {

// A cube of 10 cm: 1000 cm^3.
TEST(SurfaceRecord, TellsMethodBaseAndVolume) {
  const Surface cube = test::box({0.1, 0.1, 0.1});
  ReconstructReport report;
  report.method = ReconstructMethod::kHeight;
  report.why = "asked for";
  report.base = -0.5;
  report.base_why = "given";
  report.far_share = 0.25;
  const SurfaceRecord record = record_reconstruction(cube, report, 99, 7);
  EXPECT_EQ(record.comments,
            (std::vector<std::string>{"hs-reconstruct: method height, seed 7",
                                      "method height: asked for", "base_plane 0 0 1 -0.5"}));
  EXPECT_TRUE(test::tells(record.summary, "method height 1000 cm^3 METHOD height: asked for"));
  EXPECT_TRUE(test::tells(record.summary, "base z = -0.5 m (given)")) << test::told(record.summary);
  const auto json = nlohmann::json::parse(record.json);
  EXPECT_EQ(json["points"], 99);
  EXPECT_EQ(json["faces"], cube.faces.size());
  EXPECT_NEAR(json["volume"], 1e-3, 1e-15);
  report.has_base = false;
  EXPECT_FALSE(
      nlohmann::json::parse(record_reconstruction(cube, report, 99, 7).json).contains("base"));
}

TEST(SurfaceRecord, OnlyWhatWasMendedHasRepairs) {
  const Surface cube = test::box({0.1, 0.1, 0.1});
  RepairReport repairs;
  repairs.holes = 2;
  const auto mended = nlohmann::json::parse(record_repair(cube, &repairs, 500).json);
  EXPECT_EQ(mended["method"], "repair");
  EXPECT_EQ(mended["triangles"], 500);
  EXPECT_TRUE(mended.contains("repairs"));
  const auto wrapped = nlohmann::json::parse(record_repair(cube, nullptr, 500).json);
  EXPECT_EQ(wrapped["method"], "wrap");
  EXPECT_FALSE(wrapped.contains("repairs"));
}

}  // namespace
}  // namespace hapsim
