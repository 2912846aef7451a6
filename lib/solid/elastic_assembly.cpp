#include "solid/elastic_assembly.h"

#include <cassert>

namespace hapsim {

Cliques element_cliques(const TetMesh& mesh) {
  const std::ptrdiff_t count = mesh.order == 1 ? 4 : 10;
  Cliques cliques;
  cliques.start.reserve(mesh.tets.size() + 1);
  cliques.node.reserve(mesh.tets.size() * static_cast<std::size_t>(count));
  for (const auto& tet : mesh.tets) {
    cliques.node.insert(cliques.node.end(), tet.begin(), tet.begin() + count);
    cliques.start.push_back(static_cast<int>(cliques.node.size()));
  }
  return cliques;
}

Eigen::MatrixXd element_matrix(const TetMesh& mesh, std::size_t tet, const Lame& constants,
                               Dilatation dilatation) {
  const int count = mesh.order == 1 ? 4 : 10;
  const ElementStiffness element(mesh, tet, constants, dilatation);
  Eigen::MatrixXd dense(3 * count, 3 * count);
  for (int a = 0; a < count; ++a)
    for (int b = 0; b <= a; ++b) {
      const Eigen::Matrix3d k = element.block(a, b);
      dense.block<3, 3>(3 * a, 3 * b) = k;
      dense.block<3, 3>(3 * b, 3 * a) = k.transpose();
    }
  return dense;
}

void assemble_elastic(NodeSystem& system, const TetMesh& mesh, const std::vector<Lame>& lame_of_tet,
                      Dilatation dilatation) {
  assert(lame_of_tet.size() == mesh.tets.size());
  system.clear();
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    system.add(t, element_matrix(mesh, t, lame_of_tet[t], dilatation));
}

}  // namespace hapsim
