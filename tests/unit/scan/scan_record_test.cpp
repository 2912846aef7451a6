#include "scan/scan_record.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "support/told.h"

namespace hapsim {
namespace {

TEST(ScanRecord, HasOnlyWhatWasDone) {
  ScanRecord record;
  record.cleaned.read = 10;
  record.cleaned.duplicates = 1;
  record.cleaned.kept = 9;
  record.spacing = 0.002;
  record.normals = "given";
  auto json = nlohmann::json::parse(scan_json(record));
  EXPECT_EQ(json.size(), 1u);
  EXPECT_EQ(json["points"]["kept"], 9);
  EXPECT_TRUE(test::tells(
      points_summary(record, "mm"),
      "9 of 10 points kept 2 mm apart POINTS 10 points read in mm; removed 1 given twice"));
  record.touch = TouchReport{0.001, 0.002, 0.003};
  record.volume = ScanRecord::VolumeRead{"NRRD", {4, 5, 6}, {}};
  record.volume->surface.voxels = 7;
  record.registered = RegisterReport{};
  record.registered->fixed = "a";
  record.registered->zones.resize(2);
  record.registered->zones[0].name = "a";
  record.registered->zones[1].name = "b";
  record.registered->zones[1].shift = Vec3(0.001, 0, 0);
  json = nlohmann::json::parse(scan_json(record));
  EXPECT_EQ(json["indentation"]["mean"], 0.002);
  EXPECT_EQ(json["volume"]["size"], (std::vector<int>{4, 5, 6}));
  EXPECT_EQ(json["volume"]["body_voxels"], 7);
  EXPECT_EQ(json["zones"][0]["fixed"], true);
  EXPECT_EQ(json["zones"][1]["shift"][0], 0.001);
  const std::vector<std::string> lines = zone_lines(*record.registered);
  EXPECT_EQ(lines.at(0).rfind("zone a stays", 0), 0u);
  EXPECT_EQ(lines.at(1).rfind("zone b shifted by 1.000 0.000 0.000 mm", 0), 0u);
  EXPECT_EQ(touch_words(*record.touch),
            "indentation of the touch undone: 2.000 mm (1.000 to 3.000)");
}

// Points of a plane, seen from below: normals that are given stay, others are turned to the sensor.
TEST(ScanRecord, NormalsFaceTheSensor) {
  PointCloud plane;
  for (int i = 0; i < 10; ++i)
    for (int k = 0; k < 10; ++k) plane.points.emplace_back(0.01 * i, 0.01 * k, 0);
  Scan scan;
  scan.cloud = plane;
  scan.to_sensor.assign(plane.points.size(), -Vec3::UnitZ());
  std::vector<int> index;
  for (std::size_t i = 0; i < plane.points.size(); ++i) index.push_back(static_cast<int>(i));
  const std::string words = complete_normals(plane, scan, index);
  EXPECT_NE(words.find(", towards the sensor"), std::string::npos) << words;
  for (const Vec3& n : plane.normals) EXPECT_NEAR(n.z(), -1, 1e-9);
  EXPECT_EQ(complete_normals(plane, scan, index), "given");
}

}  // namespace
}  // namespace hapsim
