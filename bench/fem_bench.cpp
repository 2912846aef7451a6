// What a force costs at finite strain: a body of the size of a scanned heart (528 nodes, 1764
// first-order tetrahedra), and a graded second-order mesh of one contact.
// Recorded in bench/results/fem.txt (bench/record.sh).
#include <benchmark/benchmark.h>

#include "base/blas.h"
#include "contact/contact_stiffness.h"
#include "material/hyperelastic_law.h"
#include "nonlinear/nonlinear_body.h"
#include "solid/elastic_body.h"
#include "support/block_mesh.h"

namespace {

using hapsim::Dilatation;
using hapsim::Vec3;

struct Pressed {
  hapsim::TetMesh mesh;
  std::vector<int> handle;
  Vec3 normal = Vec3::UnitZ();

  static Pressed heart() {
    Pressed p;
    const Vec3 size(0.06, 0.1, 0.08);
    p.mesh = hapsim::test::block_mesh(size, 6, 7, 7, 1, 0.2);
    p.handle.assign(p.mesh.nodes.size(), hapsim::kFreeNode);
    for (std::size_t n = 0; n < p.handle.size(); ++n) {
      const Vec3& x = p.mesh.nodes[n];
      if (p.mesh.fixed[n]) p.handle[n] = hapsim::kHeldNode;
      if (x.z() == size.z() && (x - Vec3(0.03, 0.05, 0.08)).norm() < 0.02) p.handle[n] = 0;
    }
    return p;
  }
  static Pressed contact() {
    Pressed p;
    const auto base =
        hapsim::make_contact_base(hapsim::test::block_mesh({0.1, 0.1, 0.06}, 8, 8, 6, 1));
    const auto contact = hapsim::make_contact_mesh(base, {0.05, 0.05, 0.06}, 0.004, 0.001, 0.6);
    p.mesh = contact.mesh;
    p.normal = contact.normal;
    p.handle.assign(p.mesh.nodes.size(), hapsim::kFreeNode);
    for (std::size_t n = 0; n < p.handle.size(); ++n)
      if (p.mesh.fixed[n]) p.handle[n] = hapsim::kHeldNode;
    for (const int n : contact.patch_nodes) p.handle[n] = 0;
    return p;
  }
};

// One step of 0.5 mm deeper along a press of 5 mm, and back: a press as a simulation runs it.
void press(benchmark::State& state, const Pressed& p, const hapsim::LawPointer& law,
           Dilatation dilatation, double step) {
  hapsim::BodyModel model{&p.mesh, {law}};
  model.dilatation = dilatation;
  hapsim::NonlinearBody body(model, p.handle);
  int k = 0, newton = 0;
  for (auto _ : state) {
    const int depth = k % 20 < 10 ? k % 20 + 1 : 20 - k % 20 - 1;
    const auto report = body.solve(-step * depth * p.normal, {1e-6});
    if (!report.ok()) state.SkipWithError(report.message.c_str());
    newton += report.newton_steps;
    ++k;
  }
  state.counters["newton"] = benchmark::Counter(newton, benchmark::Counter::kAvgIterations);
  state.counters["tets"] = static_cast<double>(p.mesh.tets.size());
  state.counters["unknowns"] = body.unknowns();
}

const hapsim::LawPointer kNeoHooke = hapsim::neo_hookean_law(4e3, 4e4);
const hapsim::LawPointer kExponential = hapsim::exponential_law(4e3, 2, 4e4);

void neo_hooke(benchmark::State& s) {
  press(s, Pressed::heart(), kNeoHooke, Dilatation::kPointwise, 5e-4);
}
void exponential(benchmark::State& s) {
  press(s, Pressed::heart(), kExponential, Dilatation::kPointwise, 5e-4);
}
void neo_hooke_patches(benchmark::State& s) {
  press(s, Pressed::heart(), kNeoHooke, Dilatation::kPatch, 5e-4);
}
void neo_hooke_contact(benchmark::State& s) {
  press(s, Pressed::contact(), kNeoHooke, Dilatation::kElement, 2e-4);
}
BENCHMARK(neo_hooke)->Unit(benchmark::kMillisecond);
BENCHMARK(exponential)->Unit(benchmark::kMillisecond);
BENCHMARK(neo_hooke_patches)->Unit(benchmark::kMillisecond);
BENCHMARK(neo_hooke_contact)->Unit(benchmark::kMillisecond);

}  // namespace

int main(int argc, char** argv) {
  benchmark::AddCustomContext("blas", hapsim::blas_name());
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
