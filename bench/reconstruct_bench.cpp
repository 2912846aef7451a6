// Every method of reconstruction on every object: closed, how near the truth, how long, how much
// memory. Each runs in a process of its own, for 120 s at most.
//   bench_reconstruct [OBJECT...]
// A row per object and method; "auto" says which it took. Truth: points of the object without
// noise, where there is one, else the scan's own points.
// Recorded in bench/results/reconstruct.txt (bench/record.sh).
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/random.h"
#include "formats/surface_io.h"
#include "mesh/surface_tree.h"
#include "reconstruct/clean_points.h"
#include "reconstruct/reconstruct.h"

namespace hapsim {
namespace {

using Implicit = std::function<double(const Vec3&)>;  // below 0 inside [m]

struct Object {
  std::string name;
  std::vector<Vec3> scan;
  std::vector<Vec3> truth;
};

double box(const Vec3& p, const Vec3& low, const Vec3& high) {
  const Vec3 d = (low - p).cwiseMax(p - high);
  return d.cwiseMax(0).norm() + std::min(0.0, d.maxCoeff());
}

double ellipsoid(const Vec3& p, const Vec3& centre, const Vec3& radii) {
  const Vec3 q = (p - centre).cwiseQuotient(radii);
  const double k = q.norm(), g = q.cwiseQuotient(radii).norm();
  return g > 0 ? k * (k - 1) / g : -radii.minCoeff();
}

double smooth_union(double a, double b, double blend) {
  const double h = std::clamp(0.5 + 0.5 * (b - a) / blend, 0.0, 1.0);
  return b + (a - b) * h - blend * h * (1 - h);
}

Vec3 gradient(const Implicit& f, const Vec3& p) {
  const double step = 1e-5;
  Vec3 g;
  for (int k = 0; k < 3; ++k) {
    const Vec3 d = step * Vec3::Unit(k);
    g[k] = (f(p + d) - f(p - d)) / (2 * step);
  }
  return g;
}

// Points of the surface, evenly by area nearly, of those that `seen` keeps.
std::vector<Vec3> sample(const Implicit& f, double size, std::size_t count,
                         const std::function<bool(const Vec3&, const Vec3&)>& seen,
                         Random& random) {
  std::vector<Vec3> points;
  while (points.size() < count) {
    Vec3 p =
        size * (2 * Vec3(random.uniform(), random.uniform(), random.uniform()) - Vec3(1, 1, 1));
    if (std::abs(f(p)) > 0.03 * size) continue;
    for (int step = 0; step < 8; ++step) {
      const Vec3 g = gradient(f, p);
      p -= f(p) * g / std::max(g.squaredNorm(), 1e-12);
    }
    const Vec3 n = gradient(f, p).normalized();
    if (std::abs(f(p)) < 1e-6 && seen(p, n)) points.push_back(p);
  }
  return points;
}

Object scanned(const std::string& name, const Implicit& f, double size, std::size_t count,
               double noise, double outliers,
               const std::function<bool(const Vec3&, const Vec3&)>& seen) {
  Random random(7);
  Object object{name, sample(f, size, count, seen, random), {}};
  object.truth = sample(f, size, 10000, seen, random);
  for (Vec3& p : object.scan) {
    p += noise * Vec3(random.normal(), random.normal(), random.normal());
    if (random.uniform() < outliers) {
      p += 0.3 * size *
           (Vec3(random.uniform(), random.uniform(), random.uniform()) - Vec3(0.5, 0.5, 0.5));
    }
  }
  return object;
}

std::vector<Object> objects() {
  const auto standing = [](const Vec3& p, const Vec3& n) { return p.z() > 1e-3 && n.z() > -0.99; };
  const auto all_round = [](const Vec3&, const Vec3&) { return true; };
  const auto above = [](const Vec3& p, const Vec3& n) { return p.z() > 0.012 && n.z() > 0.3; };
  const Implicit organ = [](const Vec3& p) {
    return ellipsoid(p, Vec3(0, 6 * p.x() * p.x(), 0.0), Vec3(0.052, 0.032, 0.03));
  };
  const Implicit hare = [](const Vec3& p) {
    double d = ellipsoid(p, Vec3(0, 0, -0.02), Vec3(0.045, 0.035, 0.035));
    d = smooth_union(d, ellipsoid(p, Vec3(0.03, 0, 0.02), Vec3(0.022, 0.02, 0.02)), 0.01);
    for (const double side : {-1.0, 1.0}) {
      d = smooth_union(d, ellipsoid(p, Vec3(0.03, 0.012 * side, 0.055), Vec3(0.009, 0.004, 0.03)),
                       0.004);
    }
    return d;
  };
  const Implicit foot = [](const Vec3& p) {
    double d = ellipsoid(p, Vec3(0, 0, 0), Vec3(0.07, 0.03, 0.022));
    d = smooth_union(d, ellipsoid(p, Vec3(-0.045, 0, 0.04), Vec3(0.022, 0.022, 0.05)), 0.02);
    for (int toe = 0; toe < 5; ++toe) {
      d = smooth_union(d,
                       ellipsoid(p, Vec3(0.07 - 0.004 * toe, -0.022 + 0.011 * toe, -0.005),
                                 Vec3(0.016, 0.0052, 0.006)),
                       0.003);
    }
    return d;
  };
  std::vector<Object> list;
  list.push_back(scanned(
      "cuboid",
      [](const Vec3& p) { return box(p, Vec3(-0.04, -0.06, -0.05), Vec3(0.04, 0.06, 0.05)); }, 0.08,
      3000, 2e-4, 0.01, standing));
  list.push_back(scanned(
      "step",
      [](const Vec3& p) {
        return std::min(box(p, Vec3(-0.05, -0.04, -0.05), Vec3(0.05, 0.04, 0.02)),
                        box(p, Vec3(-0.05, -0.04, -0.05), Vec3(0, 0.04, 0.05)));
      },
      0.08, 3000, 2e-4, 0.01, standing));
  list.push_back(scanned(
      "ball", [](const Vec3& p) { return p.norm() - 0.05; }, 0.08, 3000, 5e-4, 0.01, all_round));
  list.push_back(scanned("organ-top", organ, 0.08, 3000, 2e-4, 0.01, above));
  list.push_back(scanned("organ", organ, 0.08, 8000, 2e-4, 0.01, all_round));
  list.push_back(scanned("hare", hare, 0.1, 35000, 1e-4, 0, all_round));
  list.push_back(scanned("foot", foot, 0.1, 10000, 1e-4, 0, all_round));
  // Touched in four zones, each off by its own shift.
  Object touched = scanned("touched", organ, 0.08, 4000, 2e-4, 0, all_round);
  for (Vec3& p : touched.scan) {
    p += 3e-4 * Vec3(p.x() > 0 ? 1 : -1, p.y() > 0.005 ? 1 : -1, p.x() * p.y() > 0 ? 1 : -1);
  }
  list.push_back(touched);
  return list;
}

void add_file(std::vector<Object>& list, const std::string& name, const std::filesystem::path& file,
              double unit) {
  if (!std::filesystem::exists(file)) {
    fmt::print(stderr, "SKIPPED: {}: no {}; set HAPSIM_SHARED\n", name, file.string());
    return;
  }
  Input input(file.string());
  PointCloud cloud = read_points(input);
  for (Vec3& p : cloud.points) p *= unit;
  check_size(cloud.points, fmt::format("{} m", unit), input.name());
  CleanReport cleaned;
  list.push_back({name, cloud.points, clean_points(cloud, {}, name, cleaned).points});
}

struct Row {
  bool done = false;
  double rms = 0, largest = 0, seconds = 0, spacing = 0;
  std::size_t faces = 0;
  std::array<char, 160> text{};
};

Row reconstructed(const Object& object, ReconstructMethod method) {
  Row row;
  const auto start = std::chrono::steady_clock::now();
  try {
    CleanReport cleaned;
    PointCloud cloud;
    cloud.points = object.scan;
    cloud = clean_points(cloud, {}, object.name, cleaned);
    row.spacing = point_spacing(cloud.points);
    ReconstructOptions options;
    options.method = method;
    options.no_base = true;
    if (object.name == "cuboid" || object.name == "step") options.base = 0;
    if (object.name == "organ-top") options.base_depth = 0.01;
    ReconstructReport report;
    const Surface surface = reconstruct(cloud, options, object.name, report);
    row.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    row.done = is_closed(surface) && signed_volume(surface) > 0;
    row.faces = surface.faces.size();
    const SurfaceTree tree(surface);
    for (const Vec3& p : object.truth) {
      const double off = tree.nearest(p).distance;
      row.rms += off * off / static_cast<double>(object.truth.size());
      row.largest = std::max(row.largest, off);
    }
    row.rms = std::sqrt(row.rms);
    const std::string took = method_name(report.method) + (report.sharp ? ", sharp" : "");
    std::snprintf(row.text.data(), row.text.size(), "%s", took.c_str());
  } catch (const std::exception& error) {
    std::snprintf(row.text.data(), row.text.size(), "%s", error.what());
  }
  return row;
}

// In a process of its own: its memory is measured, and its crash is a row.
void measure(const Object& object, ReconstructMethod method) {
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) return;
  std::fflush(stdout);
  const pid_t child = fork();
  if (child == 0) {
    alarm(120);
    const Row row = reconstructed(object, method);
    _exit(write(ends[1], &row, sizeof row) == static_cast<ssize_t>(sizeof row) ? 0 : 1);
  }
  close(ends[1]);
  Row row;
  const bool whole = read(ends[0], &row, sizeof row) == static_cast<ssize_t>(sizeof row);
  close(ends[0]);
  int status = 0;
  rusage used{};
  wait4(child, &status, 0, &used);
  if (!whole) {
    std::snprintf(row.text.data(), row.text.size(), "ended by signal %d",
                  WIFSIGNALED(status) ? WTERMSIG(status) : 0);
  }
  fmt::print("{:<10} {:<16} {:<6} {:>7} {:>8.3f} {:>8.3f} {:>8.2f} {:>7.1f} {:>6} {}\n",
             object.name, method_name(method), row.done ? "yes" : "NO", row.faces, 1e3 * row.rms,
             1e3 * row.largest, 1e3 * row.spacing, row.seconds, used.ru_maxrss / 1024,
             row.text.data());
}

}  // namespace
}  // namespace hapsim

int main(int argc, char** argv) {
  using namespace hapsim;
  std::vector<Object> list = objects();
  const char* given = std::getenv("HAPSIM_SHARED");
  const std::filesystem::path source = HAPSIM_SOURCE_DIR;
  const std::filesystem::path shared = given != nullptr ? given : source / "../shared";
  add_file(list, "phantom", source / "share/examples/phantom/scan.csv", 1e-3);
  for (const char* name : {"bunny", "foot"}) {
    add_file(list, fmt::format("{}-points", name),
             shared / "realdata/toolbox_points" / (std::string(name) + ".csv"), 1e-3);
  }
  fmt::print("{:<10} {:<16} {:<6} {:>7} {:>8} {:>8} {:>8} {:>7} {:>6} {}\n", "object", "method",
             "closed", "faces", "rms_mm", "max_mm", "gap_mm", "s", "MB", "took");
  for (const Object& object : list) {
    const bool wanted = argc < 2 || std::any_of(argv + 1, argv + argc, [&](const char* name) {
                          return object.name == name;
                        });
    if (!wanted) continue;
    for (const std::string& name : reconstruct_methods()) measure(object, method_named(name));
  }
  return 0;
}
