// Which groups of a material the elements of a mesh are of.
#pragma once

#include <cmath>
#include <cstddef>
#include <map>
#include <utility>
#include <vector>

#include "contact/contact_stiffness.h"
#include "mesh/tetmesh.h"

namespace hapsim {

// Of a material's features those that grow a region of its labels, in their order.
std::vector<BodyRegions::Growth> growths_of(const std::vector<BodyFeature>& features);

// Shares of each element's volume by group, which sum to 1: one group each unless the material's
// groups are the body's labels, of which an element at a boundary has several.
class ElementGroups {
 public:
  // `follows`: elements end at the boundaries of the labels, so that their middles tell.
  ElementGroups(const TetMesh& mesh, const Material& material, bool follows = false);

  struct Part {
    std::size_t group = 0;
    double share = 1;
    std::vector<double> by_growth;  // its derivative by each growth of the material's labels [1/m]
    std::size_t held_bytes() const { return hapsim::held_bytes(by_growth); }
  };
  // Calls visit(group, share) for each group of an element.
  template <class Visit>
  void for_each(std::size_t tet, const Visit& visit) const {
    for (std::size_t i = first_[tet]; i < first_[tet + 1]; ++i)
      visit(parts_[i].group, parts_[i].share);
  }
  // One modulus of the mixture [Pa], which tends to sharp boundaries as the mesh is refined, where
  // a laminate (element_mixture.h) cannot be had: the geometric mean by volume (Lichtenecker, Phys.
  // Z. 27, 1926), between those in parallel and in series. Of one group it is that group's own.
  double modulus(std::size_t tet, const std::vector<double>& of_group) const {
    if (first_[tet + 1] == first_[tet] + 1) return of_group[parts_[first_[tet]].group];
    double sum = 0;
    for_each(tet,
             [&](std::size_t group, double share) { sum += share * std::log(of_group[group]); });
    return std::exp(sum);
  }
  // Its derivative by the logarithm of a group's modulus is the share; by a growth, numbered as
  // such features stand in the material [Pa/m]:
  double modulus_by_growth(std::size_t tet, const std::vector<double>& of_group,
                           std::size_t growth) const {
    double sum = 0;
    for (std::size_t i = first_[tet]; i < first_[tet + 1]; ++i)
      if (growth < parts_[i].by_growth.size())
        sum += parts_[i].by_growth[growth] * std::log(of_group[parts_[i].group]);
    return sum * modulus(tet, of_group);
  }
  // Calls visit(group, derivative of its share [1/m]) by a growth, numbered as above.
  template <class Visit>
  void for_each_growth(std::size_t tet, std::size_t growth, const Visit& visit) const {
    for (std::size_t i = first_[tet]; i < first_[tet + 1]; ++i)
      if (growth < parts_[i].by_growth.size()) visit(parts_[i].group, parts_[i].by_growth[growth]);
  }
  // Unit normals of the boundaries in an element of several groups, with weights that sum to 1.
  const std::vector<std::pair<Vec3, double>>& across(std::size_t tet) const {
    return across_.at(tet);
  }
  // The group of the largest share.
  std::size_t main_group(std::size_t tet) const;
  std::size_t held_bytes() const { return hapsim::held_bytes(first_) + hapsim::held_bytes(parts_); }

 private:
  std::vector<std::size_t> first_{0};  // of parts_, by element, and the end
  std::vector<Part> parts_;
  std::map<std::size_t, std::vector<std::pair<Vec3, double>>> across_;  // by element
};

}  // namespace hapsim
