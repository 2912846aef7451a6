#include "repair/repair.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>

#include "base/random.h"
#include "support/shapes.h"

namespace hapsim {
namespace {

constexpr int kSide = 8;

Surface good() {
  return test::dome(0.05, kSide);
}

// Each triangle with corners of its own.
Surface unwelded(const Surface& s, double jitter) {
  Random random(2);
  Surface apart;
  for (const Triangle& f : s.faces) {
    const int first = static_cast<int>(apart.vertices.size());
    for (const int v : f) {
      apart.vertices.push_back(s.vertices[v] +
                               jitter * Vec3(random.normal(), random.normal(), random.normal()));
    }
    apart.faces.push_back({first, first + 1, first + 2});
  }
  return apart;
}

Surface moved(Surface s, double factor, const Vec3& by) {
  for (Vec3& p : s.vertices) p = factor * p + by;
  return s;
}

void append(Surface& s, const Surface& other) {
  const int first = static_cast<int>(s.vertices.size());
  s.vertices.insert(s.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const Triangle& f : other.faces) {
    s.faces.push_back({f[0] + first, f[1] + first, f[2] + first});
  }
}

// The volume of the good copy.
void expect_mended(const Surface& damaged, RepairReport& report, double relative = 1e-9) {
  const Surface mended = repair_surface(damaged, "damaged.stl", report);
  EXPECT_TRUE(is_closed(mended));
  EXPECT_NEAR(signed_volume(mended) / signed_volume(good()), 1, relative);
}

TEST(Repair, ASoundSurfaceComesBackAsItWas) {
  RepairReport report;
  const Surface mended = repair_surface(good(), "good.stl", report);
  EXPECT_EQ(report.total(), 0);
  EXPECT_EQ(mended.faces.size(), good().faces.size());
  EXPECT_EQ(report.text(), "nothing to mend");
}

TEST(Repair, UnweldedAndJittered) {
  RepairReport report;
  expect_mended(unwelded(good(), 0), report);
  EXPECT_GT(report.welded, 0);
  report = {};
  expect_mended(unwelded(good(), 2e-6), report, 1e-3);
  EXPECT_EQ(report.holes, 0);
}

TEST(Repair, FlippedTriangles) {
  Surface damaged = good();
  for (std::size_t f = 0; f < damaged.faces.size(); f += 7) {
    std::swap(damaged.faces[f][1], damaged.faces[f][2]);
  }
  RepairReport report;
  expect_mended(damaged, report);
  EXPECT_EQ(report.flipped, static_cast<int>((damaged.faces.size() + 6) / 7));
}

TEST(Repair, HolesAreClosed) {
  Surface damaged = good();
  damaged.faces.erase(damaged.faces.begin() + 40);
  damaged.faces.erase(damaged.faces.begin() + 10);
  RepairReport report;
  expect_mended(damaged, report);
  EXPECT_EQ(report.holes, 2);
  EXPECT_EQ(report.added_triangles, 2);
}

TEST(Repair, DuplicatesDegenerateAndStray) {
  Surface damaged = good();
  damaged.faces.push_back(damaged.faces[3]);
  damaged.faces.push_back({0, 1, 0});
  damaged.vertices.push_back(Vec3(1, 1, 1));
  RepairReport report;
  expect_mended(damaged, report);
  EXPECT_EQ(report.duplicate, 1);
  EXPECT_EQ(report.degenerate, 1);
  EXPECT_EQ(report.stray_vertices, 1);
}

TEST(Repair, TJunction) {
  Surface damaged = good();
  const Triangle f = damaged.faces[5];
  const int middle = static_cast<int>(damaged.vertices.size());
  damaged.vertices.push_back((damaged.vertices[f[0]] + damaged.vertices[f[1]]) / 2);
  damaged.faces[5] = {f[0], middle, f[2]};
  damaged.faces.push_back({middle, f[1], f[2]});
  RepairReport report;
  expect_mended(damaged, report);
  EXPECT_EQ(report.t_junctions, 1);
  EXPECT_EQ(report.holes, 0);
}

TEST(Repair, LoosePartsAndInnerShells) {
  Surface damaged = good();
  append(damaged, moved(good(), 0.1, Vec3(0.2, 0, 0)));
  append(damaged, moved(good(), 0.2, Vec3(0, 0, 0.01)));
  RepairReport report;
  expect_mended(damaged, report);
  EXPECT_EQ(report.components, 1);
  EXPECT_EQ(report.inner_shells, 1);
}

TEST(Repair, OverlappingPartsBecomeOne) {
  Surface both = test::box(Vec3(2, 1, 1), 2);
  append(both, moved(test::box(Vec3(2, 1, 1), 2), 1, Vec3(1.5, 0.25, 0.25)));
  RepairReport report;
  const Surface mended = repair_surface(both, "two.stl", report);
  EXPECT_EQ(report.joined, 1);
  EXPECT_TRUE(is_closed(mended));
  EXPECT_NEAR(signed_volume(mended), 4 - 0.5 * 0.75 * 0.75, 1e-9);
}

TEST(Repair, WhatCannotBeMendedIsRefusedWithItsPlace) {
  RepairReport report;
  Surface halves = good();
  append(halves, moved(good(), 1, Vec3(0.3, 0, 0)));
  // Both open.
  halves.faces.erase(halves.faces.begin() + static_cast<std::ptrdiff_t>(good().faces.size()) + 4);
  halves.faces.erase(halves.faces.begin() + 4);
  const auto [code, text] = test::error_of([&] { repair_surface(halves, "halves.stl", report); });
  EXPECT_EQ(code, 3);
  EXPECT_NE(text.find("halves.stl: the surface falls into open parts, one about ("),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("--method wrap"), std::string::npos);

  Surface broken = good();
  broken.vertices[3].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(test::error_of([&] { repair_surface(broken, "x", report); }).first, 3);
  EXPECT_EQ(test::error_of([&] { repair_surface({}, "x", report); }).first, 3);
  const Surface flat{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  EXPECT_EQ(test::error_of([&] { repair_surface(flat, "x", report); }).first, 3);
}

TEST(Repair, AWrapIsClosedAndNear) {
  Surface damaged = good();
  damaged.faces.erase(damaged.faces.begin() + 30);
  const Surface wrap = wrap_surface(damaged, 0.03, "x");
  EXPECT_TRUE(is_closed(wrap));
  EXPECT_NEAR(signed_volume(wrap) / signed_volume(good()), 1, 0.15);
}

}  // namespace
}  // namespace hapsim
