// Stiffness of a body against a bonded rigid flat tool at one position, with the error of the mesh
// stated.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "material/body_features.h"
#include "mesh/surface_tree.h"
#include "solid/body_regions.h"
#include "solid/elasticity.h"
#include "tetmesh/contact_mesh.h"

namespace hapsim {

// A body's material: one Poisson's ratio, Young's modulus by group of elements, and features. A
// homogeneous body has one group, neither `group_of` nor `labels`, and no features.
struct Material {
  double nu = 0.3;
  std::vector<double> modulus{1.0};          // [Pa], one a group
  std::function<int(const Vec3&)> group_of;  // group of an element by its centroid [m]
  std::vector<BodyFeature> features;
  // Groups are the body's own regions, of which a cut element has its shares (BodyRegions::parts);
  // null: by `group_of`.
  std::shared_ptr<const BodyRegions> labels = nullptr;
  bool has_groups() const { return group_of || labels; }
  // At a point; 0 without groups.
  std::size_t group_at(const Vec3& p) const {
    return static_cast<std::size_t>(labels ? labels->at(p) : group_of ? group_of(p) : 0);
  }
};

// A regular grid over the body in plan view, on which the share of the energy is kept.
struct PlanGrid {
  double x0 = 0, y0 = 0, step_x = 1, step_y = 1;  // [m]
  int columns = 0, rows = 0;
  int cell(const Vec3& p) const;  // clamped to the grid
  Vec3 centre(int cell) const;    // z = 0
};
PlanGrid plan_grid(const Surface& surface, int cells_along = 96);

// K u is the force that moves the tool by u; the body's force on the tool is -K u [N].
struct StiffnessSolution {
  Eigen::Matrix3d K;                         // [N/m]
  Eigen::Matrix3d dK_dnu;                    // [N/m]
  std::vector<Eigen::Matrix3d> dK_dmodulus;  // [m], one a group: sum of modulus * derivative is K
  // By the values of each feature [N/m over the value's unit].
  std::vector<std::vector<Eigen::Matrix3d>> dK_dfeature;
  Eigen::Matrix3d coarse_change;  // K of the coarser mesh minus K [N/m]
  Eigen::Matrix3d coarse_dK_dnu;  // of the coarser mesh [N/m]
  // FeaturedBody::Solution::mixed, 0 where no boundary cuts elements [N/m].
  Eigen::Matrix3d mixed = Eigen::Matrix3d::Zero();
  Vec3 point, normal;             // of the contact on the surface
  std::string unfit;              // why there is none (ContactUnfit); "": there is
  std::vector<float> plan_share;  // share of the strain energy by cell of the grid
  std::size_t held_bytes() const {
    return hapsim::held_bytes(dK_dmodulus) + hapsim::held_bytes(dK_dfeature) +
           hapsim::held_bytes(unfit) + hapsim::held_bytes(plan_share);
  }
};

// The finer mesh of a position has this edge length at the tool's rim, as a share of the radius,
// and edges that grow by kGrowth with the distance from it; the coarser one has kCoarser times
// both, so the pair is one family. Quarter points at the rim follow its stress singularity and the
// mean dilatation keeps the elements from locking: on blocks, balls and lumps the normal stiffness
// is within 0.4 % of the converged one for nu from 0.3 to 0.49, within 1.3 % for nu = 0, where the
// coarser mesh shows it (bench_contact_accuracy). Extrapolating the pair makes that no better.
constexpr double kRimEdge = 1.0 / 6;
constexpr double kGrowth = 0.4;
constexpr double kCoarser = 1.5;
// Of the meshes that are for samples between which the stiffness is interpolated: an eighth of the
// finer one's cost, and within some 0.6 % of it but for a common factor.
constexpr double kSampled = 2;
// Relative uncertainty of the normal stiffness [-]: a bound that the error keeps in 95 of 100.
double mesh_uncertainty(const StiffnessSolution& solution);
// The same of what elements do that boundaries cut; 0 where none are cut.
double mixture_uncertainty(const StiffnessSolution& solution);

// Which mesh of a position.
enum class ContactLevel { kFine, kCoarse, kSample };

struct SampledContact {
  Vec3 point, normal;  // on the surface [m]; outward, unit
  Eigen::Matrix3d K;   // [N/m]
};

// The homogeneous body of E = 1 at one Poisson's ratio: stiffness and its derivative by nu [m].
struct UnitPair {
  Eigen::Matrix3d K, by_nu;
};

// The outer surface without its bonded part, for a skin.
std::shared_ptr<const SurfaceTree> free_surface(const ContactBase& base);

class FeatureEstimate;
class FeaturedBody;
struct TorqueSolution;
struct MarkerSolution;

// The meshes of a position, made when first needed, to be solved for several materials. For labels
// that do not grow, elements end at their boundaries where those are `inner`
// (BodyRegions::enclosed) and can be meshed so; else they are laminates where boundaries cut them.
class ContactBodies {
 public:
  ContactBodies(const ContactBase& base, const Vec3& contact, double radius,
                double rim_edge = kRimEdge, std::shared_ptr<const SurfaceTree> surface = nullptr,
                std::shared_ptr<const std::vector<Surface>> inner = nullptr);
  ~ContactBodies();
  // A material without features. Derivatives come from the element energies of the three unit
  // fields: no further solution.
  StiffnessSolution solve(const Material& material, const PlanGrid& grid);
  // Of E = 1 at one of the Poisson's ratios `nus`, all of which one factorisation a mesh serves
  // (solid/poisson_sweep.h; kept for the others); shares of the energy at the middle one alone.
  StiffnessSolution solve_unit(const std::vector<double>& nus, std::size_t which,
                               const PlanGrid& grid);
  // Any material on the finer mesh; no shares of the energy.
  StiffnessSolution solve_featured(const Material& material);
  // The same on the coarser mesh, at a third of the cost: what inhomogeneity does is smooth, and
  // the rim's error is that of the homogeneous body, K = S K_coarse S' with S the map that takes
  // the coarse homogeneous stiffness to the fine one, both at the material's Poisson's ratio. Errs
  // by up to 2 % where two regions differ by a factor of three.
  StiffnessSolution solve_corrected(const Material& material, const UnitPair& fine,
                                    const UnitPair& coarse);
  // The stiffness alone on one mesh, of any material.
  SampledContact sample(const Material& material, ContactLevel which);
  void forget_systems();  // that the last two keep
  // What the tool's torque is, of a material without features, on both meshes
  // (contact/tool_torque_solution.h).
  TorqueSolution torque(const Material& material);
  // How points of the surface move, of a material without features, on both meshes
  // (contact/marker_solution.h).
  MarkerSolution markers(const Material& material, const std::vector<Vec3>& points);
  // What features do to the homogeneous body of this Poisson's ratio, from the coarser mesh, which
  // it shares.
  std::shared_ptr<const FeatureEstimate> estimate(double poisson_ratio);
  std::size_t held_bytes() const;  // meshes and matrices; not the surface

 private:
  struct Level;
  Level& level(int k, bool follow = false);
  bool follows(const Material& material) const;
  const ContactBase& base_;
  Vec3 contact_;
  double radius_, rim_edge_;
  std::shared_ptr<const SurfaceTree> surface_;
  std::shared_ptr<const std::vector<Surface>> inner_;
  FeaturedBody& featured(int k, bool follow);
  // By whether they follow `inner_`, and by ContactLevel.
  std::unique_ptr<FeaturedBody> featured_[2][3];
  std::unique_ptr<Level> levels_[2][3];
  bool cannot_follow_[3] = {};
};

}  // namespace hapsim
