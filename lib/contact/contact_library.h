// The stiffness of a body at all its contact positions, prepared in parallel and cached.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/made_once.h"
#include "base/memo.h"
#include "contact/contact_cache.h"
#include "contact/contact_stiffness.h"
#include "contact/feature_estimate.h"
#include "contact/marker_solution.h"
#include "contact/tool_torque_solution.h"

namespace hapsim {

// Stiffness per unit Young's modulus of a homogeneous body at one position, as a smooth function of
// Poisson's ratio: Hermite interpolation of K/mu through solved values and derivatives, in
// (1 - 2 nu)^(1/3), the power of it in which three nodes from 0 to 0.499 err least (about 1e-4).
class UnitStiffness {
 public:
  void add(double nu, const Eigen::Matrix3d& K, const Eigen::Matrix3d& dK_dnu);
  // K and its derivative by nu [m]. Exact at the solved values.
  void evaluate(double nu, Eigen::Matrix3d& K, Eigen::Matrix3d& dK_dnu) const;
  std::size_t held_bytes() const { return hapsim::held_bytes(nodes_); }

 private:
  struct Node {
    double nu;
    Eigen::Matrix3d K, dK_dnu;
  };
  std::vector<Node> nodes_;
};

struct PreparedContact {
  Vec3 point, normal;  // on the surface; outward unit normal
  UnitStiffness stiffness;
  UnitStiffness coarse;           // of the coarser mesh
  double mesh_uncertainty = 0;    // relative, of the normal stiffness
  std::vector<float> plan_share;  // share of the strain energy by plan-view cell
  std::string unfit;              // not "": why the tool cannot press there; nothing else is known
  std::size_t held_bytes() const {
    return hapsim::held_bytes(stiffness) + hapsim::held_bytes(coarse) +
           hapsim::held_bytes(plan_share) + hapsim::held_bytes(unfit);
  }
};

struct ContactLibraryOptions {
  int threads = 0;             // 0: as many as the machine has
  std::string cache;           // directory, "" for none
  double rim_edge = kRimEdge;  // edge length at the tool's rim over its radius
  bool draft = false;          // materials that are not homogeneous on the coarser mesh
  // Where meshes and matrices of positions stay for the next material; several libraries may share
  // it. Changes no result.
  std::shared_ptr<Memo> memo = std::make_shared<Memo>();
  std::function<void()> step;  // called once a position is ready (from any thread)
};

// Of the body's numbered tetrahedra, for the description of a material with labels.
std::string labels_key(const TetMesh& body);

// Poisson's ratios at which a UnitStiffness of the range is solved: one where the ends are equal.
std::vector<double> poisson_nodes(double nu_low, double nu_high);

class ContactLibrary {
 public:
  ContactLibrary(const TetMesh& body, double tool_radius, const ContactLibraryOptions& options);

  // Prepares positions for Poisson's ratios in [nu_low, nu_high] (equal: that one only).
  // Error(kBadInput) names the position that is off the surface; one at which the tool's disc does
  // not fit is marked so.
  std::vector<PreparedContact> prepare(const std::vector<Vec3>& positions, double nu_low,
                                       double nu_high) const;
  // One solution a position for an inhomogeneous material or one with features; a draft is
  // corrected to the homogeneous stiffnesses of `contacts` (of the same positions). `description`
  // must determine `material.group_of` and `material.labels` (it names the cache entry). None may
  // be unfit.
  std::vector<StiffnessSolution> solve(const std::vector<Vec3>& positions,
                                       const std::vector<PreparedContact>& contacts,
                                       const Material& material,
                                       const std::string& description) const;

  // What the tool's torque is at each position, of a material without features; `description` as
  // solve(). Positions that prepare() calls unfit are not asked for.
  std::vector<TorqueSolution> torques(const std::vector<Vec3>& positions, const Material& material,
                                      const std::string& description) const;

  // How points of the surface move at each position, of a material without features;
  // `description` as solve().
  std::vector<MarkerSolution> markers(const std::vector<Vec3>& positions,
                                      const std::vector<Vec3>& points, const Material& material,
                                      const std::string& description) const;

  // The stiffness alone, on one mesh of each place;
  // nothing where the tool cannot be laid on or the place cannot be meshed. `keep`: the meshes stay
  // for later materials.
  std::vector<std::optional<SampledContact>> sample(const std::vector<Vec3>& places,
                                                    const Material& material,
                                                    const std::string& description,
                                                    ContactLevel level, bool keep) const;
  // One a face of surface().
  const std::vector<std::uint8_t>& bonded() const { return boundary_.face_class; }

  // What features do at each position, to first order.
  std::vector<std::shared_ptr<const FeatureEstimate>> estimates(
      const std::vector<Vec3>& positions) const;

  int threads() const { return options_.threads; }  // 0: as many as the machine has
  PlanGrid grid() const { return plan_grid(base().surface); }
  double tool_radius() const { return radius_; }                // [m]
  const Surface& surface() const { return boundary_.surface; }  // the body's, as it was given
  // Made when first asked for: where all contacts are found in the cache nobody does.
  const ContactBase& base() const;
  Memo& memo() const { return *options_.memo; }
  // The body's regions as its tetrahedra are numbered; null where all have 0.
  const std::shared_ptr<const BodyRegions>& labels() const { return labels_; }
  const std::string& labels_key() const { return labels_key_; }  // of their content
  // Of all that solutions depend on beside positions and material.
  const ContentHash& content() const { return content_; }

 private:
  using Solver = std::function<StiffnessSolution(ContactBodies&, std::size_t position)>;
  struct Task {
    ContentHash key;  // beyond the position's
    Solver solve;
  };
  // All tasks at all positions, in parallel; [position * tasks + task]. `keep`: the meshes stay for
  // later materials.
  std::vector<StiffnessSolution> solve_all(const std::vector<Vec3>& positions,
                                           const std::vector<Task>& tasks, bool keep) const;
  ContentHash key_of(const Material& material, const std::string& description) const;
  // Those that are kept, or fresh ones; the caller has them alone until they are put back.
  std::shared_ptr<ContactBodies> take_bodies(const Vec3& position) const;
  std::shared_ptr<ContactBodies> fresh_bodies(const Vec3& position) const;
  void put_bodies(const Vec3& position, std::shared_ptr<ContactBodies> bodies) const;
  std::string bodies_key(const Vec3& position) const;

  ClassedSurface boundary_;
  std::shared_ptr<const BodyRegions> labels_;
  std::string labels_key_;
  std::shared_ptr<const std::vector<Surface>> inner_;  // of the labels, that meshes can follow
  double radius_;
  ContactLibraryOptions options_;
  ContactCache cache_;
  ContentHash base_hash_, content_;
  MadeOnce<ContactBase> base_;
  MadeOnce<std::shared_ptr<const SurfaceTree>> free_surface_;
};

}  // namespace hapsim
