// The same static problem, a block pressed 3 mm by a bonded flat tool, as whole runs of CalculiX
// (Debian calculix-ccx) with its direct and its iterative solvers and of hs-simulate --own-mesh:
// reading the mesh, solving, writing the force. Seconds of the processor (the least of the runs),
// largest memory, the tool's normal force, and how many times faster hs-simulate is.
//
//   bench_calculix BIN [runs]
//
// BIN is the folder of hs-simulate. CalculiX's second-order elements have no mean dilatation, so
// the forces of second order differ a little; those of first order are the same.
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
#include <sstream>
#include <string>
#include <vector>

#include "fem/mesh_press.h"
#include "geometry/body_mesh.h"
#include "support/block_mesh.h"

namespace {

using namespace hapsim;
namespace fs = std::filesystem;

constexpr double kRadius = 0.004, kDepth = 0.003, kModulus = 1e4, kNu = 0.3;
const Vec3 kPlace(0.06, 0.105, 0.06);

struct Run {
  double seconds = 1e300, megabytes = 0;
  bool done = false;
};

// In `folder`; the least of `runs`.
Run run(const fs::path& folder, const std::vector<std::string>& command, int runs) {
  Run best;
  for (int i = 0; i < runs; ++i) {
    const pid_t child = fork();
    if (child == 0) {
      const int nowhere = open("/dev/null", O_WRONLY);
      dup2(nowhere, STDOUT_FILENO);
      dup2(nowhere, STDERR_FILENO);
      if (chdir(folder.c_str()) != 0) _exit(126);
      setenv("OMP_NUM_THREADS", "1", 1);
      std::vector<char*> words;
      for (const std::string& word : command) words.push_back(const_cast<char*>(word.c_str()));
      words.push_back(nullptr);
      execvp(words[0], words.data());
      _exit(127);
    }
    int status = 0;
    rusage used{};
    wait4(child, &status, 0, &used);
    double seconds = 0;
    for (const timeval& t : {used.ru_utime, used.ru_stime})
      seconds += static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
    best.done = WIFEXITED(status) && WEXITSTATUS(status) == 0;
    best.seconds = std::min(best.seconds, seconds);
    best.megabytes = std::max(best.megabytes, static_cast<double>(used.ru_maxrss) / 1024);
  }
  return best;
}

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

void write_calculix(const fs::path& folder, const std::string& name, const TetMesh& mesh,
                    const std::vector<int>& patch, const std::string& solver) {
  std::ofstream out(folder / (name + ".inp"));
  out << "*NODE, NSET=NALL\n";
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n)
    out << fmt::format("{},{:.12e},{:.12e},{:.12e}\n", n + 1, mesh.nodes[n].x(), mesh.nodes[n].y(),
                       mesh.nodes[n].z());
  out << "*ELEMENT, ELSET=EALL, TYPE=" << (mesh.order == 1 ? "C3D4" : "C3D10") << "\n";
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    out << t + 1;
    for (int a = 0; a < (mesh.order == 1 ? 4 : 10); ++a) out << "," << mesh.tets[t][a] + 1;
    out << "\n";
  }
  out << "*NSET, NSET=PATCH\n";
  for (const int n : patch) out << n + 1 << "\n";
  out << "*NSET, NSET=HELD\n";
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n)
    if (mesh.fixed[n]) out << n + 1 << "\n";
  out << fmt::format(
      "*MATERIAL, NAME=M\n*ELASTIC\n{},{}\n*SOLID SECTION, ELSET=EALL, MATERIAL=M\n*STEP\n"
      "*STATIC, SOLVER={}\n*BOUNDARY\nHELD,1,3\nPATCH,1,2\nPATCH,3,3,{}\n"
      "*NODE PRINT, NSET=PATCH, TOTALS=ONLY\nRF\n*END STEP\n",
      kModulus, kNu, solver, -kDepth);
}

double calculix_force(const fs::path& file) {
  std::ifstream in(file);
  double force = NAN;
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    double x = 0, y = 0, z = 0;
    if (words >> x >> y >> z) force = -z;
  }
  return force;
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
    fmt::print("bench_calculix BIN [runs]\n");
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
  for (const auto& [tets, order] :
       {std::pair<std::size_t, int>{20000, 1}, {100000, 1}, {6000, 2}, {20000, 2}}) {
    const TetMesh mesh = pressed_block(tets, order);
    write_ours(folder, mesh);
    const std::vector<int> patch = patch_under_tool(mesh, kPlace, kRadius).nodes;
    const auto row = [&](const char* name, const Run& r, double force, double ours) {
      fmt::print("{:>8} {:>5} {:>6} {:<28} {:>8.2f} {:>6.0f} {:>10.6f} {:>6.2f}{}\n",
                 mesh.tets.size(), order, patch.size(), name, r.seconds, r.megabytes, force,
                 r.seconds / ours, r.done ? "" : "  FAILED");
      std::fflush(stdout);
    };
    double ours = 0;
    for (const char* solver : {"by-size", "direct", "iterative"}) {
      const Run r = run(folder,
                        {tool, "motion.csv", "--body", "body.ply", "--model", "model.csv",
                         "--own-mesh", "--solver", solver, "-q", "-o", "forces.csv"},
                        runs);
      if (ours == 0) ours = r.seconds;
      row(fmt::format("hs-simulate {}", solver).c_str(), r, our_force(folder / "forces.csv"), ours);
    }
    for (const char* solver : {"SPOOLES", "ITERATIVE CHOLESKY", "ITERATIVE SCALING"}) {
      write_calculix(folder, "run", mesh, patch, solver);
      const bool slow = order == 2 && tets > 10000 && std::string(solver) == "SPOOLES";
      const Run r = run(folder, {"ccx", "-i", "run"}, slow ? 1 : runs);
      row(fmt::format("ccx {}", solver).c_str(), r, calculix_force(folder / "run.dat"), ours);
    }
  }
  fs::remove_all(folder);
}
