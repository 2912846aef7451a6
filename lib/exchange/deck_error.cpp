#include "exchange/deck_error.h"

#include <fmt/format.h>

#include <cmath>
#include <span>

#include "experiment/experiment.h"
#include "solid/mesh_press.h"

namespace hapsim {

double deck_error(const TetMesh& body, const Scene& scene, const Recording& recording, int row) {
  const auto i = static_cast<std::size_t>(row);
  Recording one;
  one.name = recording.name;
  one.metadata = recording.metadata;
  one.line = {0};
  one.press = {0};
  one.position = {recording.position[i]};
  one.u = {Vec3::Zero()};
  ExperimentOptions options;
  options.noise = 1;
  options.nu_low = options.nu_high = scene.nu;
  options.borrow = true;
  const Experiment graded = make_experiment(std::span(&body, 1), make_dataset(one), options);
  const PreparedContact& contact = graded.places.contact(0);
  Eigen::Matrix3d K, dK_dnu;
  contact.stiffness.evaluate(scene.nu, K, dK_dnu);
  const MeshPatch patch = patch_under_tool(body, one.position[0], recording.tool_radius());
  MeshPress own(body, {patch});
  const Eigen::Matrix3d own_K =
      own.solve(std::vector<Lame>(body.tets.size(), lame(1, scene.nu))).front().K;
  const Vec3& n = contact.normal;
  return n.dot(own_K * n) / n.dot(K * n) - 1;
}

std::string deck_words(const Scene& scene, double error) {
  constexpr double kCoarse = 0.05;
  const std::string nodes =
      fmt::format("{} node{} under the tool", scene.tool.size(), scene.tool.size() == 1 ? "" : "s");
  if (std::abs(error) < kCoarse)
    return fmt::format("{}: this mesh is {:.1f} % {} than the tool on a fine one", nodes,
                       100 * std::abs(error), error < 0 ? "softer" : "stiffer");
  return fmt::format(
      "warning: {}: this mesh is too coarse there, {:.0f} % {} than the tool on a fine one, "
      "whatever "
      "program solves it; mesh the body finer (hs-tetmesh --edge, a fourth of the tool's radius)",
      nodes, 100 * std::abs(error), error < 0 ? "softer" : "stiffer");
}

}  // namespace hapsim
