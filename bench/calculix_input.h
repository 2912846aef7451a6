// A press of a linear elastic mesh as CalculiX reads it, and the force that it prints.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "mesh/tetmesh.h"

namespace hapsim::bench {

// The nodes of the patch move by u [m], the fixed ones are held.
inline void write_calculix(const std::filesystem::path& file, const TetMesh& mesh,
                           const std::vector<int>& patch, double modulus, double nu, const Vec3& u,
                           const std::string& solver) {
  std::ofstream out(file);
  out << "*NODE, NSET=NALL\n";
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n)
    out << fmt::format("{},{:.12e},{:.12e},{:.12e}\n", n + 1, mesh.nodes[n].x(), mesh.nodes[n].y(),
                       mesh.nodes[n].z());
  out << "*ELEMENT, ELSET=EALL, TYPE=" << (mesh.order == 1 ? "C3D4" : "C3D10") << "\n";
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    out << t + 1;
    for (int a = 0; a < (mesh.order == 1 ? 4 : 10); ++a) out << "," << mesh.tets[t][a] + 1;
    out << "\n";
  }
  out << "*NSET, NSET=PATCH\n";
  for (const int n : patch) out << n + 1 << "\n";
  out << "*NSET, NSET=HELD\n";
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n)
    if (mesh.fixed[n]) out << n + 1 << "\n";
  out << fmt::format(
      "*MATERIAL, NAME=M\n*ELASTIC\n{},{}\n*SOLID SECTION, ELSET=EALL, MATERIAL=M\n*STEP\n"
      "*STATIC, SOLVER={}\n*BOUNDARY\nHELD,1,3\nPATCH,1,1,{:.9e}\nPATCH,2,2,{:.9e}\n"
      "PATCH,3,3,{:.9e}\n*NODE PRINT, NSET=PATCH, TOTALS=ONLY\nRF\n*END STEP\n",
      modulus, nu, solver, u.x(), u.y(), u.z());
}

// What holds the patch [N], from the .dat file.
inline Vec3 calculix_force(const std::filesystem::path& file) {
  std::ifstream in(file);
  Vec3 force = Vec3::Constant(NAN);
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    Vec3 f;
    if (words >> f[0] >> f[1] >> f[2]) force = f;
  }
  return force;
}

}  // namespace hapsim::bench
