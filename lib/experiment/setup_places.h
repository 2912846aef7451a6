// The places where one body is pressed with one tool, prepared once and never changed.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "contact/contact_library.h"
#include "effects/effect.h"
#include "experiment/dataset.h"
#include "experiment/registration.h"

namespace hapsim {

// The finite-element solutions of all places for one material, from which others are extrapolated.
struct SolvedPlaces {
  MaterialSpec material;                     // its moduli over that of region 0
  std::vector<StiffnessSolution> solutions;  // by place
};
std::size_t held_bytes(const SolvedPlaces& solved);

using RegionShares = std::vector<std::vector<double>>;  // [place][region], sums to 1
using FeatureEstimates = std::vector<std::shared_ptr<const FeatureEstimate>>;  // by place

// What the tool's torque is at all places: of a homogeneous body at some Poisson's ratios, of one
// with regions for one material.
struct TorquePlaces {
  MaterialSpec material;  // of regions, its moduli over that of region 0; else as it was asked for
  std::vector<double> nu;
  std::vector<std::vector<TorqueSolution>> solutions;  // [nu][place]
};
std::size_t held_bytes(const TorquePlaces& torques);

// How points of the surface move, as TorquePlaces.
struct MarkerPlaces {
  MaterialSpec material;
  std::vector<double> nu;
  std::vector<std::vector<MarkerSolution>> solutions;  // [nu][place]
};
std::size_t held_bytes(const MarkerPlaces& markers);

// Where a body is pressed, and the homogeneous body there.
struct PreparedPlaces {
  std::vector<Vec3> positions;
  std::vector<PreparedContact> contacts;
};
std::size_t held_bytes(const PreparedPlaces& prepared);

// Everything it gives depends on its constructor's arguments and on what is asked alone. What is
// dear and constant (solutions, shares, estimates, moved bodies) is kept by content in the
// library's memo; keeping nothing costs time and changes no result. Safe for threads.
class SetupPlaces : public std::enable_shared_from_this<SetupPlaces> {
 public:
  // Prepares all positions for Poisson's ratios in [nu_low, nu_high].
  static std::shared_ptr<const SetupPlaces> prepare(std::shared_ptr<const ContactLibrary> library,
                                                    const std::vector<Vec3>& positions,
                                                    double nu_low, double nu_high);
  // The same body pressed by the same tool at other positions. Error(kNoConvergence) where the tool
  // does not fit.
  std::shared_ptr<const SetupPlaces> with_positions(const std::vector<Vec3>& positions) const;
  // Some of these places, in this order; one may be there several times.
  std::shared_ptr<const SetupPlaces> chosen(const std::vector<std::size_t>& places) const;
  // The body where it lay when it was scanned: its places under those pressed since it has moved.
  // Itself where the material has not moved.
  std::shared_ptr<const SetupPlaces> before_move(const MaterialSpec& material) const;

  // For a material that has not moved, whatever else it is.
  std::shared_ptr<const SolvedPlaces> solve(const MaterialSpec& material) const;
  // The tool's torques for a material without features, in its regions where it has any and
  // `regions` says so, else as if all were one.
  std::shared_ptr<const TorquePlaces> torques(const MaterialSpec& material, bool regions) const;
  // How points of the surface move, of a material as torques() has it.
  std::shared_ptr<const MarkerPlaces> markers(const MaterialSpec& material, bool regions,
                                              const std::vector<Vec3>& points) const;
  // Shares of the homogeneous body's strain energy in the material's regions.
  std::shared_ptr<const RegionShares> shares(const MaterialSpec& material) const;
  // What features do at each place, to first order.
  std::shared_ptr<const FeatureEstimates> estimates() const;

  int threads() const { return library_->threads(); }
  const std::vector<PreparedContact>& contacts() const { return prepared_->contacts; }
  const std::vector<Vec3>& positions() const { return prepared_->positions; }
  ToolStand stand(std::size_t place) const;
  const std::shared_ptr<const BodyRegions>& labels() const { return library_->labels(); }
  // The body's labels where they are the material's regions, else null (acting_labels()).
  std::shared_ptr<const BodyRegions> labels_of(const MaterialSpec& material) const;
  // Several moduli, each in its region of the body.
  bool has_regions(const MaterialSpec& material) const;
  bool same_regions(const MaterialSpec& a, const MaterialSpec& b) const;
  const Surface& surface() const { return library_->surface(); }
  PlanGrid grid() const { return library_->grid(); }  // of the contacts' plan_share
  // The move that the contact points' distances from the surface show.
  RigidMove move() const { return register_points(positions(), library_->surface()); }

 private:
  SetupPlaces(std::shared_ptr<const ContactLibrary> library,
              std::shared_ptr<const PreparedPlaces> prepared, double nu_low, double nu_high);
  std::shared_ptr<const SetupPlaces> of(std::shared_ptr<const PreparedPlaces> prepared) const;
  std::shared_ptr<const PreparedPlaces> prepare_at(const std::vector<Vec3>& positions) const;
  // The material as elements have it, its moduli over that of region 0. Refers to `material`.
  Material of_elements(const MaterialSpec& material) const;
  ContentHash layout(const MaterialSpec& material) const;
  std::string content(const MaterialSpec& material) const;
  // The value of that type for these places and what `about` says; made where it is not kept.
  template <class Value, class Make>
  std::shared_ptr<const Value> kept(const std::string& about, const Make& make) const;

  std::shared_ptr<const ContactLibrary> library_;
  std::shared_ptr<const PreparedPlaces> prepared_;
  double nu_low_, nu_high_;
  ContentHash content_;  // of all of these
};

bool has_moved(const MaterialSpec& material);
// The material as it is on the body that has not moved.
MaterialSpec in_place(const MaterialSpec& material);

}  // namespace hapsim
