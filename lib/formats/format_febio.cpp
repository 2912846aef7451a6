// FEBio, febio_spec 2.0 to 4.0; tet4 or tet10. Region: K of a block of elements named region_K,
// otherwise the number of the block; fixed: the node set fixed, and what conditions outside the
// steps hold in all three directions.
#include <fmt/format.h>

#include <cstdint>
#include <map>
#include <unordered_map>

#include "base/error.h"
#include "containers/mesh_xml.h"
#include "formats/format.h"

namespace hapsim {
namespace {

constexpr const char* kMend = "write the mesh again";
constexpr const char* kNode = "number of a node";

struct Range {
  long first, last, step;
  pugi::xml_node element;
};

class FebioModel {
 public:
  FebioModel(const std::string& bytes, const std::string& name) : xml_(bytes, name) {}

  RawMesh read() {
    raw_.format = "FEBio";
    const pugi::xml_node root = xml_.root();
    const std::vector<double> version = xml_.numbers(root, attribute(root, "version"), "version");
    if (version.empty() || version[0] < 2)
      fail_input(xml_.where(root), "febio_spec has no version of at least 2.0",
                 "write it again as 2.5 or later");
    for (const char* section : {"Mesh", "Geometry"})
      for (const pugi::xml_node mesh : root.children(section)) read_mesh(mesh);
    for (const pugi::xml_node boundary : root.children("Boundary"))
      for (const pugi::xml_node condition : boundary.children()) read_condition(condition);
    finish();
    return std::move(raw_);
  }

 private:
  void read_mesh(pugi::xml_node mesh) {
    if (mesh.attribute("from"))
      fail_input(xml_.where(mesh), "the mesh stands in another file", "give that file");
    for (const pugi::xml_node nodes : mesh.children("Nodes"))
      for (const pugi::xml_node node : nodes.children("node")) read_node(node);
    for (const pugi::xml_node elements : mesh.children("Elements")) read_elements(elements);
    for (const pugi::xml_node set : mesh.children("NodeSet")) {
      std::vector<Range>& ranges = sets_[std::string(attribute(set, "name"))];
      add_nodes(set, ranges);
      for (const pugi::xml_node member : set.children())  // 2.5 and 3.0: an element a node
        if (member.attribute("id")) {
          const long id = id_of(member);
          ranges.push_back({id, id, 1, member});
        }
    }
    for (const pugi::xml_node surface : mesh.children("Surface")) {
      std::vector<Range>& ranges = sets_["@surface:" + std::string(attribute(surface, "name"))];
      for (const pugi::xml_node face : surface.children()) add_nodes(face, ranges);
    }
  }

  long id_of(pugi::xml_node element) const {
    return xml_.integer(element, attribute(element, "id"), kNode, 1);
  }

  // Numbers of nodes, and ranges first:last or first:last:step of them.
  void add_nodes(pugi::xml_node element, std::vector<Range>& ranges) const {
    each_word(text_of(element), [&](std::string_view word) {
      long part[3] = {0, 0, 1};
      std::size_t count = 0;
      for (bool more = true; more; ++count) {
        const std::size_t colon = word.find(':');
        more = colon != word.npos && count < 2;
        part[count] = xml_.integer(element, more ? word.substr(0, colon) : word, kNode, 1);
        if (more) word.remove_prefix(colon + 1);
      }
      ranges.push_back({part[0], count == 1 ? part[0] : part[1], part[2], element});
    });
  }

  // Calls `take` with the index of every node of a set.
  template <class Take>
  void each_node(const std::vector<Range>& ranges, const Take& take) const {
    for (const Range& r : ranges) {
      if ((r.last - r.first) / r.step >= static_cast<long>(node_.size()))
        fail_input(xml_.where(r.element),
                   fmt::format("{}:{} has more members than there are nodes", r.first, r.last),
                   kMend);
      for (long id = r.first; id <= r.last; id += r.step) take(index_of(id, r.element));
    }
  }

  void read_node(pugi::xml_node node) {
    const long id = id_of(node);
    if (!node_.emplace(id, static_cast<int>(raw_.nodes.size())).second)
      fail_input(xml_.where(node), fmt::format("node {} is given twice", id), kMend);
    const std::vector<double> x = xml_.numbers(node, text_of(node), "coordinate");
    if (x.size() != 3)
      fail_input(xml_.where(node), fmt::format("node {} has {} coordinates", id, x.size()), kMend);
    raw_.nodes.emplace_back(x[0], x[1], x[2]);
  }

  // A block of elements is a part: region K when named region_K, else the blocks are numbered.
  void read_elements(pugi::xml_node elements) {
    std::string type(attribute(elements, "type"));
    for (char& c : type)
      if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    const std::size_t corners = type == "tet4" ? 4 : type.starts_with("tet10") ? 10 : 0;
    if (corners == 0) {
      for (const char* volume : {"tet", "hex", "penta", "pyra"})
        if (type.starts_with(volume))
          for ([[maybe_unused]] const pugi::xml_node e : elements.children("elem"))
            ++raw_.other_cells;
      return;  // shells and beams have no volume
    }
    const int region = number_of_region(attribute(elements, "name")).value_or(blocks_);
    ++blocks_;
    for (const pugi::xml_node element : elements.children("elem")) {
      const std::vector<long> ids = xml_.integers(element, text_of(element), kNode, 1);
      if (ids.size() != corners)
        fail_input(xml_.where(element),
                   fmt::format("an element has {} nodes, not {}", ids.size(), corners), kMend);
      int nodes[10];
      for (std::size_t k = 0; k < corners; ++k) nodes[k] = index_of(ids[k], element);
      if (!raw_.add(nodes, corners, region))
        fail_input(xml_.where(element), "tetrahedra of first and of second order are mixed",
                   "write all of one order");
    }
  }

  int index_of(long id, pugi::xml_node element) const {
    const auto found = node_.find(id);
    if (found == node_.end())
      fail_input(xml_.where(element), fmt::format("there is no node {}", id), kMend);
    return found->second;
  }

  // Directions, a bit each, that a condition outside the steps holds at zero.
  static unsigned held_by(pugi::xml_node condition) {
    unsigned held = 0;
    const auto hold = [&](std::string_view dof) {  // others are a shell's, a fluid's
      if (dof == "x" || dof == "y" || dof == "z") held |= 1U << (dof[0] - 'x');
    };
    const std::string_view kind = condition.name(), type = attribute(condition, "type");
    if (kind == "bc" && type == "zero displacement") {  // 4.0
      for (const std::string dof : {"x", "y", "z"})
        if (condition.child((dof + "_dof").c_str()).text().as_bool()) hold(dof);
    } else if (kind == "bc" && type == "fix") {  // 3.0
      each_word(text_of(condition.child("dofs")), hold);
    } else if (kind == "fix") {  // 2.5
      each_word(attribute(condition, "bc"), hold);
    }
    return held;
  }

  void read_condition(pugi::xml_node condition) {
    const unsigned held = held_by(condition);
    if (held == 0) return;
    const std::string set(attribute(condition, "node_set"));
    const auto found = sets_.find(set);
    if (found == sets_.end())
      fail_input(xml_.where(condition), fmt::format("there is no node set '{}'", set),
                 "hold a NodeSet, or @surface:NAME");
    each_node(found->second, [&](int node) { held_[node] |= held; });
  }

  void finish() {
    const auto named = sets_.find("fixed");
    if (named == sets_.end() && held_.empty()) return;
    raw_.fixed.assign(raw_.nodes.size(), 0);
    for (const auto& [node, held] : held_) raw_.fixed[static_cast<std::size_t>(node)] = held == 7;
    if (named != sets_.end())
      each_node(named->second, [&](int node) { raw_.fixed[static_cast<std::size_t>(node)] = 1; });
  }

  XmlFile xml_;
  int blocks_ = 0;
  std::unordered_map<long, int> node_;  // by its number in the file
  std::map<std::string, std::vector<Range>> sets_;
  std::unordered_map<int, unsigned> held_;
  RawMesh raw_;
};

Content sniff(const std::string& bytes) {
  return is_xml_of(bytes, "febio_spec") ? Content::kTetrahedra : Content::kNothing;
}

RawMesh read_mesh(const std::string& bytes, const std::string& where) {
  return FebioModel(bytes, where).read();
}

}  // namespace

const Format& febio_format() {
  static const Format format{
      .name = "FEBio", .extensions = {"feb"}, .sniff = sniff, .read_mesh = read_mesh};
  return format;
}

}  // namespace hapsim
