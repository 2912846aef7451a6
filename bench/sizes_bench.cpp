// What the size of a body costs, each beside CHOLMOD by itself on the same matrix in the same run.
// Seconds are of the processor, one thread; each body in a process of its own, whose largest memory
// is told.
//
//   bench_sizes [first|batch|surfaces]   tables up to 100,000 tetrahedra (minutes, 5 GB)
//   bench_sizes growth [SVG]             time and memory from 1,000 to 1,000,000 tetrahedra,
//   plotted
// Recorded in bench/results/sizes*.txt (bench/record.sh).
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "bare_cholmod.h"
#include "base/blas.h"
#include "log_plot.h"
#include "solid/elastic_assembly.h"
#include "solid/mesh_press.h"
#include "solid/surface_compliance.h"
#include "support/block_mesh.h"
#include "whole_run.h"

namespace {

using namespace hapsim;
using bench::BareTimes;
using bench::processor_seconds;

constexpr double kRadius = 0.004;
const Vec3 kSize(0.12, 0.21, 0.06);

TetMesh block(const std::array<int, 3>& n) {
  return test::block_mesh(kSize, n[0], n[1], n[2], 1, 0.2);
}

std::vector<Lame> constants(const TetMesh& mesh) {
  return std::vector<Lame>(mesh.tets.size(), lame(1e4, 0.45));
}

// In a child, so that its memory is its own; what it gives is copied back. Largest memory [MB].
template <class Result>
double in_child(const std::function<Result()>& work, Result& result) {
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) return 0;
  std::fflush(stdout);
  const pid_t child = fork();
  if (child == 0) {
    prepare_blas_for_many_threads();
    const Result r = work();
    _exit(write(ends[1], &r, sizeof r) == static_cast<ssize_t>(sizeof r) ? 0 : 1);
  }
  close(ends[1]);
  const bool whole = read(ends[0], &result, sizeof result) == static_cast<ssize_t>(sizeof result);
  close(ends[0]);
  int status = 0;
  rusage used{};
  wait4(child, &status, 0, &used);
  if (!whole) fmt::print("(the process ended with status {})\n", status);
  return static_cast<double>(used.ru_maxrss) / 1024;
}

// All surface compliances: ours with assembly, and the bare factorisation with its inverse.
struct Surface2 {
  std::size_t tets = 0, kept = 0;
  double analyse = 0, ours = 0, difference = 0;
  BareTimes bare;
};

Surface2 all_compliances(const std::array<int, 3>& n) {
  const TetMesh mesh = block(n);
  Surface2 r;
  r.tets = mesh.tets.size();
  double start = processor_seconds();
  SurfaceCompliance surface(mesh);
  r.analyse = processor_seconds() - start;
  start = processor_seconds();
  surface.factorise(constants(mesh));
  r.ours = processor_seconds() - start;
  std::vector<char> kept;
  for (std::size_t node = 0; node < mesh.nodes.size(); ++node)
    if (!mesh.fixed[node])
      kept.insert(kept.end(), 3, surface.index_of(static_cast<int>(node)) >= 0 ? 1 : 0);
  const Eigen::MatrixXd mine = surface.matrix();
  r.kept = static_cast<std::size_t>(mine.rows());
  Eigen::MatrixXd inverse;
  r.bare = bench::bare_schur_inverse(surface.stiffness(), kept, inverse);
  for (Eigen::Index c = 0; c < mine.cols(); c += 97)
    r.difference = std::max(
        r.difference, (mine.col(c) - inverse.col(c)).tail(mine.rows() - c).cwiseAbs().maxCoeff());
  r.difference /= mine.cwiseAbs().maxCoeff();
  return r;
}

void surfaces() {
  fmt::print(
      "\nall surface nodes condensed [s]: assembly, factorisation and dense inverse, beside "
      "CHOLMOD's factorisation with the surface last and LAPACK's inverse\n"
      "{:>8} {:>9} {:>9} {:>9} {:>12} {:>10} {:>9} {:>6} {:>6} {:>10}\n",
      "tets", "unknowns", "analyse", "condense", "bare analyse", "factorise", "+ inverse", "ratio",
      "MB", "difference");
  for (const auto& n : {std::array{14, 24, 10}, std::array{24, 42, 16}}) {
    Surface2 r;
    const double mb = in_child<Surface2>([&] { return all_compliances(n); }, r);
    const double bare = r.bare.factorise + r.bare.invert;
    fmt::print(
        "{:>8} {:>9} {:>9.3f} {:>9.2f} {:>12.3f} {:>10.2f} {:>9.2f} {:>6.2f} {:>6.0f} "
        "{:>10.1e}\n",
        r.tets, r.kept, r.analyse, r.ours, r.bare.analyse, r.bare.factorise, bare, r.ours / bare,
        mb, r.difference);
  }
}

// The first force: pattern, assembly, and the solution under the tool's patch.
struct First {
  std::size_t tets = 0;
  int unknowns = 0;
  double ready = 0, solved = 0, stiffness = 0;
  BareTimes bare;
};

First first_force(const std::array<int, 3>& n, SolverKind kind, bool beside) {
  const TetMesh mesh = block(n);
  First r;
  r.tets = mesh.tets.size();
  const double start = processor_seconds();
  const MeshPatch patch =
      patch_under_tool(mesh, {0.5 * kSize.x(), 0.5 * kSize.y(), kSize.z()}, kRadius);
  MeshPress press(mesh, {patch}, kind);
  r.ready = processor_seconds() - start;
  const auto solution = press.solve(constants(mesh));
  r.solved = processor_seconds() - start;
  r.stiffness = patch.normal.dot(solution[0].K * patch.normal);
  std::vector<char> free;
  for (std::size_t node = 0; node < mesh.nodes.size(); ++node) free.push_back(!mesh.fixed[node]);
  for (const int node : patch.nodes) free[static_cast<std::size_t>(node)] = 0;
  NodeSystem system(std::move(free), element_cliques(mesh));
  r.unknowns = system.unknowns();
  if (!beside) return r;
  assemble_elastic(system, mesh, constants(mesh), Dilatation::kPointwise);
  Eigen::MatrixXd b = Eigen::MatrixXd::Zero(r.unknowns, 3), x;
  for (int k = 0; k < 3; ++k) b(r.unknowns / 2 + k, k) = 1;
  r.bare = bench::bare_first_force(system.matrix(), b, x);
  return r;
}

void first_forces() {
  fmt::print(
      "\ntime to the first force [s]: everything from the mesh on, beside CHOLMOD's analysis, "
      "factorisation and three solutions of the assembled matrix\n"
      "{:>8} {:>9} {:>10} {:>7} {:>6} {:>9} {:>10} {:>7} {:>7} {:>6}\n",
      "tets", "unknowns", "solver", "ours", "MB", "analyse", "factorise", "solve", "bare", "ratio");
  for (const auto& n : {std::array{14, 24, 10}, std::array{24, 42, 16}})
    for (const SolverKind kind : {SolverKind::kDirect, SolverKind::kIterative}) {
      First r;
      const double mb = in_child<First>([&] { return first_force(n, kind, true); }, r);
      const double bare = r.bare.analyse + r.bare.factorise + r.bare.solve;
      fmt::print(
          "{:>8} {:>9} {:>10} {:>7.2f} {:>6.0f} {:>9.3f} {:>10.2f} {:>7.3f} {:>7.2f} "
          "{:>6.2f}\n",
          r.tets, r.unknowns, kind == SolverKind::kDirect ? "direct" : "iterative", r.solved, mb,
          r.bare.analyse, r.bare.factorise, r.bare.solve, bare, r.solved / bare);
    }
}

// Twenty positions by batched right-hand sides of one factorisation, beside one position.
struct Batch {
  double one = 0, all = 0, difference = 0;
  std::size_t tets = 0, columns = 0;
};

Batch batched(const std::array<int, 3>& n) {
  const TetMesh mesh = block(n);
  std::vector<MeshPatch> patches;
  for (int i = 0; i < 20; ++i)
    patches.push_back(patch_under_tool(
        mesh, {0.02 + 0.02 * (i % 5), 0.03 + 0.05 * (i / 5), kSize.z()}, 2 * kRadius));
  Batch r;
  r.tets = mesh.tets.size();
  for (const MeshPatch& p : patches) r.columns += 3 * p.nodes.size();
  double start = processor_seconds();
  MeshPress single(mesh, {patches[7]}, SolverKind::kDirect);
  const auto one = single.solve(constants(mesh));
  r.one = processor_seconds() - start;
  start = processor_seconds();
  MeshPress together(mesh, patches, SolverKind::kDirect);
  const auto all = together.solve(constants(mesh));
  r.all = processor_seconds() - start;
  r.difference = (one[0].K - all[7].K).norm() / one[0].K.norm();
  return r;
}

void batches() {
  fmt::print(
      "\n20 positions from one factorisation [s], beside one position\n"
      "{:>8} {:>8} {:>8} {:>8} {:>6} {:>10}\n",
      "tets", "columns", "one", "20", "ratio", "difference");
  for (const auto& n : {std::array{6, 10, 4}, std::array{14, 24, 10}, std::array{24, 42, 16}}) {
    Batch r;
    in_child<Batch>([&] { return batched(n); }, r);
    fmt::print("{:>8} {:>8} {:>8.3f} {:>8.3f} {:>6.2f} {:>10.1e}\n", r.tets, r.columns, r.one,
               r.all, r.all / r.one, r.difference);
  }
}

void growth(const char* svg) {
  constexpr double kMostDirect = 400000;
  fmt::print(
      "\ngrowth: time to the first force [s] and largest memory [MB]; direct up to {} "
      "tetrahedra\n{:>8} {:>9} {:>10} {:>9} {:>8} {:>12}\n",
      kMostDirect, "tets", "unknowns", "solver", "s", "MB", "stiffness");
  bench::LogPlot plot("Time and memory to the first force", "tetrahedra");
  auto &direct_s = plot.line("direct [s]"), &iterative_s = plot.line("iterative [s]");
  auto &direct_mb = plot.line("direct [GB]"), &iterative_mb = plot.line("iterative [GB]");
  for (const auto& n :
       {std::array{5, 9, 4}, std::array{8, 14, 5}, std::array{11, 19, 8}, std::array{16, 28, 11},
        std::array{24, 42, 16}, std::array{35, 61, 24}, std::array{52, 91, 36}})
    for (const SolverKind kind : {SolverKind::kDirect, SolverKind::kIterative}) {
      const bool direct = kind == SolverKind::kDirect;
      if (direct && 6.0 * n[0] * n[1] * n[2] > kMostDirect) continue;
      First r;
      const double mb = in_child<First>([&] { return first_force(n, kind, false); }, r);
      fmt::print("{:>8} {:>9} {:>10} {:>9.3f} {:>8.0f} {:>12.6g}\n", r.tets, r.unknowns,
                 direct ? "direct" : "iterative", r.solved, mb, r.stiffness);
      const auto tets = static_cast<double>(r.tets);
      (direct ? direct_s : iterative_s).emplace_back(tets, r.solved);
      (direct ? direct_mb : iterative_mb).emplace_back(tets, mb / 1024);
    }
  if (svg == nullptr) return;
  std::ofstream out(svg);
  plot.write(out);
}

}  // namespace

int main(int argc, char** argv) {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  fmt::print("{}\n", blas_name());
  const std::string table = argc > 1 ? argv[1] : "";
  if (table == "growth") {
    growth(argc > 2 ? argv[2] : nullptr);
    return 0;
  }
  if (table.empty() || table == "first") first_forces();
  if (table.empty() || table == "batch") batches();
  if (table.empty() || table == "surfaces") surfaces();
}
