#include "contact/element_groups.h"

#include <cmath>

namespace hapsim {

std::vector<BodyRegions::Growth> growths_of(const std::vector<BodyFeature>& features) {
  std::vector<BodyRegions::Growth> growths;
  for (const BodyFeature& f : features)
    if (f.kind == Feature::kGrowth)
      growths.push_back({static_cast<int>(std::lround(f.value[0])), f.value[1]});
  return growths;
}

ElementGroups::ElementGroups(const TetMesh& mesh, const Material& material, bool follows) {
  const std::vector<BodyRegions::Growth> growths = growths_of(material.features);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    if (material.labels && !follows) {
      for (BodyRegions::Part& p : material.labels->parts(mesh, t, growths))
        parts_.push_back({static_cast<std::size_t>(p.region), p.share, std::move(p.by_growth)});
      if (parts_.size() > first_.back() + 1) across_[t] = material.labels->across(mesh, t);
    } else {
      parts_.push_back({material.group_at(tet_centroid(mesh, t)), 1, {}});
    }
    first_.push_back(parts_.size());
  }
}

std::size_t ElementGroups::main_group(std::size_t tet) const {
  const Part* most = &parts_[first_[tet]];
  for (std::size_t i = first_[tet]; i < first_[tet + 1]; ++i)
    if (parts_[i].share > most->share) most = &parts_[i];
  return most->group;
}

}  // namespace hapsim
