// What a contact position costs: a mesh, and one solution of its stiffness on both of them.
#include <benchmark/benchmark.h>

#include "base/blas.h"
#include "contact/contact_stiffness.h"
#include "support/block_mesh.h"

namespace {

const hapsim::ContactBase& block() {
  static const hapsim::ContactBase base =
      hapsim::make_contact_base(hapsim::test::block_mesh({0.1, 0.1, 0.06}, 8, 8, 6, 1));
  return base;
}

void mesh(benchmark::State& state) {
  for (auto _ : state)
    benchmark::DoNotOptimize(hapsim::make_contact_mesh(block(), {0.05, 0.05, 0.06}, 0.004,
                                                       0.004 / static_cast<double>(state.range(0)),
                                                       2.4 / static_cast<double>(state.range(0))));
}
BENCHMARK(mesh)->Arg(4)->Arg(6)->Unit(benchmark::kMillisecond);

void stiffness(benchmark::State& state) {
  const hapsim::PlanGrid grid = hapsim::plan_grid(block().surface);
  hapsim::ContactBodies bodies(block(), {0.05, 0.05, 0.06}, 0.004);
  bodies.solve({0.4, {1.0}, nullptr}, grid);  // the meshes are made here
  for (auto _ : state) benchmark::DoNotOptimize(bodies.solve({0.4, {1.0}, nullptr}, grid));
}
BENCHMARK(stiffness)->Unit(benchmark::kMillisecond);

}  // namespace

int main(int argc, char** argv) {
  benchmark::AddCustomContext("blas", hapsim::blas_name());
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
