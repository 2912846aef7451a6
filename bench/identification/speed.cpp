// The time of an identification on a body of a heart's size (1,763 tetrahedra), 300 samples: E and
// nu, and six parameters of two Maxwell terms, ours against SciPy's least_squares with finite
// differences (Debian python3-scipy) around CalculiX (calculix-ccx) and around hs-simulate.
//
//   bench_identify_speed OUT BIN        BIN: the folder of hs-simulate
//
// Seconds of the processor, of all programs together. Ours: from the prepared body, median of 21
// (the search from 20 starts: of 5), and the preparation by itself. "by differences" is our own
// loop without its derivatives. CalculiX solves a first-order mesh refined at the tools, one unit
// press a run, and is given what that very mesh gives for the truth, so that it can be right; our
// data come from finer meshes.
// Recorded in bench/results/identify-speed.txt (bench/record.sh).
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "base/blas.h"
#include "base/error.h"
#include "base/median.h"
#include "calculix_input.h"
#include "effects/catalogue.h"
#include "estimate/least_squares.h"
#include "fit/extend.h"
#include "formats/tetmesh_io.h"
#include "io/csv.h"
#include "support/finer_contact.h"
#include "support/objects.h"
#include "tetmesh/body_mesh.h"
#include "truth.h"
#include "whole_run.h"

namespace hapsim::bench {
namespace {

namespace fs = std::filesystem;

constexpr double kModulus = 1.5e4, kPoisson = 0.42, kDepth = 2e-3, kNoise = 0.01;
const Relaxation kRelaxation{{8e3, 0.3}, {6e3, 5}};
constexpr std::size_t kTets = 1763;

template <class Work>
double median_time(int runs, const Work& work) {
  std::vector<double> seconds;
  for (int i = 0; i < runs; ++i) {
    const double begin = processor_seconds();
    work();
    seconds.push_back(processor_seconds() - begin);
  }
  return upper_median(std::move(seconds));
}

// About `tets` tetrahedra, by halving the edge's logarithm; refined at `contacts`.
TetMesh body_of(const Surface& surface, std::size_t tets, const std::vector<Vec3>& contacts) {
  double low = 0.002, high = 0.1;
  TetMesh best;
  for (int i = 0; i < 9; ++i) {
    BodyOptions options;
    options.edge = std::sqrt(low * high);
    options.contacts = contacts;
    options.tool_radius = kToolRadius;
    if (!contacts.empty()) options.contact_size = 0.004;
    TetMesh mesh = make_body_mesh(surface, options);
    (mesh.tets.size() > tets ? low : high) = options.edge;
    const auto off = [&](const TetMesh& m) {
      return std::abs(static_cast<double>(m.tets.size()) - static_cast<double>(tets));
    };
    if (best.tets.empty() || off(mesh) < off(best)) best = std::move(mesh);
  }
  return best;
}

struct Scene {
  Object object;
  std::vector<Vec3> positions;
  std::vector<Eigen::Matrix3d> K;  // true, of E = 1
  std::vector<TruePress> presses;  // two a position
};

Scene make_scene(const std::string& out) {
  Scene s;
  s.object.name = "heart";
  BodyOptions as_it_is;
  as_it_is.preserve_surface = true;
  s.object.exact = make_body_mesh(test::lump(50), as_it_is, "lump");
  s.object.meshed = body_of(test::lump(12), kTets, {});
  s.positions = test::positions_on(s.object.exact, 5, 5, kToolRadius);
  Material material;
  material.nu = kPoisson;
  s.K = true_stiffness(out, "heart", s.object, s.positions, material);
  const SurfaceTree tree(boundary_surface(s.object.exact));
  for (std::size_t p = 0; p < s.positions.size(); ++p) {
    const Vec3 n = face_normal(tree.surface(), tree.nearest(s.positions[p]).face).normalized();
    s.presses.push_back({static_cast<int>(p), -kDepth * n, 1, 4.8});
    s.presses.push_back({static_cast<int>(p), kDepth * (0.6 * n.unitOrthogonal() - n), 1, 4.8});
  }
  return s;
}

// 30 samples a press: by depth, or in time every 0.2 s (the first, at rest, left out).
Recording measured(const Scene& s, bool relaxing) {
  Recording r = record(s.positions, s.presses, relaxing ? 0.2 : 0, 30);
  const auto f = true_forces(r, s.presses, s.K, kModulus, relaxing ? kRelaxation : Relaxation{});
  Random random(1);
  measure(r, s.presses, f, 0, kNoise * peak(f), random);
  r.metadata.set("force_noise", format_number(kNoise * peak(f)));
  return r;
}

Model start_model(bool relaxing) {
  Model model;
  model.parameters = effect_rows(require_effect("elastic"), 1, {1e4, 0.3});
  if (relaxing)
    for (const Parameter& p : effect_rows(require_effect("viscoelastic"), 2, {5e3, 0.1, 5e3, 1.0}))
      model.parameters.push_back(p);
  return model;
}

void print(const std::string& what, double seconds, double ours, int evaluations,
           const std::vector<double>& x, double rmse, const std::string& note = "") {
  std::string values;
  for (const double v : x) values += fmt::format(" {:.5g}", v);
  fmt::print("{:<44} {:>10.4f} {:>8.0f} {:>6} {:>9.5f} {}{}\n", what, seconds, seconds / ours,
             evaluations, rmse, values, note.empty() ? "" : "  (" + note + ")");
}

std::vector<double> values_of(const Model& model) {
  std::vector<double> x;
  for (const Parameter& p : model.parameters) x.push_back(p.value);
  return x;
}

// The same fit with differences for derivatives: one more evaluation a parameter.
void by_differences(const Model& start, const Experiment& w, double ours, const std::string& what) {
  const Selection all = all_episodes(w.dataset);
  const Eigen::VectorXd f = measured_forces(w.dataset, all);
  const Linearisation about = w.places.solve(material_of(start));
  Model trial = start;
  const std::vector<int> free = start.free_parameters();
  int evaluations = 0;
  const auto at = [&](const Eigen::VectorXd& x) {
    for (std::size_t c = 0; c < free.size(); ++c)
      trial.parameters[free[c]].value = x[static_cast<Eigen::Index>(c)];
    ++evaluations;
    return Eigen::VectorXd((model_forces(trial, w, about, all, false).f - f) / w.noise.value);
  };
  const ResidualFunction residuals = [&](const Eigen::VectorXd& x, Eigen::VectorXd& r,
                                         Eigen::MatrixXd* J) {
    r = at(x);
    if (J == nullptr) return;
    J->resize(r.size(), x.size());
    for (Eigen::Index c = 0; c < x.size(); ++c) {
      Eigen::VectorXd y = x;
      const double step = 1e-5 * std::abs(x[c]);
      y[c] += step;
      J->col(c) = (at(y) - r) / step;
    }
  };
  LeastSquaresResult result;
  const double seconds = median_time(5, [&] {
    evaluations = 0;
    std::vector<Unknown> unknowns;
    for (const int i : free) {
      const Parameter& p = start.parameters[i];
      unknowns.push_back(
          {p.value, std::max(p.lower, 1e-9), p.upper, std::max(p.value, 1e-9), p.unit == "s"});
    }
    result = minimise(unknowns, residuals);
  });
  print(what, seconds, ours, evaluations, {result.x.data(), result.x.data() + result.x.size()},
        w.noise.value * std::sqrt(result.sum_of_squares / static_cast<double>(f.size())));
}

nlohmann::json scipy(const std::string& arguments) {
  const std::string command =
      "/usr/bin/python3 '" HAPSIM_SOURCE_DIR "/bench/identification/scipy_loop.py' " + arguments;
  FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) fail_io(command, "cannot be run", "install python3-scipy");
  std::string text;
  for (int c = 0; (c = std::fgetc(pipe)) != EOF;) text += static_cast<char>(c);
  if (pclose(pipe) != 0) fail_io(command, "failed", "install python3-scipy and calculix-ccx");
  return nlohmann::json::parse(text);
}

void print_scipy(const std::string& what, const nlohmann::json& found, double ours) {
  print(what, found["seconds"], ours, found["evaluations"], found["x"], found["rmse"],
        fmt::format("{} runs", found["runs"].get<int>()));
}

// data.csv of what CalculiX's own elements give for the truth, with noise, and its decks.
void write_calculix_case(const Scene& s, const fs::path& folder) {
  fs::create_directories(folder);
  const TetMesh mesh = body_of(test::lump(12), kTets, s.positions);
  Recording r = record(s.positions, s.presses, 0, 30);
  std::vector<Vec3> unit;
  for (std::size_t k = 0; k < s.presses.size(); ++k) {
    const Vec3& at = s.positions[static_cast<std::size_t>(s.presses[k].position)];
    std::vector<int> patch;
    for (const int n : [&] {
           std::vector<int> nodes;
           boundary_surface(mesh, &nodes);
           return nodes;
         }())
      if ((mesh.nodes[n] - at).norm() < 1.05 * kToolRadius) patch.push_back(n);
    const fs::path deck = folder / fmt::format("unit-{}.inp", k);
    write_calculix(deck, mesh, patch, kModulus, kPoisson, s.presses[k].u.normalized(), "SPOOLES");
    fs::copy_file(deck, folder / "run.inp", fs::copy_options::overwrite_existing);
    if (std::system(("cd '" + folder.string() + "' && ccx run >/dev/null 2>&1").c_str()) != 0)
      fail_io("ccx", "failed", "install calculix-ccx");
    unit.push_back(calculix_force(folder / "run.dat"));
  }
  double most = 0;
  Random random(2);
  for (std::size_t i = 0; i < r.rows(); ++i) {
    r.f[i] = r.u[i].norm() * unit[static_cast<std::size_t>(r.press[i])];
    most = std::max(most, r.f[i].norm());
  }
  for (Vec3& f : r.f)
    for (int c = 0; c < 3; ++c) f[c] += kNoise * most * random.normal();
  std::ofstream out(folder / "data.csv");
  write_recording(out, r);
  fmt::print("CalculiX: {} nodes, {} tetrahedra\n", mesh.nodes.size(), mesh.tets.size());
}

void write_process_case(const Scene& s, const Recording& r, const Model& start,
                        const fs::path& folder) {
  fs::create_directories(folder);
  std::ofstream body(folder / "body.ply"), data(folder / "data.csv"), model(folder / "start.csv");
  write_body_ply(body, s.object.meshed);
  write_recording(data, r);
  write_model(model, start);
}

int run(const std::string& out, const std::string& bin) {
  fs::create_directories(out);
  prepare_blas_for_many_threads();
  const Scene s = make_scene(out);
  fmt::print(
      "body: {} nodes, {} tetrahedra; 5 positions, 10 presses, truth {} {}, relaxing 8000 "
      "0.3 6000 5\n",
      s.object.meshed.nodes.size(), s.object.meshed.tets.size(), kModulus, kPoisson);
  fmt::print("{:<44} {:>10} {:>8} {:>6} {:>9}  values\n", "", "s", "ratio", "calls", "error N");
  ExperimentOptions options;
  for (const bool relaxing : {false, true}) {
    const double begin = processor_seconds();
    const Experiment w = make_experiment(s.object.meshed, measured(s, relaxing), options);
    fmt::print("preparation, {} samples: {:.3f} s\n", w.dataset.rows(),
               processor_seconds() - begin);
    const Selection all = all_episodes(w.dataset);
    FitOptions fit_options{w.noise.value, w.floor, true};
    Fit result;
    const Model start = start_model(relaxing);
    const std::string what = relaxing ? "six parameters" : "E and nu";
    const auto fit_once = [&] { result = fit(start, w, all, fit_options); };
    const double ours = median_time(21, fit_once);
    print(what + ", hapsim", ours, ours, 0, values_of(result.model), result.error.pooled);
    if (relaxing) {
      fit_options.starts = 20;
      const double many = median_time(5, fit_once);
      print(what + ", hapsim, 20 starts", many, ours, 0, values_of(result.model),
            result.error.pooled);
    }
    by_differences(start, w, ours, what + ", hapsim by differences");
    const fs::path folder = fs::absolute(out) / (relaxing ? "six" : "elastic");
    write_process_case(s, w.dataset.recording, start, folder);
    print_scipy(what + ", SciPy around hs-simulate",
                scipy("hs-simulate '" + folder.string() + "' '" + fs::absolute(bin).string() +
                      "/hs-simulate'"),
                ours);
    if (relaxing) continue;
    const fs::path ccx = fs::absolute(out) / "calculix";
    write_calculix_case(s, ccx);
    print_scipy(what + ", SciPy around CalculiX", scipy("calculix '" + ccx.string() + "'"), ours);
  }
  return 0;
}

}  // namespace
}  // namespace hapsim::bench

int main(int argc, char** argv) {
  if (argc != 3) {
    fmt::print(stderr, "bench_identify_speed OUT BIN\n");
    return 2;
  }
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  try {
    return hapsim::bench::run(argv[1], argv[2]);
  } catch (const hapsim::Error& error) {
    fmt::print(stderr, "bench_identify_speed: {}\n", error.what());
    return 3;
  }
}
