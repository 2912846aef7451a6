// The force on a pressed organ-like lump against the unknowns it takes: plain meshes refined about
// the tool of first and second order, CalculiX on those of second order, and the contact meshes of
// the models; against a contact mesh with half of every length. Error of the normal stiffness;
// seconds of the processor, mesh included (CalculiX: its whole run).
//
//   bench_convergence [SVG]
// Recorded in bench/results/convergence.txt (bench/record.sh).
#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "base/blas.h"
#include "calculix_input.h"
#include "contact/contact_stiffness.h"
#include "log_plot.h"
#include "solid/mesh_press.h"
#include "support/objects.h"
#include "tetmesh/body_mesh.h"
#include "whole_run.h"

namespace {

using namespace hapsim;
namespace fs = std::filesystem;

constexpr double kRadius = 0.004, kNu = 0.45;

struct Row {
  double unknowns = 0, stiffness = 0, seconds = 0;
};

// The models' own mesh with a given edge at the rim, of the radius.
Row contact_mesh(const ContactBase& base, const Vec3& place, double rim, double growth,
                 Vec3* normal) {
  const double start = bench::processor_seconds();
  const ContactMesh contact = make_contact_mesh(base, place, kRadius, rim * kRadius, growth);
  std::vector<int> handle(contact.mesh.nodes.size(), kFreeNode);
  for (std::size_t n = 0; n < handle.size(); ++n)
    if (contact.mesh.fixed[n]) handle[n] = kHeldNode;
  for (const int n : contact.patch_nodes) handle[n] = 0;
  ElasticBody body(contact.mesh, handle, Dilatation::kElement);
  body.factorise(std::vector<Lame>(contact.mesh.tets.size(), lame(1, kNu)));
  const Eigen::Matrix3d K = body.solve(Eigen::Matrix3d::Identity()).reaction;
  if (normal != nullptr) *normal = contact.normal;
  return {static_cast<double>(body.unknowns()), contact.normal.dot(K * contact.normal),
          bench::processor_seconds() - start};
}

TetMesh plain_mesh(const Surface& surface, const Vec3& place, double size, int order) {
  BodyOptions options;
  options.edge = 0.012;
  options.order = order;
  options.contacts = {place};
  options.tool_radius = kRadius;
  options.contact_size = size;
  return make_body_mesh(surface, options);
}

}  // namespace

int main(int argc, char** argv) {
  prepare_blas_for_many_threads();
  const Surface surface = test::lump(30);
  BodyOptions whole;
  whole.preserve_surface = true;
  const ContactBase base = make_contact_base(make_body_mesh(surface, whole));
  const Vec3 place = nearest_point(surface, Vec3(0.004, 0.006, 0.05)).point;
  Vec3 normal;
  const Row truth = contact_mesh(base, place, kRimEdge / 2, kGrowth / 2, &normal);
  fmt::print("{:.0f} unknowns of the reference, {:.6g} m\n{:<26} {:>9} {:>8} {:>8}\n",
             truth.unknowns, truth.stiffness, "mesh", "unknowns", "error", "s");
  bench::LogPlot plot("Error of a pressed organ's force [%]", "unknowns");
  const auto add = [&](const char* name, bench::LogPlot::Points& line, const Row& row) {
    const double error = 100 * std::abs(row.stiffness / truth.stiffness - 1);
    fmt::print("{:<26} {:>9.0f} {:>+7.2f}% {:>8.2f}\n", name, row.unknowns,
               100 * (row.stiffness / truth.stiffness - 1), row.seconds);
    std::fflush(stdout);
    line.emplace_back(row.unknowns, std::max(error, 0.01));
  };
  const fs::path folder = fs::temp_directory_path() / fmt::format("hs-bench-{}", getpid());
  fs::create_directory(folder);
  const bool calculix = std::system("command -v ccx >/dev/null 2>&1") == 0;
  auto& first = plot.line("first order");
  auto& second = plot.line("second order");
  auto& theirs = plot.line("CalculiX, second");
  auto& ours = plot.line("contact meshes");
  for (const int order : {1, 2})
    for (const double size : {0.003, 0.002, 0.0014, 0.001, 0.0007, 0.0005}) {
      const double start = bench::processor_seconds();
      const TetMesh mesh = plain_mesh(surface, place, size, order);
      MeshPress press(mesh, {patch_under_tool(mesh, place, kRadius)});
      const Eigen::Matrix3d K = press.solve(std::vector<Lame>(mesh.tets.size(), lame(1, kNu)))[0].K;
      double free = 0;
      for (const auto fixed : mesh.fixed) free += fixed ? 0 : 3;
      add(order == 1 ? "plain, first order" : "plain, second order", order == 1 ? first : second,
          {free, normal.dot(K * normal), bench::processor_seconds() - start});
      if (order == 1 || !calculix || free > 80000) continue;
      bench::write_calculix(folder / "run.inp", mesh, press.patches()[0].nodes, 1, kNu, normal,
                            "ITERATIVE CHOLESKY");
      const bench::Run run = bench::run_whole(folder, {"ccx", "-i", "run"}, 1);
      const Vec3 force = bench::calculix_force(folder / "run.dat");
      add("CalculiX, second order", theirs, {free, normal.dot(force), run.seconds});
    }
  for (const double finer : {0.5, 0.67, 1.0, 1.33})
    add("contact mesh", ours,
        contact_mesh(base, place, kRimEdge / finer, std::min(kGrowth / finer, 0.8), nullptr));
  fs::remove_all(folder);
  if (argc < 2) return 0;
  std::ofstream out(argv[1]);
  plot.write(out);
}
