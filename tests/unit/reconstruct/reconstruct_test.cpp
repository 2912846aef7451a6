#include "reconstruct/reconstruct.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/random.h"
#include "expect_error.h"
#include "formats/surface_io.h"
#include "mesh/surface_tree.h"
#include "reconstruct/clean_points.h"
#include "reconstruct/crease.h"
#include "reconstruct/reconstruct_parts.h"
#include "support/needs.h"
#include "support/shapes.h"

namespace hapsim {
namespace {

Vec3 noise(Random& random, double size) {
  return size * Vec3(random.normal(), random.normal(), random.normal());
}

// What every body must be; returns it with its report.
Surface sound(const PointCloud& cloud, const ReconstructOptions& options,
              ReconstructReport& report) {
  const Surface s = reconstruct(cloud, options, "scan", report);
  EXPECT_TRUE(is_closed(s));
  EXPECT_GT(signed_volume(s), 0);
  EXPECT_GT(s.faces.size(), 300u);
  EXPECT_LT(s.faces.size(), 9000u);
  if (report.has_base) {
    // Exactly planar: the bottom's faces add up to the whole plan view, seen from below.
    double bottom = 0, down = 0;
    for (std::size_t f = 0; f < s.faces.size(); ++f) {
      const Vec3 n = face_normal(s, static_cast<int>(f));
      bool flat = true;
      for (const int v : s.faces[f]) {
        flat = flat && std::abs(s.vertices[v].dot(report.up) - report.base) < 1e-12;
      }
      if (flat) bottom -= n.dot(report.up) / 2;
      down += std::max(0.0, n.dot(report.up)) / 2;
    }
    EXPECT_GT(bottom, 0.3 * down);
  }
  return s;
}

// Truth: a ball of radius r about (0, 0, c), cut flat at z = 0; sampled by area above z = low.
PointCloud cut_ball(double r, double c, double low, int n, double size, std::uint64_t seed) {
  Random random(seed);
  PointCloud cloud;
  while (static_cast<int>(cloud.points.size()) < n) {
    Vec3 v(random.normal(), random.normal(), random.normal());
    const Vec3 p = r * v.normalized() + Vec3(0, 0, c);
    if (p.z() > low) cloud.points.push_back(p + noise(random, size));
  }
  return cloud;
}

TEST(Reconstruct, Hemisphere) {
  ReconstructReport report;
  const Surface s = sound(cut_ball(0.04, 0, 0, 1500, 1e-4, 1), {}, report);
  EXPECT_EQ(method_name(report.method), "poisson");
  EXPECT_EQ(report.base, 0);
  EXPECT_NEAR(signed_volume(s) / (2 * M_PI / 3 * std::pow(0.04, 3)), 1, 0.02);
}

// Poisson's mesher would follow the surface all the way out to it, for hours.
TEST(Reconstruct, APointFarAstrayDoesNotKeepItForever) {
  PointCloud cloud = cut_ball(0.04, 0, -0.05, 600, 1e-4, 1);
  cloud.points.emplace_back(3, 1, 2);
  for (const Vec3& p : cloud.points) cloud.normals.push_back(p.normalized());
  ReconstructReport report;
  const Surface s = reconstruct(cloud, {}, "scan", report);
  EXPECT_TRUE(is_closed(s));
  Vec3 low = s.vertices[0], high = low;
  for (const Vec3& p : s.vertices) low = low.cwiseMin(p), high = high.cwiseMax(p);
  EXPECT_LT((high - low).maxCoeff(), 0.1);
}

// The nearest neighbour of a laser line's point lies on that line, far nearer than the next line.
TEST(Reconstruct, DenseLinesFarApartHaveTheAreaAroundThem) {
  constexpr double kRing = 0.04, kApart = 3e-3, kAlong = 1e-4;
  PointCloud cloud;
  for (double z = kApart / 2; z < kRing; z += kApart) {
    const double ring = std::sqrt(kRing * kRing - z * z);
    const int count = static_cast<int>(2 * M_PI * ring / kAlong);
    for (int i = 0; i < count; ++i) {
      const double turn = 2 * M_PI * i / count;
      cloud.points.emplace_back(ring * std::cos(turn), ring * std::sin(turn), z);
      cloud.normals.push_back(cloud.points.back() / kRing);
    }
  }
  const double half_ball = 2 * M_PI * kRing * kRing;
  EXPECT_GT(view_scan(cloud).area, 0.2 * half_ball);
  EXPECT_LT(view_scan(cloud).area, half_ball);
}

// Exact numbers end the process on what these became.
TEST(Reconstruct, BearsTinyCoordinatesAndNormalsOfAnyLength) {
  PointCloud cloud = cut_ball(0.04, 0, 0, 1500, 1e-4, 1);
  for (const Vec3& p : cloud.points) cloud.normals.push_back(p.normalized());
  for (std::size_t i = 0; i < cloud.normals.size(); i += 50)
    cloud.normals[i] *= i % 100 == 0 ? 1e230 : 1e-230;
  cloud.points[57].x() = 5e-317;
  cloud.points[265].y() = 8e-65;
  ReconstructReport report;
  const Surface s = sound(cloud, {}, report);
  EXPECT_NEAR(signed_volume(s) / (2 * M_PI / 3 * std::pow(0.04, 3)), 1, 0.05);
  cloud.points[100] = Vec3(0, 0, 1e200);
  EXPECT_NE(error_of([&] { sound(cloud, {}, report); }).find("point 100 lies 1e+200 m away"),
            std::string::npos);
}

TEST(Reconstruct, BallCutFlatWithOverhang) {
  const double r = 0.05, c = 0.035, h = c + r;
  ReconstructReport report;
  const Surface s = sound(cut_ball(r, c, 0.002, 2500, 2e-4, 2), {}, report);
  EXPECT_EQ(report.base, 0);
  EXPECT_NEAR(signed_volume(s) / (M_PI * h * h * (r - h / 3)), 1, 0.015);
  double widest = 0;
  for (const Vec3& p : s.vertices) widest = std::max(widest, std::hypot(p.x(), p.y()));
  EXPECT_NEAR(widest, r, 1e-3);  // the largest of a thousand
  for (const Vec3& p : s.vertices) {
    if (p.z() > 0.005) {
      EXPECT_NEAR((p - Vec3(0, 0, c)).norm(), r, 1.5e-3);
    }
  }
}

TEST(Reconstruct, CuboidKeepsItsEdges) {
  Random random(3);
  const Vec3 size(0.08, 0.12, 0.05);
  PointCloud cloud;
  const double top = size.x() * size.y(), side_x = size.y() * size.z();
  const double side_y = size.x() * size.z(), all = top + 2 * side_x + 2 * side_y;
  for (int i = 0; i < 4000; ++i) {
    Vec3 p(random.uniform() * size.x(), random.uniform() * size.y(), random.uniform() * size.z());
    double pick = random.uniform() * all;
    if (pick < top) {
      p.z() = size.z();
    } else if ((pick -= top) < 2 * side_x) {
      p.x() = pick < side_x ? 0 : size.x();
    } else {
      p.y() = pick - 2 * side_x < side_y ? 0 : size.y();
    }
    cloud.points.push_back(p + noise(random, 1e-4));
  }
  ReconstructReport report;
  const Surface s = sound(cloud, {}, report);
  EXPECT_NEAR(signed_volume(s) / size.prod(), 1, 0.01);
  EXPECT_LT(report.rms, 4e-4);
  // Flat top, away from its edges.
  for (const Vec3& p : s.vertices) {
    if (p.x() > 0.015 && p.x() < 0.065 && p.y() > 0.015 && p.y() < 0.105 && p.z() > 0.03) {
      EXPECT_NEAR(p.z(), size.z(), 4e-4);
    }
  }
}

TEST(Crease, FacesFarFromEveryPatchStayAsTheyAre) {
  const Surface dome = test::dome(0.05, 8);
  // Two patches that look the other way: none is the surface's.
  Random random(4);
  Segmentation none;
  for (const double side : {-1.0, 1.0}) {
    PointCloud cloud;
    for (int i = 0; i < 40; ++i) {
      cloud.points.emplace_back(side * 0.03 + 0.02 * random.uniform(), 0.02 * random.uniform(),
                                -0.1);
      cloud.normals.push_back(-Vec3::UnitZ());
    }
    none.patches.emplace_back(std::move(cloud));
  }
  CreaseOptions options;
  options.edge = options.spacing = 0.005;
  options.base = 0;
  LabelledSurface cut = cut_along_patches(dome, none, options);
  ASSERT_NE(std::count(cut.label.begin(), cut.label.end(), LabelledSurface::kFree), 0);
  const Surface before = cut.surface;
  project_to_patches(cut, none, options);
  for (std::size_t f = 0; f < cut.label.size(); ++f) {
    if (cut.label[f] != LabelledSurface::kFree) continue;
    for (const int v : cut.surface.faces[f]) {
      EXPECT_LT((cut.surface.vertices[v] - before.vertices[v]).norm(), 2 * options.edge);
      EXPECT_TRUE(cut.surface.vertices[v].allFinite());
    }
  }
}

// Every method on points of an upper and side surface, without a bottom.
class EveryMethod : public testing::TestWithParam<ReconstructMethod> {};

TEST_P(EveryMethod, GivesABodyOfTheRightVolume) {
  const double r = 0.05, c = 0.02, h = c + r;
  ReconstructOptions options;
  options.method = GetParam();
  ReconstructReport report;
  const Surface s = sound(cut_ball(r, c, 0, 2000, 1e-4, 11), options, report);
  EXPECT_EQ(report.method, GetParam());
  EXPECT_EQ(report.why, "asked for");
  EXPECT_NEAR(signed_volume(s) / (M_PI * h * h * (r - h / 3)), 1, 0.03);
}

INSTANTIATE_TEST_SUITE_P(All, EveryMethod,
                         testing::Values(ReconstructMethod::kDelaunay,
                                         ReconstructMethod::kPowerCrust,
                                         ReconstructMethod::kPoisson,
                                         ReconstructMethod::kAdvancingFront,
                                         ReconstructMethod::kWrap),
                         [](const auto& one) {
                           std::string name = method_name(one.param);
                           std::erase(name, '-');
                           return name;
                         });

// Points without a volume are refused in one line, by every method.
TEST(Reconstruct, PointsWithoutVolumeAreRefused) {
  std::vector<Vec3> none, one{{0, 0, 0}}, three{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, line, same, four;
  for (int i = 0; i < 50; ++i) {
    line.emplace_back(0.001 * i, 0.002 * i, 0);
    same.emplace_back(0.1, 0.1, 0.1);
    four.emplace_back(i % 4 == 1, i % 4 == 2, i % 4 == 3);
  }
  for (const std::string& name : reconstruct_methods()) {
    ReconstructOptions options;
    options.method = method_named(name);
    for (const auto& points : {none, one, three, line, same, four}) {
      PointCloud cloud;
      cloud.points = points;
      ReconstructReport report;
      try {
        reconstruct(cloud, options, "scan.csv", report);
        ADD_FAILURE() << name << " took " << points.size() << " points";
      } catch (const Error& error) {
        EXPECT_EQ(error.code(), ExitCode::kBadInput) << name << ": " << error.what();
      }
    }
  }
}

// When none of the methods can use them, the points are at fault, not the method.
TEST(Reconstruct, PointsThatLieOnNoSurfaceAreRefused) {
  Random random(3);
  PointCloud cloud;
  for (int i = 0; i < 400; ++i) {
    cloud.points.emplace_back(0.1 * random.uniform(), 0.1 * random.uniform(),
                              0.1 * random.uniform());
    cloud.normals.push_back(Vec3(random.normal(), random.normal(), random.normal()).normalized());
  }
  ReconstructReport report;
  try {
    reconstruct(cloud, {}, "scan.csv", report);
    ADD_FAILURE() << method_name(report.method) << " made a body";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kBadInput);
    EXPECT_EQ(std::string(error.what()).rfind("scan.csv: no method makes", 0), 0) << error.what();
  }
}

TEST(Reconstruct, PointsInAPlaneMakeAPatchOnly) {
  Random random(3);
  PointCloud cloud;
  for (int i = 0; i < 300; ++i)
    cloud.points.emplace_back(0.1 * random.uniform(), 0.1 * random.uniform(), 0);
  for (const std::string& name : reconstruct_methods()) {
    ReconstructOptions options;
    options.base_depth = 0.02;
    options.method = method_named(name);
    ReconstructReport report;
    const bool patch = name == "auto" || name == "height";
    try {
      const Surface s = reconstruct(cloud, options, "scan.csv", report);
      EXPECT_TRUE(patch) << name;
      EXPECT_TRUE(is_closed(s));
    } catch (const Error& error) {
      EXPECT_FALSE(patch) << error.what();
      EXPECT_EQ(error.code(), ExitCode::kBadInput) << name;
    }
  }
}

// Touched points of an organ's top: irregular, uneven, with a hole and doubled passes.
double organ(double x, double y) {
  return 0.03 - 6 * x * x - 9 * y * y + 0.002 * std::sin(60 * x);
}

PointCloud touched_patch(int n, double size, std::uint64_t seed) {
  Random random(seed);
  PointCloud cloud;
  while (static_cast<int>(cloud.points.size()) < n) {
    const double x = 0.08 * random.uniform() - 0.04, y = 0.056 * random.uniform() - 0.028;
    if (std::pow(x / 0.04, 2) + std::pow(y / 0.028, 2) > 1) continue;
    if (std::hypot(x - 0.01, y - 0.005) < 0.006) continue;
    if (x > 0 && random.uniform() < 0.5) continue;
    for (int pass = 0; pass < (y > 0 ? 2 : 1); ++pass) {
      cloud.points.push_back(Vec3(x, y, organ(x, y)) + noise(random, size));
    }
  }
  return cloud;
}

TEST(Reconstruct, TouchedPatchBecomesABlockWithASmoothTop) {
  ReconstructOptions options;
  options.base_depth = 0.02;
  ReconstructReport report;
  const Surface s = sound(touched_patch(219, 4e-4, 4), options, report);
  EXPECT_EQ(method_name(report.method), "height");
  double sum = 0;
  int count = 0;
  for (const Vec3& p : s.vertices) {
    const bool inside = std::pow(p.x() / 0.04, 2) + std::pow(p.y() / 0.028, 2) < 0.5;
    if (!inside || p.z() < report.base + 0.015) continue;
    sum += std::pow(p.z() - organ(p.x(), p.y()), 2);
    ++count;
  }
  ASSERT_GT(count, 100);
  // Smoother than the points are noisy.
  EXPECT_LT(std::sqrt(sum / count), 3.5e-4);
  const double low = std::min_element(s.vertices.begin(), s.vertices.end(), [](auto& a, auto& b) {
                       return a.z() < b.z();
                     })->z();
  EXPECT_EQ(low, report.base);
}

// The upper part of a ball over a bottom far below: slopes all round, yet a height field.
TEST(Reconstruct, UpperSideOverADeepBottomIsAHeightField) {
  const PointCloud cloud = cut_ball(0.04, 0, 0.015, 2000, 1e-4, 2);
  ReconstructOptions options;
  options.base_depth = 0.015;
  ReconstructReport report;
  const Surface s = sound(cloud, options, report);
  EXPECT_EQ(method_name(report.method), "height");
  double sum = 0;
  int count = 0;
  for (const Vec3& p : s.vertices) {
    if (p.z() < 0.02) continue;
    sum += std::pow(p.norm() - 0.04, 2);
    ++count;
  }
  ASSERT_GT(count, 100);
  EXPECT_LT(std::sqrt(sum / count), 1.5e-4);
  // Without that bottom the slopes are walls that reach down to it.
  sound(cloud, {}, report);
  EXPECT_EQ(method_name(report.method), "poisson");
}

TEST(Reconstruct, APatchSeenSidewaysStandsOnItsOwnBack) {
  PointCloud cloud = touched_patch(600, 2e-4, 5);
  for (Vec3& p : cloud.points) p = Vec3(p.z(), p.y(), -p.x());  // up becomes x
  ReconstructOptions options;
  options.up.reset();
  options.base_depth = 0.01;
  ReconstructReport report;
  sound(cloud, options, report);
  EXPECT_TRUE(report.tilted);
  EXPECT_GT(std::abs(report.up.x()), 0.95);
}

// A touched kidney: a bent ellipsoid, four zones each off by its own shift, noise, doubled passes.
PointCloud kidney(double low) {
  Random random(6);
  PointCloud cloud;
  std::vector<Vec3> shift;
  for (int z = 0; z < 4; ++z) shift.push_back(noise(random, 4e-4));
  while (cloud.points.size() < 15000) {
    Vec3 v(random.normal(), random.normal(), random.normal());
    v.normalize();
    Vec3 p(0.052 * v.x(), 0.027 * v.y(), 0.022 * v.z());
    if (p.z() < low || (p.x() > 0.02 && random.uniform() < 0.6)) continue;
    p.y() += 6 * p.x() * p.x();
    const int zone = (v.x() > 0 ? 1 : 0) + (v.y() > 0 ? 2 : 0);
    cloud.points.push_back(p + shift[zone] + noise(random, 4e-4) + Vec3(0.1, 0.2, 0.3));
    if (random.uniform() < 0.3) {
      cloud.points.push_back(p + shift[(zone + 1) % 4] + noise(random, 4e-4) + Vec3(0.1, 0.2, 0.3));
    }
  }
  return cloud;
}

TEST(Reconstruct, TouchedKidneyAllRound) {
  ReconstructOptions options;
  options.no_base = true;
  ReconstructReport report;
  const Surface s = sound(kidney(-1), options, report);
  EXPECT_EQ(method_name(report.method), "poisson");
  EXPECT_FALSE(report.has_base);
  EXPECT_NEAR(signed_volume(s) / (4 * M_PI / 3 * 0.052 * 0.027 * 0.022), 1, 0.04);
}

TEST(Reconstruct, TouchedKidneyAllRoundGetsASupport) {
  ReconstructReport report;
  const Surface s = reconstruct(kidney(-1), {}, "scan", report);
  EXPECT_TRUE(report.has_base);
  EXPECT_TRUE(is_closed(s));
  const auto on_base = std::count_if(s.vertices.begin(), s.vertices.end(),
                                     [&](const Vec3& p) { return p.z() == report.base; });
  EXPECT_GT(on_base, 8);
  EXPECT_NEAR(signed_volume(s) / (4 * M_PI / 3 * 0.052 * 0.027 * 0.022), 0.99, 0.04);
}

TEST(Reconstruct, TouchedKidneyFromAbove) {
  const double a = -0.010, c = 0.022;
  ReconstructReport report;
  const Surface s = sound(kidney(a), {}, report);
  EXPECT_TRUE(report.has_base);
  // The ellipsoid above a: pi A B (c - a - (c^3 - a^3) / (3 c^2)).
  const double truth =
      M_PI * 0.052 * 0.027 * (c - a - (std::pow(c, 3) - std::pow(a, 3)) / (3 * c * c));
  EXPECT_NEAR(signed_volume(s) / truth, 1, 0.05);
}

TEST(Reconstruct, TheSameSeedGivesTheSameSurface) {
  const PointCloud cloud = cut_ball(0.04, 0.01, 0, 800, 1e-4, 9);
  ReconstructReport report;
  const Surface one = reconstruct(cloud, {}, "scan", report);
  const Surface two = reconstruct(cloud, {}, "scan", report);
  EXPECT_EQ(one.faces, two.faces);
  EXPECT_EQ(one.vertices, two.vertices);
}

// The points of a body on its base are mirrored, which makes pairs of equal tetrahedra; CGAL took
// that one first which lies first in memory.
TEST(Reconstruct, TheSurfaceDoesNotDependOnWhereMemoryLies) {
  PointCloud cloud;
  Random place(3);
  for (int i = 0; i < 6000; ++i) {
    const double face = 13.6 * place.uniform();
    const double u = place.uniform(), v = place.uniform();
    Vec3 p = face < 4.8    ? Vec3(u, v, 1)
             : face < 10.8 ? Vec3(face < 7.2, u, v)
                           : Vec3(u, face < 12.2, v);
    cloud.points.push_back(p.cwiseProduct(Vec3(0.08, 0.12, 0.05)) + noise(place, 2e-4));
  }
  ReconstructReport report;
  const Surface one = reconstruct(cloud, {}, "scan", report);
  for (int trial = 0; trial < 5; ++trial) {
    Random random(trial);
    std::vector<std::vector<char>> held;
    for (int i = 0; i < 100000 * trial; ++i) held.emplace_back(1 + random.integer(3000));
    for (std::size_t i = 0; i < held.size(); i += 2) std::vector<char>().swap(held[i]);
    const Surface two = reconstruct(cloud, {}, "scan", report);
    EXPECT_EQ(one.vertices, two.vertices);
    EXPECT_EQ(one.faces, two.faces);
  }
}

TEST(Reconstruct, GivenBaseIsKept) {
  ReconstructOptions options;
  options.base = -0.003;
  ReconstructReport report;
  sound(cut_ball(0.04, 0, 0, 1500, 1e-4, 1), options, report);
  EXPECT_EQ(report.base, -0.003);
  options.base = 0.03;
  EXPECT_THROW(reconstruct(cut_ball(0.04, 0, 0, 500, 0, 1), options, "scan", report), Error);
}

struct Truth {
  const char* object;
  double rms;     // of the truth above 3 mm to the surface [m]
  double volume;  // relative error
};

class IndependentScan : public testing::TestWithParam<Truth> {};

TEST_P(IndependentScan, ComesNearTheTruth) {
  const std::string object = test::shared_path("independent/") + GetParam().object;
  HAPSIM_NEEDS_SHARED(object + "_scan.csv");
  Input points(object + "_scan.csv");
  Input stl(object + ".stl");
  const Surface truth = read_surface(stl);
  CleanReport cleaned;
  ReconstructReport report;
  const Surface s = sound(clean_points(read_points(points), {}, "scan", cleaned), {}, report);
  EXPECT_NEAR(signed_volume(s) / signed_volume(truth), 1, GetParam().volume);
  EXPECT_EQ(report.base, 0);
  const SurfaceTree tree(s);
  double sum = 0, area = 0;
  for (std::size_t f = 0; f < truth.faces.size(); ++f) {
    const Triangle& t = truth.faces[f];
    const Vec3 p = (truth.vertices[t[0]] + truth.vertices[t[1]] + truth.vertices[t[2]]) / 3;
    if (p.z() < 3e-3) continue;
    const double a = face_normal(truth, static_cast<int>(f)).norm();
    sum += a * std::pow(tree.nearest(p).distance, 2);
    area += a;
  }
  EXPECT_LT(std::sqrt(sum / area), GetParam().rms);
}

INSTANTIATE_TEST_SUITE_P(All, IndependentScan,
                         testing::Values(Truth{"ball", 3e-4, 0.01}, Truth{"blob", 3e-4, 0.01},
                                         Truth{"cuboid", 1e-4, 0.003}),
                         [](const auto& one) { return std::string(one.param.object); });

}  // namespace
}  // namespace hapsim
