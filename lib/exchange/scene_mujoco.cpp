#include <fmt/format.h>

#include <Eigen/Eigenvalues>

#include "base/error.h"
#include "exchange/deck_error.h"

namespace hapsim {

void write_mujoco(std::ostream& out, const Scene& scene, const GradedPress& press, double radius) {
  if (!scene.terms.empty() || scene.finite)
    fail_input(
        scene.model_name,
        std::string("springs of MuJoCo have no ") + (scene.finite ? "finite strain" : "relaxation"),
        "give MuJoCo the force itself (share/examples/mujoco), or take the effect out of the "
        "model");
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(press.K);
  out << "<mujoco model=\"press\">\n";
  write_xml_remarks(out, scene);
  out << "<option gravity=\"0 0 0\"/>\n<worldbody>\n"
      << fmt::format("<body name=\"tool\" pos=\"{:.9g} {:.9g} {:.9g}\">\n", press.place.x(),
                     press.place.y(), press.place.z());
  for (int k = 0; k < 3; ++k) {
    const Vec3 axis = axes.eigenvectors().col(k);
    out << fmt::format(
        "<joint name=\"spring_{}\" type=\"slide\" axis=\"{:.12g} {:.12g} {:.12g}\" "
        "stiffness=\"{:.9g}\"/>\n",
        k + 1, axis.x(), axis.y(), axis.z(), axes.eigenvalues()[k]);
  }
  out << fmt::format(
      "<geom type=\"cylinder\" size=\"{0:.9g} {0:.9g}\" pos=\"0 0 {0:.9g}\" mass=\"0.02\" "
      "contype=\"0\" conaffinity=\"0\"/>\n<site "
      "name=\"tip\"/>\n</body>\n</worldbody>\n<keyframe>\n",
      radius);
  for (std::size_t i = 0; i < scene.t.size(); ++i) {
    const Vec3 q = axes.eigenvectors().transpose() * scene.u[i];
    out << fmt::format("<key time=\"{:.9g}\" qpos=\"{:.12g} {:.12g} {:.12g}\"/>\n", scene.t[i],
                       q.x(), q.y(), q.z());
  }
  out << "</keyframe>\n</mujoco>\n";
}

}  // namespace hapsim
