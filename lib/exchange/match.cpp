#include "exchange/match.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "contact/contact_stiffness.h"
#include "experiment/forces.h"
#include "experiment/labels.h"
#include "tetmesh/contact_mesh.h"

namespace hapsim {
namespace {

// Places nearer than this are one: of both the factor would learn, and be tested by, the same.
constexpr double kApartRadii = 2;

// Further presses, each the farthest from those before it: they spread over the body.
std::vector<Press> spread(const Recording& recording, const Press& first, std::size_t count) {
  const auto at = [&](const Press& p) {
    return recording.position[static_cast<std::size_t>(p.rows.front())];
  };
  const std::vector<Press> all = recording.presses();
  std::vector<Press> chosen{first};
  std::vector<double> distance(all.size());
  for (std::size_t k = 0; k < all.size(); ++k) distance[k] = (at(all[k]) - at(first)).norm();
  while (chosen.size() < count) {
    const auto farthest = std::max_element(distance.begin(), distance.end());
    if (*farthest < kApartRadii * recording.tool_radius()) break;
    chosen.push_back(all[static_cast<std::size_t>(farthest - distance.begin())]);
    for (std::size_t k = 0; k < all.size(); ++k)
      distance[k] = std::min(distance[k], (at(all[k]) - at(chosen.back())).norm());
  }
  return chosen;
}

// Middles back on the middles of their edges, as every program's rule of four points has them: at
// the quarter points it integrates a softer element than ours.
void straighten(TetMesh& mesh) {
  for (const auto& tet : mesh.tets)
    for (int e = 0; e < 6; ++e)
      mesh.nodes[tet[4 + e]] =
          0.5 * (mesh.nodes[tet[kTetEdges[e][0]]] + mesh.nodes[tet[kTetEdges[e][1]]]);
}

// Corners alone; `tool` are nodes of it before and after.
void to_first_order(TetMesh& mesh, std::vector<int>& tool) {
  std::vector<int> number(mesh.nodes.size(), -1);
  for (const auto& tet : mesh.tets)
    for (int k = 0; k < 4; ++k) number[tet[k]] = 0;
  int count = 0;
  for (std::size_t n = 0; n < number.size(); ++n) {
    if (number[n] < 0) continue;
    number[n] = count;
    mesh.nodes[count] = mesh.nodes[n];
    mesh.fixed[count++] = mesh.fixed[n];
  }
  mesh.nodes.resize(count);
  mesh.fixed.resize(count);
  for (auto& tet : mesh.tets)
    for (int k = 0; k < 10; ++k) tet[k] = k < 4 ? number[tet[k]] : -1;
  for (Triangle& f : mesh.faces)
    for (int k = 0; k < 3; ++k) f[k] = number[f[k]];
  mesh.order = 1;
  std::vector<int> corners;
  for (const int n : tool)
    if (number[n] >= 0) corners.push_back(number[n]);
  tool = corners;
}

// The scene pressed at another place, on the mesh graded for that.
Scene pressed_at(const Scene& like, const ContactBase& base, const MaterialSpec& material,
                 const BodyRegions* labels, const Vec3& place, double radius, int order) {
  ContactMesh contact = make_contact_mesh(base, place, radius, kRimEdge * radius, kGrowth);
  Scene scene;
  scene.mesh = std::move(contact.mesh);
  scene.tool = std::move(contact.patch_nodes);
  scene.modulus = like.modulus;
  scene.nu = like.nu;
  straighten(scene.mesh);
  if (order == 1) to_first_order(scene.mesh, scene.tool);
  std::sort(scene.tool.begin(), scene.tool.end());
  scene.mesh.region = regions_of(scene.mesh, material, labels);
  return scene;
}

}  // namespace

double Match::largest_unseen() const {
  double largest = 0;
  for (const MatchedPress& p : presses)
    if (!p.learned) largest = std::max(largest, std::abs(p.error));
  return largest;
}

std::size_t Match::learned() const {
  return static_cast<std::size_t>(
      std::count_if(presses.begin(), presses.end(), [](const auto& p) { return p.learned; }));
}

Match match_scene(Scene& scene, const TetMesh& body, const Model& model, const Recording& recording,
                  const Press& press, const MatchOptions& options) {
  const std::vector<GradedPress> graded = graded_presses(
      body, model, recording, spread(recording, press, options.places), options.prepare);
  Match match;
  match.before = deck_error(deck_stiffness(scene), graded[0]);
  const MaterialSpec material = material_of(model);
  const auto labels = acting_labels(material, body);
  const ContactBase base = make_contact_base(body);
  std::vector<Eigen::Matrix3d> K(graded.size());
  Scene own;
  in_parallel(graded.size(), options.prepare.threads, [&](std::size_t p) {
    Scene there = pressed_at(scene, base, material, labels.get(), graded[p].place,
                             recording.tool_radius(), options.order);
    K[p] = deck_stiffness(there);
    if (p == 0) own = std::move(there);
  });
  // min over c of sum |c f - g|^2 / |g|^2 with f of the deck and g of hapsim.
  double above = 0, below = 0;
  for (std::size_t p = 0; p < graded.size(); ++p) {
    match.presses.push_back({graded[p].id, graded.size() == 1 || p % 2 == 1, 0});
    if (!match.presses.back().learned) continue;
    const Vec3 f = K[p] * graded[p].u, g = graded[p].K * graded[p].u;
    above += f.dot(g) / g.squaredNorm();
    below += f.squaredNorm() / g.squaredNorm();
  }
  match.factor = above / below;
  for (std::size_t p = 0; p < graded.size(); ++p)
    match.presses[p].error = deck_error(match.factor * K[p], graded[p]);
  scene.mesh = std::move(own.mesh);
  scene.tool = std::move(own.tool);
  for (double& E : scene.modulus) E *= match.factor;
  return match;
}

std::string match_words(const Match& match) {
  const auto percent = [](double error) { return fmt::format("{:.1f} %", 100 * std::abs(error)); };
  std::string words = fmt::format("its force is within {} of hapsim's at this press",
                                  percent(match.presses[0].error));
  const std::size_t learned = match.learned(), unseen = match.presses.size() - learned;
  if (unseen > 1)
    words += fmt::format(" and {} at {} other{} held out", percent(match.largest_unseen()),
                         unseen - 1, unseen == 2 ? "" : "s");
  words += fmt::format("; the moduli are {:.4f} times the model's, learned ", match.factor);
  words += unseen == 0 ? "here, for the recording has no other place"
                       : fmt::format("at {} other{}", learned, learned == 1 ? "" : "s");
  return words + fmt::format("; unmatched it were {} off, too {}", percent(match.before),
                             match.before < 0 ? "soft" : "stiff");
}

}  // namespace hapsim
