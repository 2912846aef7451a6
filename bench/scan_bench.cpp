// From scanned points to a surface: time, memory and error as the points grow.
//
//   bench_scan BIN SIZE... [--text] [--open3d PYTHON SCRIPT]
//
// SIZE: how many points, as 1e5. For each a smooth body seen all round and a block on its base seen
// from all sides but that, with noise of 0.2 mm and 0.2 % of outliers; BIN/hs-scan2ply and
// BIN/hs-reconstruct, each in a process of its own: processor seconds, peak memory, and how far
// points of the true surface lie from the one that was made (rms and largest). Then the exponent
// with which the time of both grows, between neighbouring sizes and over all. Points are given as
// binary PLY, with --text as CSV. With --open3d the same by Open3D: scan_open3d.py, run by PYTHON,
// which imports it (its import is not counted). Each is run three times, and the fastest counts.
// Recorded in bench/results/scan.txt (bench/record.sh).
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "base/random.h"
#include "formats/surface_io.h"
#include "io/stream.h"
#include "mesh/surface_tree.h"

namespace hapsim {
namespace {

constexpr double kNoise = 2e-4;  // [m]
constexpr double kOutliers = 0.002;
constexpr int kRuns = 3;

// A point of a body's surface, evenly by area.
using Body = std::function<Vec3(Random&)>;

Vec3 of_ellipsoid(Random& random) {
  const Vec3 radii(0.052, 0.032, 0.03);
  while (true) {
    const Vec3 u = Vec3(random.normal(), random.normal(), random.normal()).normalized();
    // The area that a part of the ball becomes, over the largest.
    if (random.uniform() < u.cwiseQuotient(radii).norm() * radii.minCoeff())
      return u.cwiseProduct(radii);
  }
}

Vec3 of_block(Random& random) {
  const Vec3 size(0.08, 0.12, 0.05);
  const double top = size.x() * size.y(), side = size.y() * size.z(), front = size.x() * size.z();
  const double face = random.uniform() * (top + 2 * side + 2 * front);
  Vec3 p = Vec3(random.uniform(), random.uniform(), random.uniform()).cwiseProduct(size);
  if (face < top)
    p.z() = size.z();
  else if (face < top + 2 * side)
    p.x() = face < top + side ? 0 : size.x();
  else
    p.y() = face < top + 2 * side + front ? 0 : size.y();
  return p - Vec3(size.x() / 2, size.y() / 2, 0);
}

struct Case {
  std::string name;
  Body body;
  std::vector<std::string> flags;  // of hs-reconstruct
};

std::vector<Vec3> truth_of(const Case& c) {
  Random random(11);
  std::vector<Vec3> points;
  for (int i = 0; i < 20000; ++i) points.push_back(c.body(random));
  return points;
}

void write_scan(const Case& c, std::size_t count, bool text, const std::string& path) {
  Random random(7);
  std::ofstream out(path, std::ios::binary);
  if (text)
    out << "x,y,z\n";
  else
    out << "ply\nformat binary_little_endian 1.0\nelement vertex " << count
        << "\nproperty double x\nproperty double y\nproperty double z\nend_header\n";
  for (std::size_t i = 0; i < count; ++i) {
    Vec3 p = c.body(random) + kNoise * Vec3(random.normal(), random.normal(), random.normal());
    if (random.uniform() < kOutliers)
      p += 0.05 * Vec3(random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5);
    if (text)
      out << fmt::format("{:.7g},{:.7g},{:.7g}\n", p.x(), p.y(), p.z());
    else
      out.write(reinterpret_cast<const char*>(p.data()), sizeof(double) * 3);
  }
}

struct Run {
  double seconds = 0, megabytes = 0;  // of the processor; at the peak
};

Run run(const std::vector<std::string>& command, const std::string& output = "/dev/null") {
  std::vector<char*> words;
  for (const std::string& word : command) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  const pid_t child = fork();
  if (child == 0) {
    dup2(open(output.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644), STDOUT_FILENO);
    execvp(words[0], words.data());
    _exit(127);
  }
  int status = 0;
  rusage used{};
  wait4(child, &status, 0, &used);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    fmt::print(stderr, "{} failed\n", command[0]);
    std::exit(1);
  }
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return {seconds(used.ru_utime) + seconds(used.ru_stime),
          static_cast<double>(used.ru_maxrss) / 1024};
}

Run fastest(const std::vector<std::string>& command) {
  Run best = run(command);
  for (int again = 1; again < kRuns; ++again) {
    const Run next = run(command);
    if (next.seconds < best.seconds) best = next;
  }
  return best;
}

// "rms largest" of the distances of the truth from the surface [mm].
std::string error_of(const std::string& path, const std::vector<Vec3>& truth) {
  Input input(path);
  const Surface surface = read_surface(input);
  const SurfaceTree tree(surface);
  double sum = 0, largest = 0;
  for (const Vec3& p : truth) {
    const double off = tree.nearest(p).distance;
    sum += off * off;
    largest = std::max(largest, off);
  }
  return fmt::format("{:>7.3f} {:>7.2f}", 1e3 * std::sqrt(sum / static_cast<double>(truth.size())),
                     1e3 * largest);
}

struct Grown {
  double points = 0, seconds = 0;
};

double exponent(const Grown& a, const Grown& b) {
  return std::log(b.seconds / a.seconds) / std::log(b.points / a.points);
}

void told_growth(const std::string& name, const std::vector<Grown>& sizes) {
  if (sizes.size() < 2) return;
  std::string steps;
  for (std::size_t i = 1; i < sizes.size(); ++i)
    steps += fmt::format(" {:.2f}", exponent(sizes[i - 1], sizes[i]));
  fmt::print("{}: time grows by the power {:.2f} (from size to size{})\n", name,
             exponent(sizes.front(), sizes.back()), steps);
}

struct Options {
  std::string bin, python, script;
  std::vector<double> sizes;
  bool text = false;
};

void measure(const Case& c, const Options& options, const std::string& folder) {
  const std::vector<Vec3> truth = truth_of(c);
  std::vector<Grown> ours, theirs;
  for (const double size : options.sizes) {
    const std::string scan = folder + (options.text ? "/scan.csv" : "/scan.ply");
    const std::string points = folder + "/points.ply", surface = folder + "/surface.ply";
    write_scan(c, static_cast<std::size_t>(size), options.text, scan);
    const Run first = fastest({options.bin + "/hs-scan2ply", "-q", scan, "-o", points});
    std::vector<std::string> command{options.bin + "/hs-reconstruct", "-q", points, "-o", surface};
    command.insert(command.end(), c.flags.begin(), c.flags.end());
    const Run second = fastest(command);
    Input input(points);
    ours.push_back({size, first.seconds + second.seconds});
    fmt::print("{:<10} {:>8} hapsim {:>8} {:>8.2f} {:>6.0f} {:>8.2f} {:>6.0f} {:>8.2f} {}\n",
               c.name, size, read_points(input).points.size(), first.seconds, first.megabytes,
               second.seconds, second.megabytes, ours.back().seconds, error_of(surface, truth));
    std::fflush(stdout);
    if (options.python.empty()) continue;
    const std::string told = folder + "/told.txt";
    Run run_theirs;
    std::size_t kept = 0;
    double seconds = 0;
    for (int i = 0; i < kRuns; ++i) {
      run_theirs = run({options.python, options.script, scan, surface}, told);
      std::ifstream in(told);
      double took = 0;
      in >> kept >> took;
      if (i == 0 || took < seconds) seconds = took;
    }
    theirs.push_back({size, seconds});
    fmt::print("{:<10} {:>8} Open3D {:>8} {:>8} {:>6} {:>8} {:>6.0f} {:>8.2f} {}\n", c.name, size,
               kept, "", "", "", run_theirs.megabytes, seconds, error_of(surface, truth));
    std::fflush(stdout);
  }
  told_growth(c.name, ours);
  if (!theirs.empty()) told_growth(c.name + ", Open3D", theirs);
}

}  // namespace
}  // namespace hapsim

int main(int argc, char** argv) {
  using namespace hapsim;
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--text") {
      options.text = true;
    } else if (word == "--open3d" && i + 2 < argc) {
      options.python = argv[++i];
      options.script = argv[++i];
    } else if (options.bin.empty()) {
      options.bin = word;
    } else {
      options.sizes.push_back(std::strtod(word.c_str(), nullptr));
    }
  }
  if (options.sizes.empty() || (options.text && !options.python.empty())) {
    fmt::print(stderr, "usage: bench_scan BIN SIZE... [--text | --open3d PYTHON SCRIPT]\n");
    return 2;
  }
  char folder[] = "/tmp/bench_scan.XXXXXX";
  if (mkdtemp(folder) == nullptr) return 5;
  fmt::print("{:<10} {:>8} {:<6} {:>8} {:>8} {:>6} {:>8} {:>6} {:>8} {:>7} {:>7}\n", "body",
             "points", "by", "kept", "points_s", "MB", "surf_s", "MB", "both_s", "rms_mm",
             "max_mm");
  measure({"ellipsoid", of_ellipsoid, {"--no-base"}}, options, folder);
  measure({"block", of_block, {"--base", "0"}}, options, folder);
  std::filesystem::remove_all(folder);
  return 0;
}
