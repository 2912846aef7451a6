#include "contact/element_groups.h"

namespace hapsim {

ElementGroups::ElementGroups(const TetMesh& mesh, const Material& material) {
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    if (material.labels) {
      for (const BodyRegions::Part& p : material.labels->parts(mesh, t))
        parts_.push_back({static_cast<std::size_t>(p.region), p.share});
    } else {
      const auto& n = mesh.tets[t];
      const Vec3 centre =
          (mesh.nodes[n[0]] + mesh.nodes[n[1]] + mesh.nodes[n[2]] + mesh.nodes[n[3]]) / 4;
      parts_.push_back({material.group_at(centre), 1});
    }
    first_.push_back(parts_.size());
  }
}

std::size_t ElementGroups::main_group(std::size_t tet) const {
  Part most{0, 0};
  for (std::size_t i = first_[tet]; i < first_[tet + 1]; ++i)
    if (parts_[i].share > most.share) most = parts_[i];
  return most.group;
}

}  // namespace hapsim
