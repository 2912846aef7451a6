#include <fmt/format.h>

#include <set>

#include "base/error.h"
#include "exchange/scene.h"
#include "formats/mesh_file.h"
#include "material/hyperelastic_law.h"

namespace hapsim {

void write_calculix(std::ostream& out, const Scene& scene) {
  if (!scene.terms.empty())
    fail_input(scene.model_name, "CalculiX has no linear viscoelasticity",
               "export to FEBio, or take viscoelastic out of the model");
  for (const std::string& remark : scene.remarks) out << "** " << remark << '\n';
  write_mesh_abaqus(out, scene.mesh);
  const std::set<int> regions(scene.mesh.region.begin(), scene.mesh.region.end());
  for (const int region : regions) {
    const double E = scene.modulus_of(region);
    const Moduli m = moduli(E, scene.nu);
    out << fmt::format("*MATERIAL, NAME=MATERIAL_{}\n", region);
    if (scene.finite)
      out << fmt::format("*HYPERELASTIC, NEO HOOKE\n{:.12e}, {:.12e}\n", m.mu / 2, 2 / m.bulk);
    else
      out << fmt::format("*ELASTIC\n{:.12e}, {:.12e}\n", E, scene.nu);
    out << fmt::format("*SOLID SECTION, ELSET=REGION_{0}, MATERIAL=MATERIAL_{0}\n", region);
  }
  out << "*BOUNDARY\nFIXED, 1, 3\n";
  if (scene.tool.empty()) return;
  out << "*NSET, NSET=TOOL\n";
  for (const int node : scene.tool) out << node + 1 << ",\n";
  for (std::size_t i = 0; i < scene.t.size(); ++i) {
    out << fmt::format("** t = {:.9g} s\n", scene.t[i])
        << (scene.finite ? "*STEP, NLGEOM, INC=100\n*STATIC\n0.5, 1.\n*CONTROLS, PARAMETERS=FIELD\n"
                           "1.e-9, 1.e-8, , , 1.e-9, 1.e-5, 1.e-3, 1.e-8\n"
                         : "*STEP\n*STATIC\n")
        << "*BOUNDARY\n";
    for (int k = 0; k < 3; ++k)
      out << fmt::format("TOOL, {0}, {0}, {1:.12e}\n", k + 1, scene.u[i][k]);
    out << "*NODE PRINT, NSET=TOOL, TOTALS=ONLY\nRF\n*NODE FILE\nU\n*END STEP\n";
  }
}

}  // namespace hapsim
