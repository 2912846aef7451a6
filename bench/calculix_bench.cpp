// The same static problem, a block pressed 3 mm by a bonded flat tool, as whole runs of CalculiX
// (Debian calculix-ccx) with its direct and its iterative solvers and of hs-simulate --own-mesh:
// reading the mesh, solving, writing the force. Seconds of the processor (the least of the runs),
// largest memory, the tool's normal force, and how many times faster hs-simulate is.
//
//   bench_calculix BIN [runs [order]]
//
// BIN is the folder of hs-simulate. CalculiX's second-order elements have no mean dilatation, so
// the forces of second order differ a little; those of first order are the same.
// Recorded in bench/results/calculix.txt (bench/record.sh).
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "calculix_input.h"
#include "formats/tetmesh_io.h"
#include "solid/mesh_press.h"
#include "support/block_mesh.h"
#include "tetmesh/body_mesh.h"
#include "whole_run.h"

namespace {

using namespace hapsim;
namespace fs = std::filesystem;

constexpr double kRadius = 0.004, kDepth = 0.003, kModulus = 1e4, kNu = 0.3;
const Vec3 kPlace(0.06, 0.105, 0.06);

// A block refined at the tool with about `tets` tetrahedra.
TetMesh pressed_block(std::size_t tets, int order) {
  const Surface surface = boundary_surface(test::block_mesh({0.12, 0.21, 0.06}, 1, 1, 1, 1));
  double low = 0.002, high = 0.05;
  TetMesh best;
  for (int i = 0; i < 7; ++i) {
    BodyOptions options;
    options.edge = std::sqrt(low * high);
    options.order = order;
    options.contacts = {kPlace};
    options.tool_radius = kRadius;
    options.contact_size = std::min(0.001, 0.2 * options.edge);
    TetMesh mesh = make_body_mesh(surface, options);
    (mesh.tets.size() > tets ? low : high) = options.edge;
    const auto off = [&](const TetMesh& m) {
      return std::abs(static_cast<double>(m.tets.size()) - static_cast<double>(tets));
    };
    if (best.tets.empty() || off(mesh) < off(best)) best = std::move(mesh);
  }
  return best;
}

void write_ours(const fs::path& folder, const TetMesh& mesh) {
  std::ofstream body(folder / "body.ply");
  write_body_ply(body, mesh);
  std::ofstream(folder / "model.csv") << fmt::format(
      "effect,region,parameter,value,unit,state\nelastic,0,E,{},Pa,fixed\nelastic,0,nu,{},1,"
      "fixed\n",
      kModulus, kNu);
  std::ofstream(folder / "motion.csv")
      << fmt::format("# tool_radius: {}\npress,x,y,z,ux,uy,uz\n1,{},{},{},0,0,{}\n", kRadius,
                     kPlace.x(), kPlace.y(), kPlace.z(), -kDepth);
}

double our_force(const fs::path& file) {
  std::ifstream in(file);
  std::string line, last;
  while (std::getline(in, line))
    if (!line.empty()) last = line;
  return std::atof(last.substr(last.rfind(',') + 1).c_str());
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    fmt::print("bench_calculix BIN [runs [order]]\n");
    return 2;
  }
  const std::string tool = fs::absolute(fs::path(argv[1]) / "hs-simulate");
  const int runs = argc > 2 ? std::atoi(argv[2]) : 3;
  if (std::system("command -v ccx >/dev/null 2>&1") != 0) {
    fmt::print("SKIPPED: ccx is not installed; apt-get install calculix-ccx\n");
    return 0;
  }
  const fs::path folder = fs::temp_directory_path() / fmt::format("hs-bench-{}", getpid());
  fs::create_directory(folder);
  fmt::print("{:>8} {:>5} {:>6} {:<28} {:>8} {:>6} {:>10} {:>6}\n", "tets", "order", "patch",
             "program", "s", "MB", "force N", "ratio");
  for (const auto& body :
       {std::pair<std::size_t, int>{20000, 1}, {100000, 1}, {6000, 2}, {20000, 2}, {84000, 2}}) {
    const std::size_t tets = body.first;
    const int order = body.second;
    if (argc > 3 && std::atoi(argv[3]) != order) continue;
    const TetMesh mesh = pressed_block(tets, order);
    write_ours(folder, mesh);
    const std::vector<int> patch = patch_under_tool(mesh, kPlace, kRadius).nodes;
    const auto row = [&](const char* name, const bench::Run& r, double force, double ours) {
      fmt::print("{:>8} {:>5} {:>6} {:<28} {:>8.2f} {:>6.0f} {:>10.6f} {:>6.2f}{}\n",
                 mesh.tets.size(), order, patch.size(), name, r.seconds, r.megabytes, force,
                 r.seconds / ours, r.done ? "" : "  FAILED");
      std::fflush(stdout);
    };
    // Direct solutions of that many second-order elements take minutes and many GB.
    const bool large = order == 2 && tets > 50000;
    double ours = 0;
    for (const char* solver : {"by-size", "direct", "iterative"}) {
      if (large && std::string(solver) == "direct") continue;
      const bench::Run r =
          bench::run_whole(folder,
                           {tool, "motion.csv", "--body", "body.ply", "--model", "model.csv",
                            "--own-mesh", "--solver", solver, "-q", "-o", "forces.csv"},
                           runs);
      if (ours == 0) ours = r.seconds;
      row(fmt::format("hs-simulate {}", solver).c_str(), r, our_force(folder / "forces.csv"), ours);
    }
    for (const char* solver : {"SPOOLES", "ITERATIVE CHOLESKY", "ITERATIVE SCALING"}) {
      if (large && std::string(solver) == "SPOOLES") continue;
      bench::write_calculix(folder / "run.inp", mesh, patch, kModulus, kNu, {0, 0, -kDepth},
                            solver);
      const bool slow = order == 2 && tets > 10000 && std::string(solver) == "SPOOLES";
      const bench::Run r = bench::run_whole(folder, {"ccx", "-i", "run"}, slow ? 1 : runs);
      row(fmt::format("ccx {}", solver).c_str(), r, -bench::calculix_force(folder / "run.dat").z(),
          ours);
    }
  }
  fs::remove_all(folder);
}
