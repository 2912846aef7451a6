// Gmsh 2.2 and 4.1, ASCII.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <ostream>
#include <set>

#include "formats/mesh_file.h"
#include "mesh/tet_faces.h"

namespace hapsim {
namespace {

// Gmsh has the middles of the edges 23 and 13 the other way round.
constexpr int kTheirs[10] = {0, 1, 2, 3, 4, 5, 6, 7, 9, 8};
constexpr int kFree = 1, kFixed = 2;  // physical surfaces
// Middles of a face's edges 01, 12, 20, as edge numbers of the tetrahedron.
constexpr int kFaceEdges[4][3] = {{1, 5, 4}, {3, 5, 2}, {0, 4, 3}, {2, 1, 0}};

struct BoundaryFace {
  std::array<int, 6> node;  // corners, then middles or -1
  int physical;
};

std::vector<BoundaryFace> boundary(const TetMesh& mesh) {
  std::vector<BoundaryFace> faces;
  visit_faces(mesh, [&](std::size_t tet, int face, int tets) {
    if (tets != 1) return;
    BoundaryFace& f = faces.emplace_back();
    bool fixed = true;
    for (int k = 0; k < 3; ++k) {
      f.node[k] = mesh.tets[tet][kFaceCorners[face][k]];
      f.node[3 + k] = mesh.tets[tet][4 + kFaceEdges[face][k]];
      fixed = fixed && mesh.fixed[f.node[k]] != 0;
    }
    f.physical = fixed ? kFixed : kFree;
  });
  return faces;
}

// A region's number in Gmsh, whose numbers begin at 1: the name tells the own one.
std::map<int, int> physical_volumes(const TetMesh& mesh) {
  std::map<int, int> numbers;
  for (const int region : mesh.region) numbers[region] = 0;
  int next = 1;
  for (auto& [region, number] : numbers) number = next++;
  return numbers;
}

std::string nodes_of(const TetMesh& mesh, std::size_t t) {
  std::string text;
  for (int k = 0; k < (mesh.order == 1 ? 4 : 10); ++k)
    text += fmt::format(" {}", mesh.tets[t][kTheirs[k]] + 1);
  return text;
}

std::string nodes_of(const TetMesh& mesh, const BoundaryFace& face) {
  std::string text;
  for (int k = 0; k < (mesh.order == 1 ? 3 : 6); ++k) text += fmt::format(" {}", face.node[k] + 1);
  return text;
}

class GmshWriter {
 public:
  GmshWriter(std::ostream& out, const TetMesh& mesh)
      : out_(out), mesh_(mesh), faces_(boundary(mesh)), volumes_(physical_volumes(mesh)) {
    std::stable_sort(faces_.begin(), faces_.end(),
                     [](const auto& a, const auto& b) { return a.physical < b.physical; });
    for (const BoundaryFace& f : faces_) surfaces_.insert(f.physical);
  }

  void write(int version) {
    out_ << "$MeshFormat\n" << (version == 41 ? "4.1" : "2.2") << " 0 8\n$EndMeshFormat\n";
    write_names();
    version == 41 ? write_body4() : write_body2();
    write_fixed();
  }

 private:
  void write_names() {
    out_ << "$PhysicalNames\n" << surfaces_.size() + volumes_.size() << '\n';
    for (const int s : surfaces_)
      out_ << "2 " << s << (s == kFixed ? " \"fixed\"\n" : " \"free\"\n");
    for (const auto& [region, number] : volumes_)
      out_ << fmt::format("3 {} \"region_{}\"\n", number, region);
    out_ << "$EndPhysicalNames\n";
  }

  std::string point(std::size_t n) const {
    const Vec3& p = mesh_.nodes[n];
    return fmt::format("{} {} {}", p.x(), p.y(), p.z());
  }

  void write_body2() {
    out_ << "$Nodes\n" << mesh_.nodes.size() << '\n';
    for (std::size_t n = 0; n < mesh_.nodes.size(); ++n) out_ << n + 1 << ' ' << point(n) << '\n';
    out_ << "$EndNodes\n$Elements\n" << faces_.size() + mesh_.tets.size() << '\n';
    std::size_t number = 0;
    for (const BoundaryFace& f : faces_)
      out_ << fmt::format("{} {} 2 {} {}", ++number, mesh_.order == 1 ? 2 : 9, f.physical,
                          f.physical)
           << nodes_of(mesh_, f) << '\n';
    for (std::size_t t = 0; t < mesh_.tets.size(); ++t) {
      const int physical = volumes_.at(mesh_.region[t]);
      out_ << fmt::format("{} {} 2 {} {}", ++number, mesh_.order == 1 ? 4 : 11, physical, physical)
           << nodes_of(mesh_, t) << '\n';
    }
    out_ << "$EndElements\n";
  }

  void write_body4() {
    Vec3 low = mesh_.nodes[0], high = low;
    for (const Vec3& p : mesh_.nodes) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    const std::string box =
        fmt::format("{} {} {} {} {} {}", low.x(), low.y(), low.z(), high.x(), high.y(), high.z());
    out_ << fmt::format("$Entities\n0 0 {} {}\n", surfaces_.size(), volumes_.size());
    for (const int s : surfaces_) out_ << fmt::format("{} {} 1 {} 0\n", s, box, s);
    for (const auto& [region, v] : volumes_) out_ << fmt::format("{} {} 1 {} 0\n", v, box, v);
    const std::size_t n = mesh_.nodes.size();
    out_ << fmt::format("$EndEntities\n$Nodes\n1 {} 1 {}\n3 {} 0 {}\n", n, n,
                        volumes_.begin()->second, n);
    for (std::size_t i = 0; i < n; ++i) out_ << i + 1 << '\n';
    for (std::size_t i = 0; i < n; ++i) out_ << point(i) << '\n';
    const std::size_t all = faces_.size() + mesh_.tets.size();
    out_ << fmt::format("$EndNodes\n$Elements\n{} {} 1 {}\n", surfaces_.size() + volumes_.size(),
                        all, all);
    std::size_t number = 0;
    for (const int s : surfaces_) {
      const auto count = std::count_if(faces_.begin(), faces_.end(),
                                       [s](const BoundaryFace& f) { return f.physical == s; });
      out_ << fmt::format("2 {} {} {}\n", s, mesh_.order == 1 ? 2 : 9, count);
      for (const BoundaryFace& f : faces_)
        if (f.physical == s) out_ << ++number << nodes_of(mesh_, f) << '\n';
    }
    for (const auto& [region, v] : volumes_) {
      const auto count = std::count(mesh_.region.begin(), mesh_.region.end(), region);
      out_ << fmt::format("3 {} {} {}\n", v, mesh_.order == 1 ? 4 : 11, count);
      for (std::size_t t = 0; t < mesh_.tets.size(); ++t)
        if (mesh_.region[t] == region) out_ << ++number << nodes_of(mesh_, t) << '\n';
    }
    out_ << "$EndElements\n";
  }

  void write_fixed() {
    out_ << "$NodeData\n1\n\"fixed\"\n1\n0\n3\n0\n1\n" << mesh_.nodes.size() << '\n';
    for (std::size_t n = 0; n < mesh_.nodes.size(); ++n)
      out_ << n + 1 << ' ' << static_cast<int>(mesh_.fixed[n]) << '\n';
    out_ << "$EndNodeData\n";
  }

  std::ostream& out_;
  const TetMesh& mesh_;
  std::vector<BoundaryFace> faces_;
  std::map<int, int> volumes_;
  std::set<int> surfaces_;
};

}  // namespace

void write_mesh_gmsh(std::ostream& out, const TetMesh& mesh, int version) {
  GmshWriter(out, mesh).write(version);
}

}  // namespace hapsim
