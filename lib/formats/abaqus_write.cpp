// Input decks of Abaqus and CalculiX: the mesh and its sets.
#include <fmt/format.h>

#include <iterator>
#include <map>
#include <ostream>

#include "formats/mesh_file.h"
#include "mesh/tet_faces.h"

namespace hapsim {
namespace {

// Numbers, sixteen a line as the format allows at most.
void write_numbers(std::ostream& out, const std::vector<std::size_t>& numbers) {
  for (std::size_t i = 0; i < numbers.size(); ++i)
    out << numbers[i] << (i % 12 == 11 || i + 1 == numbers.size() ? "\n" : ", ");
}

// The side that lies opposite to the corner that hapsim's face number leaves out: S1 has the
// corners 1 2 3, S2 1 4 2, S3 2 4 3, S4 3 4 1.
constexpr int kSide[4] = {3, 4, 2, 1};

}  // namespace

void write_mesh_abaqus(std::ostream& out, const TetMesh& mesh) {
  out << "** hapsim mesh, metres\n*NODE, NSET=NALL\n";
  // A field has 20 characters at most; what stands behind them is lost, the exponent too.
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n)
    out << fmt::format("{}, {:.12e}, {:.12e}, {:.12e}\n", n + 1, mesh.nodes[n].x(),
                       mesh.nodes[n].y(), mesh.nodes[n].z());
  std::map<int, std::vector<std::size_t>> regions;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) regions[mesh.region[t]].push_back(t);
  const int width = mesh.order == 1 ? 4 : 10;
  for (const auto& [region, tets] : regions) {
    out << fmt::format("*ELEMENT, TYPE={}, ELSET=REGION_{}\n", mesh.order == 1 ? "C3D4" : "C3D10",
                       region);
    for (const std::size_t t : tets) {
      fmt::memory_buffer line;
      fmt::format_to(std::back_inserter(line), "{}", t + 1);
      for (int k = 0; k < width; ++k)
        fmt::format_to(std::back_inserter(line), ", {}", mesh.tets[t][k] + 1);
      out << fmt::to_string(line) << '\n';
    }
  }
  std::vector<std::size_t> fixed;
  for (std::size_t n = 0; n < mesh.fixed.size(); ++n)
    if (mesh.fixed[n] != 0) fixed.push_back(n + 1);
  if (!fixed.empty()) {
    out << "*NSET, NSET=FIXED\n";
    write_numbers(out, fixed);
  }
  out << "*SURFACE, NAME=BOUNDARY, TYPE=ELEMENT\n";
  visit_faces(mesh, [&](std::size_t tet, int face, int tets) {
    if (tets == 1) out << fmt::format("{}, S{}\n", tet + 1, kSide[face]);
  });
}

}  // namespace hapsim
