// pressing BODY MODEL X Y Z RADIUS DEPTH: the force of a body [N] on a flat tool that goes down by
// DEPTH at the point X Y Z of its surface [m], at ten depths.
#include <cstdio>
#include <cstdlib>

#include "base/error.h"
#include "experiment/experiment.h"
#include "experiment/forces.h"
#include "formats/tetmesh_io.h"
#include "mesh/tetmesh.h"

using namespace hapsim;

int main(int argc, char** argv) try {
  if (argc != 8) fail_usage("seven arguments are needed", "BODY MODEL X Y Z RADIUS DEPTH");
  Input body_file(argv[1]), model_file(argv[2]);
  const TetMesh body = read_body(body_file);
  const Model model = read_model(model_file);

  Recording motion;
  motion.name = "the press";
  motion.metadata.set("tool_radius", argv[6]);
  for (int i = 1; i <= 10; ++i) {
    motion.line.push_back(i);
    motion.press.push_back(1);
    motion.position.emplace_back(std::atof(argv[3]), std::atof(argv[4]), std::atof(argv[5]));
    motion.u.emplace_back(0, 0, -0.1 * i * std::atof(argv[7]));
  }
  ExperimentOptions options;
  options.noise = 1;  // there are no measured forces that could tell it
  set_poisson_range(model, options);
  const Experiment w = make_experiment(body, motion, options);
  const Signal force = solved_forces(model, w, all_episodes(w.dataset), false);
  for (int i = 0; i < 10; ++i)
    std::printf("%.6f %.6f %.6f %.6f\n", -motion.u[i].z(), force.f[3 * i], force.f[3 * i + 1],
                force.f[3 * i + 2]);
  return 0;
} catch (const Error& error) {
  std::fprintf(stderr, "pressing: %s\n", error.what());
  return static_cast<int>(error.code());
}
