// Meshing beside the bare tetgen program on the same input, and contact detection at loop rates.
//
//   bench_tetmesh BIN [triangles [tetrahedra]]
//
// BIN is the folder of hs-tetmesh. Prints seconds and peak memory (of all processes of a run
// together) of both programs and their ratio; then, a query of a moving tool: time, and the error
// of its distance against the half-ball's closed form, for triangles and for the three nearest
// nodes.
// Recorded in bench/results/tetmesh.txt (bench/record.sh).
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "base/random.h"
#include "formats/surface_io.h"
#include "mesh/signed_distance.h"
#include "mesh/three_nodes.h"
#include "mesh/tool_contact.h"
#include "support/shapes.h"

namespace hapsim {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// Proportional set size of a process and those it started [MB]: shared pages count once.
double memory_of(pid_t root) {
  double sum = 0;
  std::ifstream rollup(fmt::format("/proc/{}/smaps_rollup", root));
  for (std::string word; rollup >> word;)
    if (word == "Pss:") {
      double kilobytes = 0;
      rollup >> kilobytes;
      sum = kilobytes / 1024;
      break;
    }
  std::ifstream children(fmt::format("/proc/{}/task/{}/children", root, root));
  for (pid_t child; children >> child;) sum += memory_of(child);
  return sum;
}

struct Run {
  double seconds = 0, processor = 0, megabytes = 0;
  int status = 0;
};

Run run(const std::vector<std::string>& command) {
  std::vector<char*> words;
  for (const std::string& word : command) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  Run result;
  const auto start = Clock::now();
  const pid_t child = fork();
  if (child == 0) {
    const int nowhere = open("/dev/null", O_WRONLY);
    dup2(nowhere, STDOUT_FILENO);
    execvp(words[0], words.data());
    _exit(127);
  }
  rusage usage{};
  while (wait4(child, &result.status, WNOHANG, &usage) == 0) {
    result.megabytes = std::max(result.megabytes, memory_of(child));
    usleep(10000);
  }
  result.seconds = seconds_since(start);
  for (const timeval& t : {usage.ru_utime, usage.ru_stime})
    result.processor += static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  return result;
}

void write_smesh(const std::string& path, const Surface& s) {
  std::ofstream out(path);
  out << fmt::format("{} 3 0 0\n", s.vertices.size());
  for (std::size_t i = 0; i < s.vertices.size(); ++i)
    out << fmt::format("{} {} {} {}\n", i, s.vertices[i].x(), s.vertices[i].y(), s.vertices[i].z());
  out << fmt::format("{} 0\n", s.faces.size());
  for (const Triangle& f : s.faces) out << fmt::format("3 {} {} {}\n", f[0], f[1], f[2]);
  out << "0\n0\n";
}

long tetgen_count(const std::string& path) {
  std::ifstream in(path);
  long count = 0;
  in >> count;
  return count;
}

void meshing(const std::string& bin, int triangles, double tetrahedra) {
  const auto folder = std::filesystem::temp_directory_path() / fmt::format("hs-bench-{}", getpid());
  std::filesystem::create_directory(folder);
  const Surface surface =
      test::dome(0.05, static_cast<int>(std::lround(std::sqrt(triangles / 12.0))));
  {
    std::ofstream out(folder / "s.ply");
    write_surface_ply(out, surface);
  }
  write_smesh(folder / "s.smesh", surface);
  // TetGen's tetrahedra have about 0.55 of the bound's volume, those at the surface less.
  const double bound = signed_volume(surface) / (0.5 * tetrahedra);
  const Run bare = run({"tetgen", fmt::format("-pYzQq1.4/10a{:.18f}", bound), folder / "s.smesh"});
  if (WEXITSTATUS(bare.status) == 127) {
    fmt::print("SKIPPED: no tetgen program here (Debian package tetgen)\n");
  } else {
    const auto tell = [](const char* what, const Run& r) {
      fmt::print("{}: status {}, {:.1f} s, {:.1f} s of processors, {:.0f} MB\n", what,
                 WEXITSTATUS(r.status), r.seconds, r.processor, r.megabytes);
    };
    fmt::print("{} triangles, {} tetrahedra\n", surface.faces.size(),
               tetgen_count(folder / "s.1.ele"));
    tell("tetgen    ", bare);
    const Run own = run({bin + "/hs-tetmesh", folder / "s.ply", "--preserve-surface",
                         "--max-volume", fmt::format("{:.18f}", bound), "-o", folder / "b.ply"});
    tell("hs-tetmesh", own);
    fmt::print("ratio {:.2f} in time, {:.2f} in processor time, {:.2f} in memory\n",
               own.seconds / bare.seconds, own.processor / bare.processor,
               own.megabytes / bare.megabytes);
  }
  std::filesystem::remove_all(folder);
}

void detection(int triangles) {
  const double radius = 0.05;
  const Surface surface =
      test::dome(radius, static_cast<int>(std::lround(std::sqrt(triangles / 12.0))));
  const SignedDistance body(surface);
  const ThreeNodes nodes(surface);
  // A tool that wanders about the surface at 0.1 m/s, 1000 positions a second.
  Random random(1);
  std::vector<Vec3> path;
  std::vector<double> exact;
  Vec3 d(0.3, 0.2, 0.9);
  for (int i = 0; i < 200000; ++i) {
    d += 0.002 * Vec3(random.normal(), random.normal(), random.normal());
    d.z() = std::max(std::abs(d.z()), 0.3);
    d.normalize();
    exact.push_back(0.004 * std::sin(0.01 * i));
    path.push_back((radius + exact.back()) * d);
  }
  // Processor time, the best of blocks: what other programs take from the machine does not count.
  const auto measure = [&](const char* what, auto query) {
    constexpr std::size_t kBlock = 10000;
    double error = 0, best = 1e300, worst = 0;
    for (std::size_t i = 0; i < path.size();) {
      const double start = processor_seconds();
      for (const std::size_t end = std::min(i + kBlock, path.size()); i < end; ++i)
        error += std::pow(query(path[i]) - exact[i], 2);
      const double block = processor_seconds() - start;
      best = std::min(best, block);
      worst = std::max(worst, block);
    }
    fmt::print("{:>7} triangles, {:<22} {:5.0f} to {:5.0f} ns a query, rms error {:.2g} m\n",
               surface.faces.size(), what, 1e9 * best / kBlock, 1e9 * worst / kBlock,
               std::sqrt(error / static_cast<double>(path.size())));
  };
  int face = -1;
  measure("signed distance", [&](const Vec3& p) { return body.at(p).distance; });
  measure("... with hint", [&](const Vec3& p) {
    const SurfaceSide side = body.at(p, face);
    face = side.face;
    return side.distance;
  });
  ToolContactOptions options;
  options.slides = true;
  ToolContact tool(body, options);
  measure("moving tool, sliding", [&](const Vec3& p) { return tool.update(p).surface.distance; });
  measure("three nearest nodes", [&](const Vec3& p) { return nodes.at(p).distance; });
}

}  // namespace
}  // namespace hapsim

int main(int argc, char** argv) {
  const std::string bin = argc > 1 ? argv[1] : "bin";
  hapsim::detection(5000);
  hapsim::detection(100000);
  hapsim::meshing(bin, argc > 2 ? std::atoi(argv[2]) : 100000, argc > 3 ? std::atof(argv[3]) : 1e6);
  return 0;
}
