// A robot's probing of an organ, in the ways such tables are written.
#include <gtest/gtest.h>

#include "recording/force_noise.h"
#include "synthetic.h"

namespace hapsim::test {
namespace {

// Every press lies at its site and every row has the displacement and force it was made from.
void expect_truth(const ImportResult& result, double tolerance_mm, int sites_count = 20) {
  const Recording& out = result.recording;
  const std::vector<Site> all = sites(sites_count);
  ASSERT_EQ(out.presses().size(), all.size());
  ASSERT_EQ(out.rows(), 10 * all.size());
  double place = 0, displacement = 0, force = 0;
  for (std::size_t row = 0; row < out.rows(); ++row) {
    const Site& site = all[row / 10];
    const double depth = 0.5 * (static_cast<double>(row % 10) + 1);
    place = std::max(place, (out.position[row] - 1e-3 * site.point).norm());
    displacement = std::max(displacement, (out.u[row] + 1e-3 * depth * site.normal).norm());
    force = std::max(force, (out.f[row] - organ_force(depth) * site.normal).norm());
  }
  EXPECT_LT(place, 1e-3 * tolerance_mm);
  EXPECT_LT(displacement, 1e-3 * tolerance_mm);
  EXPECT_LT(force, 0.06);
  EXPECT_TRUE(out.t.empty());
}

const std::string kSite = "site,contact_x_mm,contact_y_mm,contact_z_mm,nx,ny,nz";

void expect_no_warning_but_time(const ImportResult& result) {
  ASSERT_EQ(result.notes.warnings.size(), 1u);
  EXPECT_TRUE(mentions(result.notes.warnings, "no column is a time"));
}

TEST(ImportOrgan, TipAndContactInMillimetres) {
  const ImportResult result =
      import_text(organ(kSite + ",tip_x_mm,tip_y_mm,tip_z_mm,fx_N,fy_N,fz_N",
                        [](int i, const Site& s, double d, const Vec3& f) {
                          return std::to_string(i) + cells(s.point) + cells(s.normal) +
                                 cells(s.point - d * s.normal) + cells(f);
                        }));
  expect_truth(result, 0.001);
  expect_no_warning_but_time(result);
  ASSERT_EQ(result.touched.size(), 20u);
  EXPECT_NEAR(result.touched[0].normal.norm(), 1, 1e-9);
}

TEST(ImportOrgan, ForceNoiseIsEstimated) {
  const ImportResult result = import_text(organ(
      kSite + ",depth_mm,fx_N,fy_N,fz_N",
      [](int i, const Site& s, double d, const Vec3& f) {
        return std::to_string(i) + cells(s.point) + cells(s.normal) + fmt::format(",{}", d) +
               cells(f);
      },
      60));
  const auto sigma = result.recording.metadata.number("force_noise", "");
  ASSERT_TRUE(sigma);
  EXPECT_NEAR(*sigma, 0.01, 0.003);
}

// What is written as force_noise is what every tool would measure of the same table, whether the
// sensor has three axes, one along the normal, or one of the robot's.
TEST(ImportOrgan, ForceNoiseIsThatOfTheTableWritten) {
  for (const std::string columns : {"fx_N,fy_N,fz_N", "force_N", "fx_N,fy_N,fz_N one axis"}) {
    const bool one = columns.find("one") != std::string::npos;
    const ImportResult result = import_text(organ(
        kSite + ",depth_mm," + columns.substr(0, columns.find(' ')),
        [&](int i, const Site& s, double d, const Vec3& f) {
          const std::string place =
              std::to_string(i) + cells(s.point) + cells(s.normal) + fmt::format(",{}", d);
          if (columns == "force_N") return place + fmt::format(",{:.5f}", f.dot(s.normal));
          return place + cells(one ? Vec3(0, 0, f.z()) : f);
        },
        60));
    Recording written = result.recording;
    const auto declared = written.metadata.number("force_noise", "");
    ASSERT_TRUE(declared) << columns;
    written.metadata.remove("force_noise");
    EXPECT_NEAR(force_noise(written).value / *declared, 1, 0.006) << columns;  // three digits
    const double truth = columns == "force_N" ? 0.01 / std::sqrt(3.0) : 0.01;
    EXPECT_NEAR(*declared / truth, 1, 0.12) << columns;
  }
}

TEST(ImportOrgan, BarePositionsWithDepthWithoutUnits) {
  const ImportResult result = import_text(organ(
      "point,x,y,z,nx,ny,nz,depth,fx,fy,fz", [](int i, const Site& s, double d, const Vec3& f) {
        return std::to_string(i) + cells(s.point) + cells(s.normal) + fmt::format(",{}", d) +
               cells(f);
      }));
  expect_truth(result, 0.001);
  EXPECT_TRUE(mentions(result.notes.warnings, "taken for mm"));
}

TEST(ImportOrgan, ForcesIntoTheBodyAndNormalsInward) {
  const ImportResult result =
      import_text(organ(kSite + ",tip_x_mm,tip_y_mm,tip_z_mm,fx_mN,fy_mN,fz_mN",
                        [](int i, const Site& s, double d, const Vec3& f) {
                          return std::to_string(i) + cells(s.point) + cells(-s.normal) +
                                 cells(s.point - d * s.normal) + cells(-1000 * f);
                        }));
  expect_truth(result, 0.001);
  EXPECT_TRUE(mentions(result.notes.facts, "normals point inward"));
  EXPECT_TRUE(mentions(result.notes.facts, "forces pointed into the body"));
}

TEST(ImportOrgan, CamelCaseNumberedComponentsWithoutSites) {
  std::string header;
  for (const char* name : {"ContactPoint", "ContactSurfNorm", "CurrentPos", "DeformedForce"})
    for (int i = 1; i <= 3; ++i)
      header += fmt::format("{}{}_{}", header.empty() ? "" : ",", name, i);
  const ImportResult result = import_text(organ(header, [](int, const Site& s, double d,
                                                           const Vec3& f) {
    return (cells(s.point) + cells(s.normal) + cells(s.point - d * s.normal) + cells(f)).substr(1);
  }));
  expect_truth(result, 0.001);
}

TEST(ImportOrgan, BallCentresAreRecognised) {
  ImportOptions options;
  options.tool_radius = 3.2e-3;
  const auto text = organ(kSite + ",current_x_mm,current_y_mm,current_z_mm,fx,fy,fz",
                          [](int i, const Site& s, double d, const Vec3& f) {
                            return std::to_string(i) + cells(s.point) + cells(s.normal) +
                                   cells(s.point + (3.2 - d) * s.normal) + cells(f);
                          });
  const ImportResult result = import_text(text, options);
  expect_truth(result, 0.001);
  EXPECT_TRUE(mentions(result.notes.warnings, "centre of a ball"));
  options.tip = "surface";
  EXPECT_GT(import_text(text, options).recording.u[0].z(), 1e-3);
}

TEST(ImportOrgan, CentreAtContactIsTheOrigin) {
  const ImportResult result = import_text(organ(
      kSite + ",ContactBallCenter_x [mm],ContactBallCenter_y [mm],ContactBallCenter_z [mm],"
              "CurrentPos_x [mm],CurrentPos_y [mm],CurrentPos_z [mm],fx,fy,fz",
      [](int i, const Site& s, double d, const Vec3& f) {
        return std::to_string(i) + cells(s.point) + cells(s.normal) +
               cells(s.point + 3.2 * s.normal) + cells(s.point + (3.2 - d) * s.normal) + cells(f);
      }));
  expect_truth(result, 0.001);
}

TEST(ImportOrgan, TipPathAndMagnitudeOnly) {
  const ImportResult result = import_text(organ("site,tip x [mm],tip y [mm],tip z [mm],force [N]",
                                                [](int i, const Site& s, double d, const Vec3& f) {
                                                  return std::to_string(i) +
                                                         cells(s.point - d * s.normal) +
                                                         fmt::format(",{:.5f}", f.dot(s.normal));
                                                }));
  expect_truth(result, 0.3);
  EXPECT_TRUE(mentions(result.notes.facts, "begin in contact"));
}

TEST(ImportOrgan, SitesAreToldApartByJumps) {
  const ImportResult result = import_text(
      organ("tip_x_mm,tip_y_mm,tip_z_mm,fx,fy,fz", [](int, const Site& s, double d, const Vec3& f) {
        return (cells(s.point - d * s.normal) + cells(f)).substr(1);
      }));
  EXPECT_GE(result.recording.presses().size(), 19u);  // two random sites may lie side by side
}

TEST(ImportOrgan, SensorFrameIsNotedAndMagnitudeHelps) {
  const auto text =
      organ(kSite + ",depth_mm,fx,fy,fz", [](int i, const Site& s, double d, const Vec3& f) {
        return std::to_string(i) + cells(s.point) + cells(s.normal) + fmt::format(",{}", d) +
               cells(Vec3(f.norm(), 0, 0.1));
      });
  EXPECT_TRUE(mentions(import_text(text).notes.warnings, "sensor's frame"));
  ImportOptions options;
  options.force = "magnitude";
  EXPECT_FALSE(mentions(import_text(text, options).notes.warnings, "sensor's frame"));
}

TEST(ImportOrgan, CommentsTellUnitsAndRadius) {
  const ImportResult result = import_text("# tool_radius: 3 mm\n# units: mm, N\n" +
                                          organ("point,x,y,z,nx,ny,nz,depth,fx,fy,fz",
                                                [](int i, const Site& s, double d, const Vec3& f) {
                                                  return std::to_string(i) + cells(s.point) +
                                                         cells(s.normal) + fmt::format(",{}", d) +
                                                         cells(f);
                                                }));
  expect_truth(result, 0.001);
  expect_no_warning_but_time(result);
  EXPECT_EQ(*result.recording.metadata.find("tool_radius"), "0.003");
}

TEST(ImportOrgan, TimeOfTheVisitIsNoTime) {
  const ImportResult result = import_text(
      organ(kSite + ",time_s,depth_mm,fx,fy,fz", [](int i, const Site& s, double d, const Vec3& f) {
        return std::to_string(i) + cells(s.point) + cells(s.normal) +
               fmt::format(",{},{}", 20 * i, d) + cells(f);
      }));
  expect_truth(result, 0.001);
}

TEST(ImportOrgan, FailedSitesAndUnknownColumns) {
  const ImportResult result = import_text(organ(kSite + ",depth_mm,fx,fy,fz,Fail,ContactFlags",
                                                [](int i, const Site& s, double d, const Vec3& f) {
                                                  return std::to_string(i) + cells(s.point) +
                                                         cells(s.normal) + fmt::format(",{}", d) +
                                                         cells(f) + (i == 4 ? ",1,0" : ",0,1");
                                                }));
  EXPECT_EQ(result.recording.presses().size(), 19u);
  ASSERT_EQ(result.recording.extra_header, std::vector<std::string>{"ContactFlags"});
}

TEST(ImportOrgan, HapsimFormatPassesThrough) {
  const ImportResult result = import_text(
      "# tool_radius: 0.004\n# force_noise: 0.02\npress,t,x,y,z,ux,uy,uz,fx,fy,fz,contact\n"
      "7,0,0.01,0.02,0.05,0,0,0.001,0,0,0,0\n7,0.1,0.01,0.02,0.05,0,0,0,0,0,0.1,1\n"
      "7,0.2,0.01,0.02,0.05,0,0,-0.001,0,0,1,1\n7,0.3,0.01,0.02,0.05,0,0,-0.002,0,0,2,1\n");
  const Recording& out = result.recording;
  EXPECT_EQ(out.press, (std::vector<int>{7, 7, 7, 7}));
  EXPECT_EQ(out.u[3], Vec3(0, 0, -0.002));
  EXPECT_EQ(out.position[0], Vec3(0.01, 0.02, 0.05));
  EXPECT_EQ(out.contact, (std::vector<char>{0, 1, 1, 1}));
  EXPECT_EQ(*out.metadata.find("force_noise"), "0.02");
}

}  // namespace
}  // namespace hapsim::test
