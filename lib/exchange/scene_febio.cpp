#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "exchange/scene.h"
#include "material/hyperelastic_law.h"

namespace hapsim {
namespace {

// The solid that bears the load at rest; alone or inside "viscoelastic".
std::string elastic_part(const Scene& scene, double E) {
  if (!scene.finite) return fmt::format("<E>{:.12g}</E><v>{:.12g}</v>", E, scene.nu);
  const Moduli m = moduli(E, scene.nu);
  return fmt::format("<c1>{:.12g}</c1><c2>0</c2><k>{:.12g}</k><pressure_model>2</pressure_model>",
                     m.mu / 2, m.bulk);  // pressure model 2: U = k (J - 1)^2 / 2
}

// Of G(t) = 1 + sum g_i exp(-t/t_i) FEBio takes six terms.
std::string material(const Scene& scene, double E) {
  const char* solid = scene.finite ? "Mooney-Rivlin" : "isotropic elastic";
  if (scene.terms.empty()) return fmt::format("type=\"{}\">{}", solid, elastic_part(scene, E));
  std::string terms;
  for (std::size_t k = 0; k < scene.terms.size(); ++k)
    terms += fmt::format("<t{0}>{1:.12g}</t{0}><g{0}>{2:.12g}</g{0}>", k + 1, scene.terms[k].tau,
                         scene.terms[k].share);
  return fmt::format("type=\"{}viscoelastic\">{}{}<elastic type=\"{}\">{}</elastic>",
                     scene.finite ? "uncoupled " : "", terms,
                     scene.finite ? fmt::format("<k>{:.12g}</k>", moduli(E, scene.nu).bulk) : "",
                     solid, elastic_part(scene, E));
}

void write_set(std::ostream& out, const char* name, const std::vector<int>& nodes) {
  out << "<NodeSet name=\"" << name << "\">";
  for (std::size_t i = 0; i < nodes.size(); ++i) out << (i == 0 ? "" : ",") << nodes[i] + 1;
  out << "</NodeSet>\n";
}

void write_mesh(std::ostream& out, const Scene& scene, const std::set<int>& regions) {
  const TetMesh& mesh = scene.mesh;
  out << "<Mesh>\n<Nodes name=\"body\">\n";
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n)
    out << fmt::format("<node id=\"{}\">{},{},{}</node>\n", n + 1, mesh.nodes[n].x(),
                       mesh.nodes[n].y(), mesh.nodes[n].z());
  out << "</Nodes>\n";
  const int width = mesh.order == 1 ? 4 : 10;
  for (const int region : regions) {
    out << fmt::format("<Elements type=\"tet{}\" name=\"region_{}\">\n", width, region);
    for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
      if (mesh.region[t] != region) continue;
      out << "<elem id=\"" << t + 1 << "\">";
      for (int k = 0; k < width; ++k) out << (k == 0 ? "" : ",") << mesh.tets[t][k] + 1;
      out << "</elem>\n";
    }
    out << "</Elements>\n";
  }
  std::vector<int> fixed;
  for (std::size_t n = 0; n < mesh.fixed.size(); ++n)
    if (mesh.fixed[n] != 0) fixed.push_back(static_cast<int>(n));
  write_set(out, "fixed", fixed);
  if (!scene.tool.empty()) write_set(out, "tool", scene.tool);
  out << "</Mesh>\n<MeshDomains>\n";
  for (const int region : regions)
    out << fmt::format("<SolidDomain name=\"region_{0}\" mat=\"region_{0}\"/>\n", region);
  out << "</MeshDomains>\n";
}

}  // namespace

void write_febio(std::ostream& out, const Scene& scene) {
  const std::set<int> regions(scene.mesh.region.begin(), scene.mesh.region.end());
  constexpr int kSteps = 100;  // from a relaxed body to the last row
  const double end = scene.t.empty() ? 1 : scene.t.back();
  out << "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
  write_xml_remarks(out, scene);
  out << "<febio_spec version=\"4.0\">\n"
      << "<Module type=\"solid\"/>\n<Control>\n<analysis>STATIC</analysis>\n"
      << fmt::format("<time_steps>{}</time_steps>\n<step_size>{:.12g}</step_size>\n", kSteps,
                     end / kSteps)
      << "<solver type=\"solid\"><dtol>1e-6</dtol><etol>1e-8</etol><rtol>0</rtol></solver>\n"
      << "</Control>\n<Material>\n";
  int id = 0;
  for (const int region : regions)
    out << fmt::format("<material id=\"{}\" name=\"region_{}\" {}</material>\n", ++id, region,
                       material(scene, scene.modulus_of(region)));
  out << "</Material>\n";
  write_mesh(out, scene, regions);
  out << "<Boundary>\n<bc name=\"support\" node_set=\"fixed\" type=\"zero displacement\">"
         "<x_dof>1</x_dof><y_dof>1</y_dof><z_dof>1</z_dof></bc>\n";
  for (int k = 0; k < 3 && !scene.tool.empty(); ++k)
    out << fmt::format(
        "<bc name=\"tool_{0}\" node_set=\"tool\" type=\"prescribed displacement\"><dof>{0}</dof>"
        "<value lc=\"{1}\">1</value><relative>0</relative></bc>\n",
        "xyz"[k], k + 1);
  out << "</Boundary>\n";
  if (!scene.tool.empty()) {
    out << "<LoadData>\n";
    for (int k = 0; k < 3; ++k) {
      out << fmt::format(
          "<load_controller id=\"{}\" type=\"loadcurve\"><interpolate>LINEAR</interpolate>"
          "<points><pt>0,0</pt>",
          k + 1);
      for (std::size_t i = 0; i < scene.t.size(); ++i)
        out << fmt::format("<pt>{:.12g},{:.12g}</pt>", scene.t[i], scene.u[i][k]);
      out << "</points></load_controller>\n";
    }
    out << "</LoadData>\n";
  }
  out << "<Output>\n<plotfile type=\"febio\"><var type=\"displacement\"/><var type=\"stress\"/>"
         "<var type=\"reaction forces\"/></plotfile>\n";
  if (!scene.tool.empty())
    out << "<logfile><node_data data=\"Rx;Ry;Rz\" node_set=\"tool\" "
           "file=\"tool.log\"/></logfile>\n";
  out << "</Output>\n</febio_spec>\n";
}

}  // namespace hapsim
