// What the elements of a mesh are made of where boundaries of groups and zones cut them.
#pragma once

#include <memory>
#include <vector>

#include "contact/element_groups.h"
#include "contact/featured_body.h"
#include "material/unit_law.h"
#include "mesh/surface_tree.h"
#include "solid/element_moments.h"
#include "solid/laminate.h"

namespace hapsim {

// Of each element the law H (D + kappa 1 1') + sum over the boundaries k in it of c_k P_k:
// laminates along the boundaries (laminate.h). What several cut apart is taken as independent: H
// and A are products of those of each, and c_k = (A - H) L_k / L with L_k = log(A_k / H_k), L their
// sum.
class ElementMixture {
 public:
  // All that is given must outlive it.
  ElementMixture(const TetMesh& mesh, const Material& material, const ElementGroups& groups,
                 const std::shared_ptr<const SurfaceTree>& free_surface, const UnitLaw& law);

  double scale(std::size_t tet) const { return elements_[tet].scale; }  // H [Pa]
  // sum c_k P_k [Pa]; null where no boundary cuts it.
  const VoigtMatrix* beyond(std::size_t tet) const {
    return elements_[tet].cuts.empty() ? nullptr : &elements_[tet].beyond;
  }
  // Adds an element's energies, and their derivatives, to K, by_modulus, by_feature and those by
  // the law's own constants (UnitLaw::D_by; one a derivative).
  void add(std::size_t tet, const FieldMoments& moments, FeaturedBody::Solution& solution,
           std::vector<Eigen::Matrix3d>& by_law) const;

 private:
  struct Cut {
    double contrast = 0;                          // L_k
    Eigen::RowVectorXd contrast_by;               // by the values of its feature, or the moduli
    std::vector<std::pair<Vec3, double>> across;  // normals and their weights, which sum to 1
    VoigtMatrix plane = VoigtMatrix::Zero();      // P_k
    std::vector<VoigtMatrix> plane_by;            // as contrast_by; empty: does not move
    std::size_t feature = 0;                      // the material's, or kGroups
    std::vector<std::pair<std::size_t, double>> growths;  // L_k by that of these features [1/m]
  };
  struct Element {
    double scale = 1, contrast = 0;  // H, L
    VoigtMatrix beyond = VoigtMatrix::Zero();
    std::vector<Cut> cuts;
    // Derivatives of log H that are not zero: feature or kGroups, value, derivative.
    struct Slope {
      std::size_t feature, value;
      double by;
    };
    std::vector<Slope> slopes;
  };
  void add_groups(std::size_t tet, Element& element) const;
  void add_zone(std::size_t tet, std::size_t feature, const LevelSet& level, double share,
                const Eigen::RowVectorXd& share_by, Element& element) const;
  static double weight(const Element& element, const Cut& cut);  // c_k

  const TetMesh& mesh_;
  const Material& material_;
  const ElementGroups& groups_;
  const UnitLaw& law_;
  PlaneLaw plane_;
  std::vector<Element> elements_;
};

}  // namespace hapsim
