// What a real-time force costs: making a body ready, one step of the loop, and all compliances of a
// surface beside CHOLMOD's own solutions. Prints tables; larger bodies: bench_sizes.
// Recorded in bench/results/realtime*.txt (bench/record.sh).
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

#include "base/blas.h"
#include "base/median.h"
#include "effects/catalogue.h"
#include "formats/tetmesh_io.h"
#include "linalg/sparse_cholesky.h"
#include "realtime/force_loop.h"
#include "realtime/latency.h"
#include "realtime/real_time.h"
#include "solid/surface_compliance.h"
#include "support/block_mesh.h"
#include "support/objects.h"
#include "tetmesh/body_mesh.h"

namespace {

using namespace hapsim;

constexpr double kRadius = 0.004;

std::string machine() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
  return "unknown processor";
}

// The mesh whose number of tetrahedra is nearest to `tets`, by halving the edge's logarithm.
TetMesh body_of(const Surface& surface, std::size_t tets, int steps = 9) {
  double low = 0.002, high = 0.1;
  TetMesh best;
  for (int i = 0; i < steps; ++i) {
    BodyOptions options;
    options.edge = std::sqrt(low * high);
    TetMesh mesh = make_body_mesh(surface, options);
    (mesh.tets.size() > tets ? low : high) = options.edge;
    const auto off = [&](const TetMesh& m) {
      return std::abs(static_cast<double>(m.tets.size()) - static_cast<double>(tets));
    };
    if (best.tets.empty() || off(mesh) < off(best)) best = std::move(mesh);
  }
  return best;
}

Model model_with(int terms) {
  Model model;
  for (const Effect* effect : catalogue()) {
    std::vector<double> values;
    if (effect->card().name == "elastic") values = {1.5e4, 0.45};
    if (effect->card().name == "viscoelastic")
      for (int k = 0; k < terms; ++k) values.insert(values.end(), {5e3, 0.03 * std::pow(4, k)});
    if (values.empty()) continue;
    const auto rows = effect_rows(*effect, std::max(1, effect->card().terms ? terms : 1), values);
    model.parameters.insert(model.parameters.end(), rows.begin(), rows.end());
  }
  return model;
}

// Two halves in plan view, each with its own modulus and two Maxwell elements of its own.
Model regional_model(const Vec3& low, const Vec3& high) {
  Model model = model_with(0);
  const auto add = [&](const char* effect, int region, const char* name, double value) {
    Parameter p;
    p.effect = effect;
    p.region = region;
    p.name = name;
    p.value = value;
    model.parameters.push_back(p);
  };
  add("elastic", 1, "E", 6e3);
  for (int r = 0; r < 2; ++r) {
    add("regions", r, "x0", low.x() + (0.25 + 0.5 * r) * (high.x() - low.x()));
    add("regions", r, "y0", 0.5 * (low.y() + high.y()));
    add("viscoelastic", r, "E1", 5e3 - 2e3 * r);
    add("viscoelastic", r, "tau1", 0.03 + 0.05 * r);
    add("viscoelastic", r, "E2", 5e3);
    add("viscoelastic", r, "tau2", 0.4 + 0.6 * r);
  }
  return model;
}

double ms_since(std::int64_t start) {
  return 1e-6 * static_cast<double>(monotonic_ns() - start);
}

struct Named {
  const char* name;
  TetMesh mesh;
  Vec3 low, high;  // box of the surface that paths run over
};

Named named(const char* name, TetMesh mesh) {
  Named body{name, std::move(mesh), Vec3::Constant(1e9), Vec3::Constant(-1e9)};
  for (const Vec3& p : body.mesh.nodes) {
    body.low = body.low.cwiseMin(p);
    body.high = body.high.cwiseMax(p);
  }
  return body;
}

// Once from samples, then from the field in the cache: from the bytes of both files.
void creation(const Named& body, int terms) {
  std::ostringstream ply, csv;
  write_body_ply(ply, body.mesh);
  write_model(csv, model_with(terms));
  const std::string body_bytes = ply.str(), model_bytes = csv.str();
  std::vector<double> read, ready, total, processor;
  PreparedBodyOptions options;
  options.tool_radius = kRadius;
  const auto cache =
      std::filesystem::temp_directory_path() / fmt::format("hs-bench-{}-{}", getpid(), body.name);
  options.cache = cache.string();
  std::size_t entries = 0;
  double made = 0;
  for (int i = 0; i < 31; ++i) {
    const std::int64_t start = monotonic_ns();
    const std::clock_t begun = std::clock();
    Input body_input = Input::from_bytes(body_bytes, "body.ply");
    Input model_input = Input::from_bytes(model_bytes, "model.csv");
    const TetMesh mesh = read_body(body_input);
    const Model model = read_model(model_input);
    read.push_back(ms_since(start));
    const std::int64_t prepare = monotonic_ns();
    const PreparedBody prepared(mesh, model, options);
    ready.push_back(ms_since(prepare));
    total.push_back(ms_since(start));
    processor.push_back(1e3 * static_cast<double>(std::clock() - begun) / CLOCKS_PER_SEC);
    entries = prepared.field().entries().size();
    if (i > 0) continue;
    made = 1e-3 * total.back();
    for (std::vector<double>* times : {&read, &ready, &total, &processor}) times->clear();
  }
  std::filesystem::remove_all(cache);
  fmt::print("{:<8} {:>6} {:>7} {:>9} {:>8.1f} {:>8.2f} {:>10.2f} {:>8.2f} {:>9.2f} {:>10.2f}\n",
             body.name, body.mesh.nodes.size(), body.mesh.tets.size(), entries, made, median(read),
             median(ready), median(total), *std::min_element(total.begin(), total.end()),
             median(processor));
}

// A tool that wanders over the top and presses as it goes, each step by the clock; the clock's own
// 20 to 40 ns are in it.
void steps(const Named& body, const Model& model, bool slides) {
  PreparedBodyOptions prepare;
  prepare.tool_radius = kRadius;
  const std::clock_t begun = std::clock();
  const PreparedBody prepared(body.mesh, model, prepare);
  const double ready = 1e3 * static_cast<double>(std::clock() - begun) / CLOCKS_PER_SEC;
  ToolLoopOptions options;
  options.contact.slides = slides;
  ForceLoop loop(prepared, options);
  const Vec3 middle = 0.5 * (body.low + body.high), half = 0.5 * (body.high - body.low);
  LatencyHistogram histogram;
  constexpr int kSteps = 1'000'000;
  double work = 0;
  int touching = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double t = 1e-3 * i;
    // The path's height follows the body's top, from 2 mm above it to 4 mm inside.
    const double x = std::sin(0.37 * t), y = std::sin(0.53 * t + 1);
    const Vec3 above(middle.x() + 0.8 * half.x() * x, middle.y() + 0.8 * half.y() * y,
                     body.high.z());
    const SurfaceSide top = prepared.distance().at(above);
    const Vec3 tool = top.point - (0.001 - 0.003 * std::cos(2.1 * t)) * Vec3::UnitZ();
    const std::int64_t start = monotonic_ns();
    const Vec3 f = loop.step(t, tool);
    histogram.add(monotonic_ns() - start);
    work += f.z();
    touching += loop.tool().touching() ? 1 : 0;
  }
  fmt::print(
      "{:<8} {:>5} {:>8} {:>5.0f} % {:>8.2f} {:>8.2f} {:>8.2f} {:>9.2f} {:>10.1f}   {:.3g}\n",
      body.name, prepared.terms().size(), slides ? "slides" : "holds", 100.0 * touching / kSteps,
      1e-3 * histogram.quantile(0.5), 1e-3 * histogram.quantile(0.99),
      1e-3 * histogram.quantile(0.999), 1e-3 * histogram.quantile(0.9999),
      1e-3 * histogram.largest(), work / kSteps);
  if (prepared.is_regional())
    fmt::print(
        "         (made ready in {:.0f} ms of the processor, within {:.0e} of the stiffness)\n",
        ready, prepared.misfit());
}

// All compliances of the free surface, as condensed here and by CHOLMOD 48 columns at a time.
void compliances(const char* name, const TetMesh& mesh, int threads, int repeats) {
  const std::vector<Lame> constants(mesh.tets.size(), lame(1e4, 0.45));
  std::vector<double> analyse, ours, factorise, bare;
  double difference = 0;
  Eigen::Index columns = 0;
  for (int i = 0; i < repeats; ++i) {
    std::int64_t start = monotonic_ns();
    SurfaceCompliance surface(mesh);
    analyse.push_back(ms_since(start));
    start = monotonic_ns();
    surface.factorise(constants, threads);
    ours.push_back(ms_since(start));

    SparseCholesky cholesky(surface.stiffness());
    const BlasThreads scope(threads);
    start = monotonic_ns();
    cholesky.factorise(surface.stiffness());
    factorise.push_back(ms_since(start));
    std::vector<int> rows;  // of the surface in the whole system
    int block = 0;
    for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
      if (mesh.fixed[n]) continue;
      for (int k = 0; k < 3 && surface.index_of(static_cast<int>(n)) >= 0; ++k)
        rows.push_back(3 * block + k);
      ++block;
    }
    columns = static_cast<Eigen::Index>(rows.size());
    difference = 0;
    for (Eigen::Index c = 0; c < columns; c += 48) {
      const Eigen::Index m = std::min<Eigen::Index>(48, columns - c);
      Eigen::MatrixXd load = Eigen::MatrixXd::Zero(surface.unknowns(), m);
      for (Eigen::Index j = 0; j < m; ++j) load(rows[c + j], j) = 1;
      const Eigen::MatrixXd x = cholesky.solve(load);
      const Eigen::MatrixXd kept = x(rows, Eigen::all);
      difference =
          std::max(difference, (kept - surface.matrix().middleCols(c, m)).cwiseAbs().maxCoeff());
    }
    bare.push_back(ms_since(start));
    difference /= surface.matrix().cwiseAbs().maxCoeff();
  }
  fmt::print(
      "{:<8} {:>7} {:>8} {:>9} {:>7} {:>9.2f} {:>10.2f} {:>11.2f} {:>11.2f} {:>6.2f} {:>9.1e}\n",
      name, mesh.nodes.size(), mesh.tets.size(), columns, threads, median(analyse), median(ours),
      median(factorise), median(bare), median(bare) / median(ours), difference);
}

void compliances_heading() {
  fmt::print(
      "\nall surface compliances [ms]: condensed (assembly included) against CHOLMOD, its "
      "factorisation and its solutions of 48 columns at a time\n"
      "body       nodes     tets  unknowns threads   analyse  condensed  factorise  + columns"
      "  ratio difference\n");
}

// A day of steps at 1 kHz in one contact, as fast as they go; at its end against a loop that began
// a thousand seconds before it.
void day(const Named& body, int terms) {
  PreparedBodyOptions prepare;
  prepare.tool_radius = kRadius;
  const PreparedBody prepared(body.mesh, model_with(terms), prepare);
  const Vec3 middle(0.5 * (body.low.x() + body.high.x()), 0.5 * (body.low.y() + body.high.y()),
                    body.high.z());
  const auto u = [](long i) {
    const double t = 1e-3 * static_cast<double>(i % 7919);  // periods that meet after long
    return Vec3(2e-4 * std::sin(3 * t), 0, -0.002 * (1 - std::cos(5 * t)));
  };
  ForceLoop whole(prepared), late(prepared);
  whole.begin(middle);
  late.begin(middle);
  const long steps = 86'400'000, join = steps - 1'000'000, check = steps - 10'000;
  double largest = 0, difference = 0;
  const std::int64_t start = monotonic_ns();
  for (long i = 0; i < steps; ++i) {
    const double t = 1e-3 * static_cast<double>(i);
    const Vec3 f = whole.press(t, u(i));
    if (i < join) continue;
    const Vec3 g = late.press(t, u(i));
    if (i < check) continue;
    largest = std::max(largest, f.norm());
    difference = std::max(difference, (f - g).norm());
  }
  fmt::print("{:<8} {:>5} {:>10} {:>9.1f} {:>12.2e}\n", body.name, terms, steps,
             1e-3 * ms_since(start), difference / largest);
}

// What the machine itself does to a loop that only sleeps until each millisecond.
void bare_loop(int seconds) {
  const std::string how = enter_real_time();
  std::vector<double> late;
  timespec due;
  clock_gettime(CLOCK_MONOTONIC, &due);
  for (int i = 0; i < 1000 * seconds; ++i) {
    due.tv_nsec += 1000000;
    if (due.tv_nsec >= 1000000000) due.tv_nsec -= 1000000000, ++due.tv_sec;
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &due, nullptr);
    timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    late.push_back(1e6 * static_cast<double>(now.tv_sec - due.tv_sec) +
                   1e-3 * static_cast<double>(now.tv_nsec - due.tv_nsec));
  }
  leave_real_time();
  std::sort(late.begin(), late.end());
  const auto at = [&](double share) {
    return late[static_cast<std::size_t>(share * static_cast<double>(late.size() - 1))];
  };
  fmt::print(
      "a loop that does nothing ({}): median {:.1f} us, 99.9 % {:.0f}, longest {:.0f}; {} of {} "
      "later "
      "than 1 ms\n",
      how, at(0.5), at(0.999), late.back(),
      late.end() - std::upper_bound(late.begin(), late.end(), 1000.0), late.size());
}

}  // namespace

// bench_realtime, bench_realtime day, or bench_realtime machine [SECONDS].
int main(int argc, char** argv) {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);  // each line when it is known
  prepare_blas_for_many_threads();
  fmt::print("machine: {}, {} threads; {}\n", machine(), std::thread::hardware_concurrency(),
             blas_name());
  if (argc > 1 && std::string(argv[1]) == "machine") {
    bare_loop(argc > 2 ? std::atoi(argv[2]) : 20);
    return 0;
  }
  const Surface block = boundary_surface(test::block_mesh({0.12, 0.21, 0.06}, 1, 1, 1, 1));
  const Named cuboid = named("cuboid", body_of(block, 568));
  const Named organ = named("organ", body_of(test::lump(12), 1763));
  if (argc > 1 && std::string(argv[1]) == "day") {
    fmt::print("\na day at 1 kHz, one contact\nbody     terms      steps  seconds   difference\n");
    for (const Named* body : {&cuboid, &organ})
      for (const int terms : {0, 2}) day(*body, terms);
    return 0;
  }

  fmt::print(
      "\nmaking ready: once from samples [s], then from the cache, median of 30 [ms]\n"
      "body      nodes    tets   entries   made s     read    "
      "prepare    total     least  processor\n");
  for (const Named* body : {&cuboid, &organ}) creation(*body, 2);
  fmt::print(
      "\none step of the loop, 1,000,000 steps [us]\nbody     terms  contact  touch   median"
      "     99 %   99.9 %   99.99 %    longest   mean force [N]\n");
  fmt::print("({})\n", enter_real_time());
  for (const Named* body : {&cuboid, &organ})
    for (const int terms : {0, 2, 4})
      for (const bool slides : {false, true}) steps(*body, model_with(terms), slides);
  fmt::print("regions with two Maxwell elements each, of their own\n");
  for (const Named* body : {&cuboid, &organ})
    for (const bool slides : {false, true})
      steps(*body, regional_model(body->low, body->high), slides);
  leave_real_time();
  compliances_heading();
  compliances("cuboid", cuboid.mesh, 1, 21);
  compliances("organ", organ.mesh, 1, 21);
}
