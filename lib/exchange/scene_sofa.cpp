#include <fmt/format.h>

#include <set>

#include "base/error.h"
#include "exchange/scene.h"

namespace hapsim {

namespace {

// The regions beyond the first as parts of the body's topology: to be seen, and read back.
void write_regions(std::ostream& out, const TetMesh& mesh) {
  const std::set<int> regions(mesh.region.begin(), mesh.region.end());
  for (const int region : regions) {
    if (region == 0) continue;
    out << "<Node name=\"region_" << region
        << "\">\n<TetrahedronSetTopologyContainer position=\"@../mesh.position\" tetrahedra=\"";
    for (std::size_t t = 0; t < mesh.tets.size(); ++t)
      if (mesh.region[t] == region)
        out << fmt::format("{} {} {} {}\n", mesh.tets[t][0], mesh.tets[t][1], mesh.tets[t][2],
                           mesh.tets[t][3]);
    out << "\"/>\n</Node>\n";
  }
}

}  // namespace

void write_sofa(std::ostream& out, const Scene& scene) {
  const TetMesh& mesh = scene.mesh;
  if (mesh.order != 1)
    fail_input(scene.body_name, "SOFA's tetrahedra are of first order",
               "mesh again with hs-tetmesh --order 1");
  if (scene.finite || !scene.terms.empty())
    fail_input(
        scene.model_name,
        std::string("the scene for SOFA has no ") + (scene.finite ? "finite strain" : "relaxation"),
        "export to FEBio, or take the effect out of the model");
  const double end = scene.t.empty() ? 1 : scene.t.back();
  const double step = end / static_cast<double>(std::max<std::size_t>(1, scene.t.size()));
  out << "<?xml version=\"1.0\"?>\n";
  write_xml_remarks(out, scene);
  out << fmt::format("<Node name=\"root\" gravity=\"0 0 0\" dt=\"{:.9g}\">\n", step);
  for (const char* plugin :
       {"Constraint.Projective", "LinearSolver.Direct", "ODESolver.Backward", "StateContainer",
        "SolidMechanics.FEM.Elastic", "Topology.Container.Dynamic", "Visual"})
    out << "<RequiredPlugin name=\"Sofa.Component." << plugin << "\"/>\n";
  out << "<DefaultAnimationLoop/>\n<VisualStyle displayFlags=\"showForceFields\"/>\n"
         "<Node name=\"body\">\n<StaticSolver newton_iterations=\"5\"/>\n"
         "<SparseLDLSolver template=\"CompressedRowSparseMatrixMat3x3d\"/>\n"
         "<TetrahedronSetTopologyContainer name=\"mesh\" position=\"";
  for (const Vec3& p : mesh.nodes) out << fmt::format("{} {} {}\n", p.x(), p.y(), p.z());
  out << "\" tetrahedra=\"";
  for (const auto& t : mesh.tets) out << fmt::format("{} {} {} {}\n", t[0], t[1], t[2], t[3]);
  out << "\"/>\n<MechanicalObject template=\"Vec3d\"/>\n<TetrahedronFEMForceField method=\"small\" "
      << fmt::format("poissonRatio=\"{:.12g}\" youngModulus=\"", scene.nu);
  for (const int region : mesh.region) out << fmt::format("{:.9g}\n", scene.modulus_of(region));
  out << "\"/>\n<FixedProjectiveConstraint indices=\"";
  for (std::size_t n = 0; n < mesh.fixed.size(); ++n)
    if (mesh.fixed[n] != 0) out << n << ' ';
  out << "\"/>\n";
  if (!scene.tool.empty()) {
    out << "<LinearMovementProjectiveConstraint template=\"Vec3d\" indices=\"";
    for (const int node : scene.tool) out << node << ' ';
    out << "\" keyTimes=\"0";
    for (const double t : scene.t) out << fmt::format(" {:.9g}", t);
    out << "\" movements=\"0 0 0";
    for (const Vec3& u : scene.u)
      out << fmt::format("\n{:.12g} {:.12g} {:.12g}", u.x(), u.y(), u.z());
    out << "\"/>\n";
  }
  write_regions(out, mesh);
  out << "</Node>\n</Node>\n";
}

}  // namespace hapsim
