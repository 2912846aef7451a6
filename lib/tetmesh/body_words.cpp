#include "tetmesh/body_words.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>

namespace hapsim {
namespace {

nlohmann::ordered_json as_json(const Spread& spread, const Histogram* histogram = nullptr) {
  nlohmann::ordered_json json{
      {"min", spread.minimum}, {"median", spread.median}, {"max", spread.maximum}};
  if (histogram != nullptr) json["bins_from"] = histogram->edge;
  if (histogram != nullptr) json["counts"] = histogram->count;
  return json;
}

std::string counts(const char* what, const Histogram& histogram) {
  std::string text = what;
  for (std::size_t i = 0; i < histogram.count.size(); ++i)
    text +=
        fmt::format("{} from {:g}: {}", i == 0 ? "" : ",", histogram.edge[i], histogram.count[i]);
  return text;
}

}  // namespace

std::string weak_support_words(const TetMesh& mesh) {
  constexpr double kSmall = 0.2;  // radius over the cube root of the body's volume
  const auto held = std::count(mesh.fixed.begin(), mesh.fixed.end(), 1);
  if (held == 0) return "";
  double area = 0;
  for (const Triangle& f : mesh.faces)
    if (mesh.fixed[f[0]] && mesh.fixed[f[1]] && mesh.fixed[f[2]])
      area +=
          0.5 *
          (mesh.nodes[f[1]] - mesh.nodes[f[0]]).cross(mesh.nodes[f[2]] - mesh.nodes[f[0]]).norm();
  const double size = std::cbrt(volume(mesh));
  if (std::sqrt(area / std::numbers::pi) > kSmall * size) return "";
  return fmt::format(
      "WARNING: {} nodes and {:.2g} cm^2 hold a body of {:.3g} mm: it will rock on so small a "
      "base; "
      "bond more of it (--fixed below:Z), or cut its bottom flat (hs-reconstruct --base)",
      held, 1e4 * area, 1e3 * size);
}

std::string body_json(const TetMesh& mesh, const TetQuality& q, const BodyReport& report) {
  std::map<int, std::size_t> regions;
  for (const int region : mesh.region) ++regions[region];
  nlohmann::ordered_json json{
      {"tetrahedra", mesh.tets.size()},
      {"nodes", mesh.nodes.size()},
      {"order", mesh.order},
      {"boundary_triangles", mesh.faces.size()},
      {"volume_m3", q.volume},
      {"fixed_nodes", std::count(mesh.fixed.begin(), mesh.fixed.end(), 1)},
      {"inverted", q.inverted},
      {"edge_m", as_json(q.edge)},
      {"radius_edge", as_json(q.radius_edge, &q.radius_edge_counts)},
      {"smallest_dihedral_deg", as_json(q.smallest_dihedral_deg, &q.dihedral_counts)},
      {"largest_dihedral_deg", q.largest_dihedral_deg},
      {"aspect", as_json(q.aspect, &q.aspect_counts)}};
  for (const auto& [region, count] : regions) json["regions"][std::to_string(region)] = count;
  json["contact_nodes"] = report.contact_node;
  for (const BadTet& t : q.worst_tets)
    json["worst"].push_back({{"tetrahedron", t.tet},
                             {"x", t.place.x()},
                             {"y", t.place.y()},
                             {"z", t.place.z()},
                             {"smallest_dihedral_deg", t.smallest_dihedral_deg},
                             {"radius_edge", t.radius_edge},
                             {"aspect", t.aspect}});
  json["notes"] = report.notes;
  return json.dump(2) + "\n";
}

Summary body_summary(const TetMesh& mesh, const TetQuality& q, const BodyReport& report,
                     const std::string& unit, bool verbose) {
  Summary s;
  const auto fixed = std::count(mesh.fixed.begin(), mesh.fixed.end(), 1);
  s.mark = fixed > 0 ? Summary::Mark::kGood : Summary::Mark::kOpen;
  s.verdict =
      fixed > 0
          ? fmt::format("a body of {} tetrahedra, {} nodes fixed", mesh.tets.size(), fixed)
          : fmt::format("a body of {} tetrahedra, no node fixed: fix some before it is pressed",
                        mesh.tets.size());
  s.size = fmt::format("{:.4g} cm^3", 1e6 * q.volume);
  SummaryItem sizes{"SIZE", "", "", {}}, quality{"QUALITY", "", "", {}};
  sizes.facts.push_back(fmt::format("{} nodes, {} boundary triangles, {:.6g} m^3, unit {}",
                                    mesh.nodes.size(), mesh.faces.size(), q.volume, unit));
  quality.facts.push_back(fmt::format(
      "radius-edge {:.2f} / {:.2f} / {:.2f}, smallest dihedral {:.1f} / {:.1f} / {:.1f} "
      "deg, largest {:.1f} deg, aspect {:.2f} / {:.2f} / {:.2f} (min / median / max)",
      q.radius_edge.minimum, q.radius_edge.median, q.radius_edge.maximum,
      q.smallest_dihedral_deg.minimum, q.smallest_dihedral_deg.median,
      q.smallest_dihedral_deg.maximum, q.largest_dihedral_deg, q.aspect.minimum, q.aspect.median,
      q.aspect.maximum));
  if (!verbose && !q.worst_tets.empty()) {
    const Vec3& at = q.worst_place;
    quality.facts.push_back(fmt::format("worst tetrahedron {} at ({:.6g}, {:.6g}, {:.6g})", q.worst,
                                        at.x(), at.y(), at.z()));
  }
  if (verbose) {
    quality.facts.push_back(counts("radius-edge", q.radius_edge_counts));
    quality.facts.push_back(counts("smallest dihedral [deg]", q.dihedral_counts));
    quality.facts.push_back(counts("aspect", q.aspect_counts));
    for (const BadTet& t : q.worst_tets)
      quality.facts.push_back(
          fmt::format("tetrahedron {} at ({:.6g}, {:.6g}, {:.6g}): smallest dihedral {:.2f} deg, "
                      "radius-edge {:.2f}, aspect {:.2f}",
                      t.tet, t.place.x(), t.place.y(), t.place.z(), t.smallest_dihedral_deg,
                      t.radius_edge, t.aspect));
  }
  s.items = {std::move(sizes), std::move(quality)};
  s.notes = report.notes;
  return s;
}

}  // namespace hapsim
