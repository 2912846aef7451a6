#include "exchange/deck_error.h"

#include <fmt/format.h>

#include <cmath>
#include <memory>

#include "base/error.h"
#include "experiment/forces.h"
#include "experiment/linearisation.h"
#include "solid/elastic_body.h"

namespace hapsim {
namespace {

// Of a press in the air: none, and the tool's way is into the surface.
Vec3 deepest(const Recording& r, const Press& press) {
  Vec3 most = Vec3::Zero();
  for (const int row : press.rows) {
    const auto i = static_cast<std::size_t>(row);
    if (!r.in_air(i) && r.u[i].norm() > most.norm()) most = r.u[i];
  }
  return most;
}

}  // namespace

std::vector<GradedPress> graded_presses(const TetMesh& body, const Model& model,
                                        const Recording& recording,
                                        const std::vector<Press>& presses,
                                        const PrepareOptions& options) {
  const MaterialSpec material = material_of(model);
  ContactLibraryOptions library;
  library.threads = options.threads;
  library.cache = options.cache;
  std::vector<Vec3> positions;
  for (const Press& press : presses)
    positions.push_back(recording.position[static_cast<std::size_t>(press.rows.front())]);
  auto places = SetupPlaces::prepare(
      std::make_shared<const ContactLibrary>(body, recording.tool_radius(), library), positions,
      material.nu, material.nu);
  if (const std::string& unfit = places->contacts().front().unfit; !unfit.empty())
    throw Error(ExitCode::kBadInput, recording.name, unfit, "");
  std::vector<std::size_t> fit;
  for (std::size_t p = 0; p < positions.size(); ++p)
    if (places->contacts()[p].unfit.empty()) fit.push_back(p);
  places = places->chosen(fit);
  const SetupLinearisation solved = SetupLinearisation::solve(places, material);
  std::vector<GradedPress> graded;
  for (std::size_t k = 0; k < fit.size(); ++k) {
    GradedPress& g = graded.emplace_back();
    g.id = presses[fit[k]].id;
    g.place = positions[fit[k]];
    g.u = deepest(recording, presses[fit[k]]);
    if (g.u.isZero()) g.u = -places->contacts()[k].normal;
    g.K = solved.at(k, material).K;
  }
  return graded;
}

Eigen::Matrix3d deck_stiffness(const Scene& scene) {
  std::vector<int> handle(scene.mesh.nodes.size(), kFreeNode);
  for (std::size_t n = 0; n < handle.size(); ++n)
    if (scene.mesh.fixed[n]) handle[n] = kHeldNode;
  for (const int n : scene.tool) handle[static_cast<std::size_t>(n)] = 0;
  ElasticBody body(scene.mesh, handle, Dilatation::kPointwise);
  std::vector<Lame> constants;
  for (const int region : scene.mesh.region)
    constants.push_back(lame(scene.modulus_of(region), scene.nu));
  body.factorise(constants);
  return body.solve(Eigen::Matrix3d::Identity()).reaction;
}

double deck_error(const Eigen::Matrix3d& K_deck, const GradedPress& press) {
  const Vec3 ours = press.K * press.u, theirs = K_deck * press.u;
  return std::copysign((theirs - ours).norm() / ours.norm(), theirs.norm() - ours.norm());
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
      "program solves it; add --match, or mesh the body finer (hs-tetmesh --edge, a fourth of the "
      "tool's radius)",
      nodes, 100 * std::abs(error), error < 0 ? "softer" : "stiffer");
}

}  // namespace hapsim
