#include "scan/register.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"
#include "expect_error.h"
#include "io/number.h"
#include "scan/touch.h"

namespace hapsim {
namespace {

// Height of an organ-like surface over 140 x 120 mm: a dome with lobes.
double organ(double x, double y) {
  return 0.05 - 3 * x * x - 4 * y * y + 0.004 * sin(70 * x + 1) * cos(60 * y);
}
Vec3 organ_point(double x, double y) {
  return {x, y, organ(x, y)};
}
double organ_distance(const Vec3& p) {
  const double h = 1e-6;
  const Vec3 n(-(organ(p.x() + h, p.y()) - organ(p.x() - h, p.y())) / (2 * h),
               -(organ(p.x(), p.y() + h) - organ(p.x(), p.y() - h)) / (2 * h), 1);
  return (p.z() - organ(p.x(), p.y())) / n.norm();
}

struct Drifted {
  Scan scan;
  std::vector<Pose> drift;
  std::vector<Vec3> truth;
};

// Seven discs of 30 mm radius, one in the middle and six about it, touched `spacing` apart with
// noise; all but the middle drifted by up to 4 mm and 2 degrees.
Drifted seven_zones(double spacing, double noise, std::uint64_t seed, double reach = 0.026) {
  Random random(seed);
  Drifted result;
  for (int z = 0; z < 7; ++z) {
    const double turn = M_PI / 3 * z;
    const Eigen::Vector2d middle =
        z == 0 ? Eigen::Vector2d(0, 0) : Eigen::Vector2d(reach * cos(turn), reach * sin(turn));
    Pose drift = Pose::Identity();
    if (z > 0) {
      const Vec3 axis = Vec3(random.normal(), random.normal(), random.normal()).normalized();
      const Vec3 shift =
          0.004 * (2 * Vec3(random.uniform(), random.uniform(), random.uniform()) - Vec3::Ones()) /
          std::sqrt(3.);
      drift.linear() = Eigen::AngleAxisd(0.035 * random.uniform(), axis).toRotationMatrix();
      const Vec3 centre = organ_point(middle.x(), middle.y());
      drift.translation() = centre + shift - drift.linear() * centre;
    }
    result.drift.push_back(drift);
    result.scan.zone_names.push_back("zone" + std::to_string(z));
    for (double x = -0.03; x <= 0.03; x += spacing) {
      for (double y = -0.03; y <= 0.03; y += spacing) {
        const double a = x + 0.3 * spacing * random.normal(),
                     b = y + 0.3 * spacing * random.normal();
        if (a * a + b * b > 0.0009) continue;
        const Vec3 p = organ_point(middle.x() + a, middle.y() + b);
        result.truth.push_back(p);
        result.scan.cloud.points.push_back(
            drift * (p + noise * Vec3(random.normal(), random.normal(), random.normal())));
        result.scan.zone.push_back(z);
      }
    }
  }
  return result;
}

TEST(Register, SevenDriftedZonesComeBackToWithinTheNoise) {
  for (const auto& [spacing, noise] : {std::pair(0.002, 1e-4), std::pair(0.003, 1e-4)}) {
    Drifted d = seven_zones(spacing, noise, 11);
    double before = 0;
    for (const Vec3& p : d.scan.cloud.points) before += std::pow(organ_distance(p), 2);
    const RegisterReport report = register_zones(d.scan, {.fixed = "zone0"}, "zones.csv");
    double after = 0, moved = 0, worst_ratio = 0;
    std::vector<double> zone_off(7, 0), zone_count(7, 0);
    for (std::size_t i = 0; i < d.truth.size(); ++i) {
      after += std::pow(organ_distance(d.scan.cloud.points[i]), 2);
      moved += (d.scan.cloud.points[i] - d.truth[i]).squaredNorm();
    }
    const double n = static_cast<double>(d.truth.size());
    for (std::size_t z = 1; z < 7; ++z) {
      // The zone's motion undoes its drift: what is left at its centre.
      const double turn = M_PI / 3 * static_cast<double>(z);
      const Vec3 centre = organ_point(0.026 * cos(turn), 0.026 * sin(turn));
      const double left = (report.zones[z].motion * d.drift[z] * centre - centre).norm();
      worst_ratio = std::max(worst_ratio, left / report.zones[z].error);
      EXPECT_LT(left, 4 * noise) << report.zones[z].name;
      EXPECT_LT(report.zones[z].rms_after, 2 * noise);
      EXPECT_GT(report.zones[z].rms_before, 3 * report.zones[z].rms_after);
    }
    std::printf(
        "zones: %.0f points, %d rounds; off the surface %.3f -> %.3f mm rms (noise %.3f), "
        "from their places %.3f mm; drift left up to %.1f standard errors\n",
        n, report.rounds, 1e3 * sqrt(before / n), 1e3 * sqrt(after / n), 1e3 * noise,
        1e3 * sqrt(moved / n), worst_ratio);
    EXPECT_LT(sqrt(after / n), 1.3 * noise);
    // Along the surface only its relief holds the zones: the standard errors say how well.
    EXPECT_LT(sqrt(moved / n), 4 * noise);
    EXPECT_LT(worst_ratio, 5);
  }
}

TEST(Register, RefusesOverlapThatDoesNotSay) {
  Drifted apart = seven_zones(0.004, 1e-4, 5, 0.08);
  EXPECT_NE(error_of([&] { register_zones(apart.scan, {}, "z"); })
                .find("overlaps the others too "
                      "little"),
            std::string::npos);
  // Two halves of a plane slide along each other.
  Random random(2);
  Scan flat;
  flat.zone_names = {"a", "b"};
  for (int z = 0; z < 2; ++z) {
    for (int i = 0; i < 400; ++i) {
      flat.cloud.points.emplace_back(0.1 * random.uniform() + 0.05 * z, 0.1 * random.uniform(),
                                     1e-4 * random.normal() + 0.002 * z);
      flat.zone.push_back(z);
    }
  }
  EXPECT_NE(error_of([&] { register_zones(flat, {}, "z"); }).find("uncertain by"),
            std::string::npos);
  Scan one;
  one.cloud.points.assign(20, Vec3(0, 0, 0));
  EXPECT_NE(error_of([&] { register_zones(one, {}, "z"); }).find("only one zone"),
            std::string::npos);
  EXPECT_NE(error_of([&] { register_zones(apart.scan, {.fixed = "x"}, "z"); }).find("no zone 'x'"),
            std::string::npos);
}

TEST(Register, AGrossOutlierInAHundredDoesNotMatter) {
  Drifted d = seven_zones(0.002, 1e-4, 8);
  Random random(1);
  for (std::size_t i = 0; i < d.truth.size(); i += 100) {
    d.scan.cloud.points[i].z() += 0.005 + 0.01 * random.uniform();
  }
  register_zones(d.scan, {.fixed = "zone0"}, "z");
  double after = 0, count = 0;
  for (std::size_t i = 0; i < d.truth.size(); ++i) {
    if (i % 100 == 0) continue;
    after += std::pow(organ_distance(d.scan.cloud.points[i]), 2);
    ++count;
  }
  EXPECT_LT(sqrt(after / count), 1.5e-4);
}

TEST(Touch, IndentationIsThatOfTheTextbooks) {
  // A worked case by hand: E* = 10 kPa / (1 - 0.25) = 13333.3 Pa, R = 4 mm, F = 0.1 N:
  // a = (3 F R / (4 E*))^(1/3) = 2.8231 mm, depth = a^2 / R = 1.9925 mm.
  TouchModel ball{.E = 1e4, .nu = 0.5, .tip_radius = 0.004};
  EXPECT_NEAR(indentation(0.1, ball),
              std::pow(std::cbrt(3 * 0.1 * 0.004 / (4 * 1e4 / 0.75)), 2) / 0.004, 1e-12);
  EXPECT_NEAR(indentation(0.1, ball), 1.9925e-3, 1e-6);
  TouchModel flat = ball;
  flat.flat = true;
  EXPECT_NEAR(indentation(0.1, flat), 0.1 / (2 * 13333.333333 * 0.004), 1e-9);
  EXPECT_DOUBLE_EQ(indentation(0.1, {.stiffness = 50}), 0.002);
}

TEST(Touch, IsUndoneAlongTheNormal) {
  Scan scan;
  scan.cloud.points = {{0, 0, 0.01}, {0.01, 0, 0}};
  scan.cloud.normals = {{0, 0, 1}, {1, 0, 0}};
  scan.touch_force = {0.1, 0.2};
  const TouchReport report = undo_touch(scan, {.stiffness = 100}, 0.02, "touched");
  EXPECT_NEAR(scan.cloud.points[0].z(), 0.011, 1e-15);
  EXPECT_NEAR(scan.cloud.points[1].x(), 0.012, 1e-15);
  EXPECT_DOUBLE_EQ(report.largest, 0.002);
  EXPECT_NE(error_of([&] {
              undo_touch(scan, {.stiffness = 1}, 0.02, "touched");
            }).find("would push the surface in by 100 mm"),
            std::string::npos);
}

}  // namespace
}  // namespace hapsim
