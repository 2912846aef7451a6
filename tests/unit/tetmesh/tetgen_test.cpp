// TetGen: right on what is good, and alive after what is not.
#include "tetmesh/tetgen.h"

#include <gtest/gtest.h>
#include <pthread.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <thread>

#include "repair/self_intersection.h"
#include "support/shapes.h"

namespace hapsim {
namespace {

using test::error_of;

TetgenInput input_of(Surface surface) {
  TetgenInput input;
  input.surface = std::move(surface);
  return input;
}

void refuse(const Surface& surface, const std::string& part) {
  const auto [code, what] = error_of([&] { run_tetgen(input_of(surface), {}, "x.ply"); });
  EXPECT_EQ(code, 3) << part;
  EXPECT_EQ(what.rfind("x.ply: ", 0), 0u) << what;
  EXPECT_NE(what.find(part), std::string::npos) << what;
}

TEST(Tetgen, FillsABox) {
  const TetgenResult result = run_tetgen(input_of(test::box({1, 2, 3}, 4)), {});
  EXPECT_NEAR(volume(result.mesh), 6, 1e-9);
  for (std::size_t t = 0; t < result.mesh.tets.size(); ++t)
    EXPECT_GT(tet_volume(result.mesh, t), 0);
}

TEST(Tetgen, KeepsSurfaceAndMarkers) {
  TetgenInput input = input_of(test::box({1, 2, 3}, 4));
  double top_area = 0;
  for (std::size_t f = 0; f < input.surface.faces.size(); ++f) {
    double low = 3;
    for (const int v : input.surface.faces[f]) low = std::min(low, input.surface.vertices[v].z());
    input.face_marker.push_back(low > 2.99 ? 7 : 1);
  }
  for (const bool preserve : {true, false}) {
    TetgenOptions options;
    options.preserve_surface = preserve;
    options.max_volume = 0.02;
    const TetgenResult result = run_tetgen(input, options);
    if (preserve) {
      EXPECT_EQ(result.mesh.faces.size(), input.surface.faces.size());
    } else {
      EXPECT_GT(result.mesh.faces.size(), input.surface.faces.size());
    }
    top_area = 0;
    const Surface boundary{result.mesh.nodes, result.mesh.faces};
    for (std::size_t f = 0; f < result.mesh.faces.size(); ++f)
      if (result.face_marker[f] == 7)
        top_area += 0.5 * face_normal(boundary, static_cast<int>(f)).norm();
    EXPECT_NEAR(top_area, 2, 1e-9);
    for (std::size_t v = 0; v < input.surface.vertices.size(); ++v)
      EXPECT_EQ(result.mesh.nodes[v], input.surface.vertices[v]);
  }
}

TEST(Tetgen, BoundsVolumeAndUsesSizesAndSeeds) {
  TetgenInput input = input_of(test::box({1, 1, 1}, 2));
  TetgenOptions options;
  options.preserve_surface = false;
  options.max_volume = 0.002;
  TetgenResult result = run_tetgen(input, options);
  for (std::size_t t = 0; t < result.mesh.tets.size(); ++t)
    EXPECT_LE(tet_volume(result.mesh, t), 0.002 * (1 + 1e-9));

  options.max_volume = 0;
  const std::size_t coarse = run_tetgen(input, options).mesh.tets.size();
  input.node_size.assign(input.surface.vertices.size(), 0.1);
  EXPECT_GT(run_tetgen(input, options).mesh.tets.size(), 5 * coarse);

  input.node_size.clear();
  input.seeds = {{0.31, 0.42, 0.53}};
  result = run_tetgen(input, options);
  double nearest = 1;
  for (const Vec3& p : result.mesh.nodes) nearest = std::min(nearest, (p - input.seeds[0]).norm());
  EXPECT_LT(nearest, 1e-12);
}

TEST(Tetgen, SameInputSameMeshFromManyThreads) {
  const TetgenInput input = input_of(test::dome(0.05, 10));
  const TetgenResult once = run_tetgen(input, {});
  std::vector<TetgenResult> results(6);
  std::vector<std::thread> threads;
  for (TetgenResult& result : results)
    threads.emplace_back([&result, &input] { result = run_tetgen(input, {}); });
  for (std::thread& thread : threads) thread.join();
  for (const TetgenResult& result : results) {
    EXPECT_EQ(result.mesh.tets, once.mesh.tets);
    EXPECT_TRUE(std::equal(result.mesh.nodes.begin(), result.mesh.nodes.end(),
                           once.mesh.nodes.begin(), once.mesh.nodes.end()));
  }
}

TEST(Tetgen, RefusesWhatIsNoBody) {
  const Surface good = test::box({1, 2, 3}, 3);
  Surface s = good;
  s.faces.pop_back();
  refuse(s, "open: 3 edges");
  s = good;
  s.vertices[4].y() = std::numeric_limits<double>::quiet_NaN();
  refuse(s, "vertex 4 is not finite");
  s.vertices[4].y() = std::numeric_limits<double>::infinity();
  refuse(s, "vertex 4 is not finite");
  s = good;
  for (Triangle& f : s.faces) std::swap(f[0], f[1]);
  refuse(s, "inside out");
  s = good;
  std::swap(s.faces[0][0], s.faces[0][1]);
  refuse(s, "more than two triangles");
  s = good;
  s.vertices.push_back(s.vertices[3]);
  refuse(s, "are both at");
  s = good;
  s.faces[5][1] = 1000;
  refuse(s, "out of range");
  refuse({}, "no triangle");
  s = good;
  for (Vec3& p : s.vertices) p.z() = 0;
  EXPECT_EQ(error_of([&] { run_tetgen(input_of(s), {}); }).first, 3);
  s = good;
  for (Vec3& p : s.vertices) p = Vec3(1, 1, 1);
  EXPECT_EQ(error_of([&] { run_tetgen(input_of(s), {}); }).first, 3);
  s = good;
  for (const Vec3& p : good.vertices) s.vertices.emplace_back(p + Vec3(5, 0, 0));
  for (const Triangle& f : good.faces) {
    const int n = static_cast<int>(good.vertices.size());
    s.faces.push_back({f[0] + n, f[1] + n, f[2] + n});
  }
  refuse(s, "several parts");
}

TEST(Tetgen, NamesTheSelfIntersection) {
  Surface s = test::box({1, 1, 1}, 4);
  // A node of the top face pulled out through the bottom.
  for (Vec3& p : s.vertices)
    if ((p - Vec3(0.5, 0.5, 1)).norm() < 1e-9) p.z() = -0.7;
  const auto [code, what] = error_of([&] { check_self_intersection(s, "x.ply"); });
  EXPECT_EQ(code, 3);
  EXPECT_NE(what.find("cuts itself"), std::string::npos) << what;
  EXPECT_NE(what.find("hs-reconstruct"), std::string::npos) << what;
  refuse(s, "cuts itself");  // and TetGen's crash does not take us along
  EXPECT_EQ(error_of([] { check_self_intersection(test::dome(1, 5), ""); }).first, 0);
}

TEST(Tetgen, SurvivesHostileSurfaces) {
  // Noise as large as the triangles: every kind of crossing and near-coincidence.
  unsigned state = 1;
  const auto random = [&] {
    state = state * 1664525u + 1013904223u;
    return state / 4294967296.0 - 0.5;
  };
  TetgenOptions options;
  options.time_limit = 1;  // it hangs on some of these
  int refused = 0;
  for (int i = 0; i < 12; ++i) {
    Surface s = test::dome(1, 6);
    for (Vec3& p : s.vertices) p += (0.1 + 0.1 * i) * Vec3(random(), random(), random());
    const auto [code, what] = error_of([&] { run_tetgen(input_of(s), options); });
    EXPECT_TRUE(code == 0 || code == 3) << what;
    refused += code == 3;
  }
  EXPECT_GT(refused, 6);
}

TEST(Tetgen, EndsInTime) {
  TetgenInput input = input_of(test::box({1, 1, 1}, 10));
  TetgenOptions options;
  options.max_volume = 1e-9;  // a thousand million tetrahedra
  options.time_limit = 0.3;
  const auto start = std::chrono::steady_clock::now();
  const auto [code, what] = error_of([&] { run_tetgen(input, options); });
  EXPECT_EQ(code, 3);
  EXPECT_NE(what.find("did not finish in 0.3 s"), std::string::npos) << what;
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10));
}

// The process that forks TetGen's, if there is one: the next run has to fork another.
void kill_children() {
  for (const auto& thread : std::filesystem::directory_iterator("/proc/self/task")) {
    std::ifstream children(thread.path() / "children");
    for (pid_t child; children >> child;) kill(child, SIGKILL);
  }
}

// A child can wait for ever on a lock that another thread held at the fork.
int children_hang = 0;
TEST(Tetgen, AChildThatHangsIsReplaced) {
  kill_children();
  ASSERT_EQ(pthread_atfork(
                nullptr, [] { --children_hang; },
                [] {
                  while (children_hang > 0) pause();
                }),
            0);
  TetgenOptions options;
  options.stall = 0.5;
  children_hang = 2;
  EXPECT_FALSE(run_tetgen(input_of(test::box({1, 1, 1}, 4)), options).mesh.tets.empty());
  EXPECT_EQ(children_hang, -1);
  children_hang = 0;
}

bool child_sleeps = false;

// A child that is kept from working is waited for; one that works on is ended.
TEST(Tetgen, EndsAfterSoMuchWork) {
  TetgenOptions options;
  options.time_limit = 1;
  options.processor_time = true;
  ASSERT_EQ(pthread_atfork(nullptr, nullptr,
                           [] {
                             if (child_sleeps) sleep(2);
                           }),
            0);
  kill_children();
  child_sleeps = true;
  EXPECT_FALSE(run_tetgen(input_of(test::box({1, 1, 1}, 4)), options).mesh.tets.empty());
  child_sleeps = false;
  options.max_volume = 1e-9;
  const auto [code, what] = error_of([&] {
    run_tetgen(input_of(test::box({1, 1, 1}, 10)), options);
  });
  EXPECT_EQ(code, 3);
  EXPECT_NE(what.find("did not finish in 1 s"), std::string::npos) << what;
  kill_children();  // the one that sleeps
}

}  // namespace
}  // namespace hapsim
