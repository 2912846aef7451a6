// Tables of marked points: columns, units, what is refused.
#include "recording/marker_table.h"

#include <gtest/gtest.h>

#include <sstream>

#include "expect_error.h"

namespace hapsim {
namespace {

MarkerTable read(const std::string& text, bool need_motion = true) {
  Input input = Input::from_bytes(text, "m.csv");
  return read_markers(input, need_motion);
}

TEST(MarkerTable, IsReadAndWritten) {
  const std::string text =
      "# marker_noise: 2e-5\npoint,t,x,y,z,ux,uy,uz,press\na,0,0.01,0.02,0,0,0,-0.001,1\n"
      "b,0,0.03,0.02,0,0,1e-4,-0.0005,1\na,0.1,0.01,0.02,0,0,0,-0.002,2\n";
  const MarkerTable table = read(text);
  ASSERT_EQ(table.points, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(table.point, (std::vector<int>{0, 1, 0}));
  EXPECT_EQ(table.press, (std::vector<int>{1, 1, 2}));
  EXPECT_EQ(table.rest[1], Vec3(0.03, 0.02, 0));
  EXPECT_EQ(table.u[2], Vec3(0, 0, -0.002));
  EXPECT_EQ(table.noise(), 2e-5);
  std::ostringstream out;
  write_markers(out, table);
  std::ostringstream again;
  write_markers(again, read(out.str()));
  EXPECT_EQ(out.str(), again.str());
}

TEST(MarkerTable, HasUnitsInItsHeader) {
  const MarkerTable table =
      read("point,t_ms,x [mm],y_mm,z (cm),ux_um,uy_mm,uz\na,250,10,20,3,500,1,0.002\n");
  EXPECT_DOUBLE_EQ(table.t[0], 0.25);
  EXPECT_LT((table.rest[0] - Vec3(0.01, 0.02, 0.03)).norm(), 1e-15);
  EXPECT_LT((table.u[0] - Vec3(0.0005, 0.001, 0.002)).norm(), 1e-15);
  EXPECT_NE(error_of([] {
              read("point,t,x_furlong,y,z,ux,uy,uz\na,0,1,1,1,0,0,0\n");
            }).find("known are m"),
            std::string::npos);
}

TEST(MarkerTable, OfPointsAloneHasNoRows) {
  const MarkerTable table = read("point,x,y,z\na,0,0,0\nb,0,0,1\n", false);
  EXPECT_EQ(table.rows(), 0u);
  EXPECT_EQ(table.points.size(), 2u);
  error_of([] { read("point,x,y,z\na,0,0,0\n"); });
}

TEST(MarkerTable, RefusesWhatCannotBe) {
  EXPECT_NE(error_of([] { read("point,t,x,y,z,ux,uy,uz\na,0,60,1,1,0,0,0\n"); }).find("x_mm"),
            std::string::npos);
  EXPECT_NE(error_of([] {
              read("point,t,x,y,z,ux,uy,uz\na,0,0,0,0,0,0,0\na,1,0,0,0.001,0,0,0\n");
            }).find("m.csv:3: the rest position of point a"),
            std::string::npos);
  EXPECT_NE(error_of([] {
              read("# marker_noise: 20\npoint,t,x,y,z,ux,uy,uz\na,0,0,0,0,0,0,0\n");
            }).find("marker_noise"),
            std::string::npos);
  EXPECT_NE(error_of([] { read("t,x,y,z,ux,uy,uz\n0,0,0,0,0,0,0\n"); }).find("point"),
            std::string::npos);
}

}  // namespace
}  // namespace hapsim
