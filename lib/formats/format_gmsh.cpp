// Gmsh 2.2, 4.1 and, read only, 1.0, ASCII (Gmsh reference manual, "File formats" and "Legacy
// formats"); types 4 and 11. Region: the physical volume's number, or N when it is named region_N;
// fixed: node data `fixed`, or the physical surface named fixed.
#include <fmt/format.h>

#include <cstdlib>
#include <map>
#include <unordered_map>

#include "base/error.h"
#include "containers/text_scanner.h"
#include "formats/format.h"
#include "formats/mesh_file.h"

namespace hapsim {
namespace {

constexpr long kMost = 2147483647;
constexpr int kTriangle = 2, kTetrahedron = 4, kTriangle6 = 9, kTetrahedron10 = 11;
// Gmsh has the middles of the edges 23 and 13 the other way round.
constexpr int kOwn[10] = {0, 1, 2, 3, 4, 5, 6, 7, 9, 8};
// Element types with three dimensions that are left out.
bool is_other_volume(long type) {
  return (type >= 5 && type <= 7) || (type >= 12 && type <= 14) || (type >= 17 && type <= 19) ||
         type >= 29;
}

class GmshReader {
 public:
  GmshReader(const std::string& bytes, const std::string& where) : scan_(bytes, where) {}

  RawMesh read() {
    while (!scan_.done()) {
      const std::string section(scan_.word());
      if (section == "$MeshFormat")
        read_format();
      else if (section == "$PhysicalNames")
        read_names();
      else if (section == "$Entities")
        read_entities();
      else if (section == "$Nodes")
        four_ ? read_nodes4() : read_nodes2();
      else if (section == "$NOD")
        read_nodes2();
      else if (section == "$Elements")
        four_ ? read_elements4() : read_elements2();
      else if (section == "$ELM")
        read_elements1();
      else if (section == "$NodeData")
        read_node_data();
      else if (section.starts_with("$") && !section.starts_with("$End"))
        skip(section);
      else
        scan_.fail("'" + section.substr(0, 40) + "' stands where a $Section should");
      expect_end(section);
    }
    finish_fixed();
    return std::move(mesh_);
  }

 private:
  static std::string end_of(const std::string& section) {
    const bool first = section == "$NOD" || section == "$ELM";  // of format 1.0
    return (first ? "$END" : "$End") + section.substr(1);
  }

  void expect_end(const std::string& section) {
    if (skipped_) {
      skipped_ = false;
      return;
    }
    const std::string_view end = scan_.word();
    const std::string wanted = end_of(section);
    if (end != wanted)
      scan_.fail(end.empty() ? "the file is truncated: " + wanted + " should follow"
                             : "'" + std::string(end.substr(0, 40)) + "' stands where " + wanted +
                                   " should");
  }

  void skip(const std::string& section) {
    const std::string end = end_of(section);
    while (!scan_.done())
      if (scan_.line() == end) {
        skipped_ = true;
        return;
      }
    scan_.fail("the file is truncated: " + end + " should follow");
  }

  void read_format() {
    const double version = scan_.number("the version");
    four_ = version == 4.1;
    if (version != 2.2 && version != 4.1)
      scan_.fail(fmt::format("Gmsh format {}; 2.2 and 4.1 are read", version));
    if (scan_.integer("the file type", 0, 1) != 0)
      fail_input(scan_.where(), "this Gmsh mesh is binary",
                 "write it as text: gmsh FILE -save -bin 0 -format msh22 -o OUT");
    scan_.integer("the data size", 1, 16);
    mesh_.format = four_ ? "Gmsh 4.1" : "Gmsh 2.2";
  }

  void read_names() {
    const std::size_t count = scan_.count("the number of physical names", 5);
    for (std::size_t i = 0; i < count; ++i) {
      const long dimension = scan_.integer("a dimension", 0, 3);
      const long tag = scan_.integer("a physical number", -kMost, kMost);
      std::string name(scan_.line());
      std::erase(name, '"');
      if (dimension == 2 && name == "fixed") fixed_surface_ = tag;
      long number = 0;
      if (dimension == 3 && name.starts_with("region_") && name.size() < 16) {
        char* end = nullptr;
        number = std::strtol(name.c_str() + 7, &end, 10);
        if (*end == '\0' && end != name.c_str() + 7) region_[tag] = static_cast<int>(number);
      }
    }
  }

  void read_entities() {
    std::size_t counts[4];
    for (std::size_t& n : counts) n = scan_.count("the number of entities", 2);
    for (int dimension = 0; dimension < 4; ++dimension)
      for (std::size_t i = 0; i < counts[dimension]; ++i) {
        const long tag = scan_.integer("the number of an entity", -kMost, kMost);
        for (int k = 0; k < (dimension == 0 ? 3 : 6); ++k) scan_.number("a bound of an entity");
        const std::size_t physical = scan_.count("the number of physical numbers", 2);
        for (std::size_t k = 0; k < physical; ++k) {
          const long number = scan_.integer("a physical number", -kMost, kMost);
          if (k == 0) physical_[{dimension, tag}] = std::labs(number);
        }
        if (dimension == 0) continue;
        const std::size_t bounding = scan_.count("the number of bounding entities", 2);
        for (std::size_t k = 0; k < bounding; ++k)
          scan_.integer("a bounding entity", -kMost, kMost);
      }
  }

  void add_node(long number, bool coordinates) {
    if (coordinates) {
      Vec3& p = mesh_.nodes.emplace_back();
      for (int k = 0; k < 3; ++k) p[k] = scan_.number("a coordinate");
    }
    if (!index_.emplace(number, static_cast<int>(index_.size())).second)
      scan_.fail(fmt::format("node {} is there twice", number));
  }

  void read_nodes2() {
    const std::size_t count = scan_.count("the number of nodes", 8);
    mesh_.nodes.reserve(count);
    for (std::size_t i = 0; i < count; ++i)
      add_node(scan_.integer("the number of a node", 0, kMost), true);
  }

  void read_nodes4() {
    const std::size_t blocks = scan_.count("the number of blocks", 4);
    scan_.count("the number of nodes", 6);
    scan_.number("the least number");
    scan_.number("the largest number");
    for (std::size_t b = 0; b < blocks; ++b) {
      const long dimension = scan_.integer("a dimension", 0, 3);
      scan_.integer("the number of an entity", -kMost, kMost);
      const long parametric = scan_.integer("the parametric flag", 0, 1);
      const std::size_t count = scan_.count("the number of nodes in a block", 6);
      for (std::size_t i = 0; i < count; ++i)
        add_node(scan_.integer("the number of a node", 0, kMost), false);
      for (std::size_t i = 0; i < count; ++i) {
        Vec3& p = mesh_.nodes.emplace_back();
        for (int k = 0; k < 3; ++k) p[k] = scan_.number("a coordinate");
        for (long k = 0; k < parametric * dimension; ++k) scan_.number("a parameter");
      }
    }
  }

  int node() {
    const long number = scan_.integer("the node of an element", 0, kMost);
    const auto found = index_.find(number);
    if (found == index_.end()) scan_.fail(fmt::format("there is no node {}", number));
    return found->second;
  }

  void read_element(long type, long physical) {
    if (type == kTetrahedron || type == kTetrahedron10) {
      const std::size_t width = type == kTetrahedron ? 4 : 10;
      int own[10];
      for (std::size_t k = 0; k < width; ++k) own[kOwn[k]] = node();
      const auto named = region_.find(physical);
      if (!mesh_.add(own, width,
                     named != region_.end() ? named->second : static_cast<int>(physical)))
        scan_.fail("tetrahedra of first and second order are mixed");
    } else if (type == kTriangle || type == kTriangle6) {
      Triangle f;
      for (int& n : f) n = node();
      if (fixed_surface_ >= 0 && physical == fixed_surface_) mesh_.fixed_faces.push_back(f);
      scan_.line();
    } else {
      mesh_.other_cells += is_other_volume(type);
      scan_.line();
    }
  }

  void read_elements2() {
    const std::size_t count = scan_.count("the number of elements", 6);
    for (std::size_t i = 0; i < count; ++i) {
      scan_.integer("the number of an element", 0, kMost);
      const long type = scan_.integer("the type of an element", 1, 1000);
      const long tags = scan_.integer("the number of tags", 0, 1000);
      long physical = 0;
      for (long k = 0; k < tags; ++k) {
        const long tag = scan_.integer("a tag", -kMost, kMost);
        if (k == 0) physical = std::labs(tag);
      }
      read_element(type, physical);
    }
  }

  void read_elements1() {
    mesh_.format = "Gmsh 1";
    const std::size_t count = scan_.count("the number of elements", 10);
    for (std::size_t i = 0; i < count; ++i) {
      scan_.integer("the number of an element", 0, kMost);
      const long type = scan_.integer("the type of an element", 1, 1000);
      const long physical = std::labs(scan_.integer("a physical number", -kMost, kMost));
      scan_.integer("an elementary number", -kMost, kMost);
      scan_.integer("the number of nodes", 1, 1000);
      read_element(type, physical);
    }
  }

  void read_elements4() {
    const std::size_t blocks = scan_.count("the number of blocks", 4);
    scan_.count("the number of elements", 3);
    scan_.number("the least number");
    scan_.number("the largest number");
    for (std::size_t b = 0; b < blocks; ++b) {
      const int dimension = static_cast<int>(scan_.integer("a dimension", 0, 3));
      const long entity = scan_.integer("the number of an entity", -kMost, kMost);
      const long type = scan_.integer("the type of an element", 1, 1000);
      const std::size_t count = scan_.count("the number of elements in a block", 3);
      const auto found = physical_.find({dimension, entity});
      const long physical = found != physical_.end() ? found->second : 0;
      for (std::size_t i = 0; i < count; ++i) {
        scan_.integer("the number of an element", 0, kMost);
        read_element(type, physical);
      }
    }
  }

  void read_node_data() {
    const std::size_t strings = scan_.count("the number of names", 2);
    scan_.line();
    std::string name;
    for (std::size_t i = 0; i < strings; ++i) {
      const std::string text(scan_.line());
      if (i == 0) name = text;
    }
    const std::size_t reals = scan_.count("the number of real tags", 2);
    for (std::size_t i = 0; i < reals; ++i) scan_.number("a real tag");
    const std::size_t integers = scan_.count("the number of whole tags", 2);
    long fields = 1, values = 0;
    for (std::size_t i = 0; i < integers; ++i) {
      const long value = scan_.integer("a whole tag", -kMost, kMost);
      if (i == 1) fields = value;
      if (i == 2) values = value;
    }
    const bool fixed = name == "\"fixed\"" && fields == 1;
    if (fixed) mesh_.fixed.assign(mesh_.nodes.size(), 0);
    for (long i = 0; i < values; ++i) {
      const int at = node();
      for (long k = 0; k < fields; ++k) {
        const double value = scan_.number("node data");
        if (fixed) mesh_.fixed[static_cast<std::size_t>(at)] = value != 0;
      }
    }
  }

  void finish_fixed() {
    if (mesh_.fixed.size() < mesh_.nodes.size() && !mesh_.fixed.empty())
      mesh_.fixed.resize(mesh_.nodes.size(), 0);
  }

  TextScanner scan_;
  RawMesh mesh_;
  bool four_ = false, skipped_ = false;
  std::unordered_map<long, int> index_;
  std::map<long, int> region_;
  std::map<std::pair<int, long>, long> physical_;
  long fixed_surface_ = -1;
};

Content sniff(const std::string& bytes) {
  const std::size_t first = std::min(bytes.find_first_not_of(" \t\r\n"), bytes.size());
  const std::string_view text = std::string_view(bytes).substr(first);
  const bool ours = text.starts_with("$MeshFormat") || text.starts_with("$NOD\n") ||
                    text.starts_with("$NOD\r") || text.starts_with("$NOD ");
  return ours ? Content::kTetrahedra : Content::kNothing;
}

RawMesh read_mesh(const std::string& bytes, const std::string& where) {
  return GmshReader(bytes, where).read();
}

void write_mesh(std::ostream& out, const TetMesh& mesh, const WriteOptions& options) {
  write_mesh_gmsh(out, mesh, options.version == "4.1" ? 41 : 22);
}

}  // namespace

const Format& gmsh_format() {
  static const Format format{.name = "Gmsh",
                             .extensions = {"msh"},
                             .sniff = sniff,
                             .read_mesh = read_mesh,
                             .write_mesh = write_mesh};
  return format;
}

}  // namespace hapsim
