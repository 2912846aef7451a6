#include "scan/sections.h"

#include <gtest/gtest.h>

#include <cmath>

#include "expect_error.h"

namespace hapsim {
namespace {

CsvTable table(const std::string& csv) {
  Input input = Input::from_bytes(csv, "ct.csv");
  return read_csv(input);
}

// Sections of a hollow ball (radii 40 and 15 mm), 4 mm apart, contours of 80 points in millimetres;
// the direction changes from contour to contour.
std::string hollow_ball() {
  std::string csv = "section,contour,x,y,z\n";
  for (int s = 0; s <= 18; ++s) {
    const double z = -36 + 4 * s;
    for (const double radius : {40., 15.}) {
      if (std::abs(z) >= radius) continue;
      const double r = std::sqrt(radius * radius - z * z);
      for (int i = 0; i < 80; ++i) {
        const double turn = 2 * M_PI * i / 80 * (s % 2 == 0 ? 1 : -1);
        csv += std::to_string(s) + (radius > 20 ? ",a," : ",b,") + format_number(r * cos(turn)) +
               "," + format_number(r * sin(turn)) + "," + format_number(z) + "\n";
      }
    }
  }
  return csv;
}

TEST(Sections, OfAHollowBallGiveItsSurfaceAndNormals) {
  const auto sections = read_sections(table(hollow_ball()), 1e-3, 0);
  ASSERT_EQ(sections.size(), 19u);
  EXPECT_EQ(sections[9].contours.size(), 2u);
  const Scan scan = sections_scan(sections);
  double worst = 0, turned = 1;
  for (std::size_t i = 0; i < scan.cloud.points.size(); ++i) {
    const Vec3& p = scan.cloud.points[i];
    const bool hole = p.norm() < 0.025;
    // Near the poles the contours jump by more than the sections are apart.
    if (std::abs(p.z()) > (hole ? 0.01 : 0.03)) continue;
    worst = std::max(worst, std::abs(p.norm() - (hole ? 0.015 : 0.04)));
    turned = std::min(turned, scan.cloud.normals[i].dot(p.normalized()) * (hole ? -1 : 1));
  }
  std::printf("sections: %zu points, worst %.3f mm, normals within %.1f deg\n",
              scan.cloud.points.size(), 1e3 * worst, std::acos(turned) * 180 / M_PI);
  EXPECT_LT(worst, 2.5e-4);  // half the rise of the arc between two sections: 4^2 / (8 15) = 0.13
  EXPECT_GT(turned, 0.97);
}

TEST(Sections, MayBeGroupedByZOrSpacedByDistance) {
  std::string by_z = "x,y,z\n", by_number = "slice,x,y\n";
  for (int s = 3; s > 0; --s) {
    for (const char* p : {"0,0", "1,0", "1,1", "0,1", "0,0"}) {
      by_z += std::string(p) + "," + std::to_string(s) + "\n";
      by_number += std::to_string(s) + "," + p + "\n";
    }
  }
  const auto a = read_sections(table(by_z), 1, 0), b = read_sections(table(by_number), 1, 1);
  ASSERT_EQ(a.size(), 3u);
  ASSERT_EQ(b.size(), 3u);
  for (int s = 0; s < 3; ++s) {
    EXPECT_EQ(a[s].z, s + 1);
    EXPECT_EQ(b[s].z, s + 1);
    EXPECT_EQ(a[s].contours[0].size(), 4u);
    EXPECT_DOUBLE_EQ(a[s].distance({0.5, 0.25}), -0.25);
    EXPECT_DOUBLE_EQ(a[s].distance({2, 0.25}), 1);
  }
}

TEST(Sections, RefuseWhatAreNone) {
  const auto message = [](const std::string& csv, double distance = 0) {
    return error_of([&] { read_sections(table(csv), 1, distance); });
  };
  EXPECT_NE(message("section,x,y,z\n1,0,0,0\n1,1,0,0\n1,0,1,0\n").find("there are 1 sections"),
            std::string::npos);
  EXPECT_NE(message("section,x,y,z\n1,0,0,0\n1,1,0,0\n1,0,1,0.5\n").find("ct.csv:4: section 1"),
            std::string::npos);
  EXPECT_NE(message("x,y,z\n0,0,0\n1,0,0\n1,1,0\n0,0,1\n0,0,1\n")
                .find("ct.csv:5: a contour has "
                      "only 1 different point;"),
            std::string::npos);
  EXPECT_NE(message("section,x,y\n1,0,0\n").find("--section-distance"), std::string::npos);
  EXPECT_NE(message("section,x,y,z\n1,nan,0,0\n").find("line 2"), std::string::npos);
  EXPECT_NE(message("section,x,y,z\n").find("there are 0 sections"), std::string::npos);
}

}  // namespace
}  // namespace hapsim
