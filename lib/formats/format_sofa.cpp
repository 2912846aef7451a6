// SOFA, XML scenes with the mesh in themselves: the first topology that lists tetrahedra. Region: K
// of a child node region_K that lists them again; fixed: the indices, or the BoxROI, of
// FixedProjectiveConstraint or FixedConstraint beside the topology.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "base/error.h"
#include "containers/mesh_xml.h"
#include "formats/format.h"

namespace hapsim {
namespace {

constexpr const char* kMend = "write the mesh again";

class SofaScene {
 public:
  SofaScene(const std::string& bytes, const std::string& name) : xml_(bytes, name) {}

  RawMesh read() {
    raw_.format = "SOFA";
    const pugi::xml_node topology = find_topology(xml_.root());
    if (!topology) {
      refuse_loader();
      return std::move(raw_);
    }
    const pugi::xml_node body = topology.parent();
    read_nodes(topology, body);
    read_tets(topology);
    for (const pugi::xml_node node : body.children("Node")) read_region(node);
    for (const pugi::xml_node component : body.children()) read_constraint(component, body);
    return std::move(raw_);
  }

 private:
  static std::string_view tets_of(pugi::xml_node component) {
    for (const char* name : {"tetrahedra", "tetras"})
      if (component.attribute(name)) return attribute(component, name);
    return "";
  }
  static bool is_topology(pugi::xml_node component) {
    const std::string_view tets = tets_of(component), name = component.name();
    return !tets.empty() && tets[0] != '@' &&
           (name.ends_with("TopologyContainer") || name == "MeshTopology" || name == "Mesh");
  }
  // The first component that lists tetrahedra, in the order of the file.
  static pugi::xml_node find_topology(pugi::xml_node root) {
    return root.find_node([](pugi::xml_node component) { return is_topology(component); });
  }

  void refuse_loader() const {
    const pugi::xml_node loader = xml_.root().find_node([](pugi::xml_node component) {
      return std::string_view(component.name()).ends_with("Loader") &&
             component.attribute("filename");
    });
    if (loader)
      fail_input(xml_.where(loader),
                 fmt::format("the scene loads its mesh from {}", attribute(loader, "filename")),
                 "give that file");
  }

  void read_nodes(pugi::xml_node topology, pugi::xml_node body) {
    const pugi::xml_node state = body.child("MechanicalObject");
    for (const char* moved : {"translation", "translation2", "rotation", "rotation2", "scale",
                              "scale3d", "dx", "dy", "dz", "rx", "ry", "rz"})
      for (const double value : xml_.numbers(state, attribute(state, moved), "number"))
        if (value != (std::string_view(moved).starts_with("scale") ? 1 : 0))
          fail_input(xml_.where(state), fmt::format("the scene moves its mesh by '{}'", moved),
                     "move the positions themselves");
    pugi::xml_node at = topology;
    for (const pugi::xml_node candidate : {topology, state})
      if (const auto text = attribute(candidate, "position"); !text.empty() && text[0] != '@')
        at = candidate;
    const std::vector<double> x = xml_.numbers(at, attribute(at, "position"), "coordinate");
    if (x.size() % 3 != 0)
      fail_input(xml_.where(at), fmt::format("{} coordinates are no points", x.size()), kMend);
    for (std::size_t i = 0; i < x.size(); i += 3) raw_.nodes.emplace_back(x[i], x[i + 1], x[i + 2]);
  }

  // Numbers of one element of the mesh each, below `count`.
  std::vector<long> indices(pugi::xml_node at, std::string_view text, const char* what,
                            std::size_t count) const {
    std::vector<long> list = xml_.integers(at, text, what, 0);
    for (const long i : list)
      if (i >= static_cast<long>(count))
        fail_input(xml_.where(at), fmt::format("there is no {} {}", what, i), kMend);
    return list;
  }

  void read_tets(pugi::xml_node topology) {
    const std::vector<long> list = indices(topology, tets_of(topology), "node", raw_.nodes.size());
    if (list.size() % 4 != 0)
      fail_input(xml_.where(topology), fmt::format("{} nodes are no tetrahedra", list.size()),
                 kMend);
    for (std::size_t i = 0; i < list.size(); i += 4) {
      int nodes[4];
      for (std::size_t k = 0; k < 4; ++k) nodes[k] = static_cast<int>(list[i + k]);
      raw_.add(nodes, 4, 0);
    }
    for (const char* other : {"hexahedra", "hexas", "prisms", "pyramids"})
      raw_.other_cells += xml_.integers(topology, attribute(topology, other), "node", 0).size() / 5;
  }

  // A child node named region_K lists the tetrahedra of region K again.
  void read_region(pugi::xml_node node) {
    const std::optional<int> region = number_of_region(attribute(node, "name"));
    const pugi::xml_node part = find_topology(node);
    if (!region || !part) return;
    if (number_.empty())
      for (std::size_t t = 0; t < raw_.tets.size(); ++t) number_[corners_of(raw_.tets[t])] = t;
    const std::vector<long> list = indices(part, tets_of(part), "node", raw_.nodes.size());
    for (std::size_t i = 0; i + 4 <= list.size(); i += 4) {
      const auto found = number_.find(corners_of(&list[i]));
      if (found == number_.end())
        fail_input(xml_.where(part),
                   fmt::format("region {} has a tetrahedron that the body has not", *region),
                   kMend);
      raw_.region[found->second] = *region;
    }
  }
  using Corners = std::array<long, 4>;
  template <class Nodes>
  static Corners corners_of(const Nodes& nodes) {
    Corners corners{nodes[0], nodes[1], nodes[2], nodes[3]};
    std::sort(corners.begin(), corners.end());
    return corners;
  }

  void read_constraint(pugi::xml_node component, pugi::xml_node body) {
    const std::string_view name = component.name();
    if (name != "FixedProjectiveConstraint" && name != "FixedConstraint") return;
    raw_.fixed.resize(raw_.nodes.size(), 0);
    const auto hold = [&](std::size_t node) { raw_.fixed[node] = 1; };
    const std::string_view list = attribute(component, "indices");
    if (component.attribute("fixAll").as_bool())
      for (std::size_t n = 0; n < raw_.nodes.size(); ++n) hold(n);
    else if (list.starts_with('@'))
      hold_box(component, list.substr(1), body, hold);
    else
      for (const long n : indices(component, list, "node", raw_.nodes.size()))
        hold(static_cast<std::size_t>(n));
  }

  // "@NAME.indices" of a BoxROI: the nodes in its boxes, xmin ymin zmin xmax ymax zmax each.
  template <class Hold>
  void hold_box(pugi::xml_node component, std::string_view link, pugi::xml_node body,
                const Hold& hold) const {
    const std::string_view name = link.substr(0, link.find('.'));
    for (const pugi::xml_node box : body.children("BoxROI")) {
      if (attribute(box, "name") != name) continue;
      const std::vector<double> x = xml_.numbers(box, attribute(box, "box"), "coordinate");
      if (x.empty() || x.size() % 6 != 0)
        fail_input(xml_.where(box), "a box has six coordinates", kMend);
      for (std::size_t at = 0; at < x.size(); at += 6)
        for (std::size_t n = 0; n < raw_.nodes.size(); ++n) {
          bool inside = true;
          for (std::size_t k = 0; k < 3; ++k) {
            const auto [low, high] = std::minmax(x[at + k], x[at + k + 3]);
            const double c = raw_.nodes[n][static_cast<Eigen::Index>(k)];
            inside = inside && c >= low && c <= high;
          }
          if (inside) hold(n);
        }
      return;
    }
    fail_input(xml_.where(component),
               fmt::format("what is fixed, '@{}', is not in the scene", link),
               "list the indices of the nodes, or give a BoxROI beside it");
  }

  XmlFile xml_;
  std::map<Corners, std::size_t> number_;  // of the body's tetrahedra; empty until asked for
  RawMesh raw_;
};

Content sniff(const std::string& bytes) {
  return is_xml_of(bytes, "Node") ? Content::kTetrahedra : Content::kNothing;
}

RawMesh read_mesh(const std::string& bytes, const std::string& where) {
  return SofaScene(bytes, where).read();
}

}  // namespace

const Format& sofa_format() {
  static const Format format{
      .name = "SOFA", .extensions = {"scn"}, .sniff = sniff, .read_mesh = read_mesh};
  return format;
}

}  // namespace hapsim
