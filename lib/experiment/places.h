// All places of an experiment, of whichever body and tool they are.
#pragma once

#include <memory>
#include <vector>

#include "experiment/dataset.h"
#include "experiment/linearisation.h"

namespace hapsim {

// Never changes; copies share what was prepared.
class Places {
 public:
  // libraries[s] is that of dataset.setups[s]. Prepares all positions for Poisson's ratios in
  // [nu_low, nu_high].
  Places(const std::vector<std::shared_ptr<const ContactLibrary>>& libraries,
         const Dataset& dataset, double nu_low, double nu_high);

  // Some of these places, in this order.
  Places chosen(const std::vector<std::size_t>& places) const;

  // The stiffness about a material, as SetupLinearisation says. All that is dear is done here.
  Linearisation solve(const MaterialSpec& material) const;
  // What is needed to ask for a material of other regions or features than `known` was solved for.
  Linearisation estimate(const MaterialSpec& material, const Linearisation& known = {}) const;

  int threads() const { return setups_.front()->threads(); }
  std::size_t size() const { return place_->size(); }  // positions
  std::size_t setups() const { return setups_.size(); }
  const std::shared_ptr<const SetupPlaces>& setup(std::size_t s) const { return setups_[s]; }
  const Linearisation::Place& place(std::size_t position) const { return (*place_)[position]; }
  const PreparedContact& contact(std::size_t position) const;
  const Vec3& position(std::size_t position) const;
  std::vector<ToolStand> stands() const;
  const std::string& unfit(std::size_t p) const { return contact(p).unfit; }
  // Whether the material's regions are the labels of one of the bodies (labels.h).
  bool has_labels(const MaterialSpec& material) const;
  // The label of the body at each position; empty where all are 0.
  std::vector<int> labels() const;
  double mesh_uncertainty() const;  // median over the positions, relative
  // How uncertain each stiffness is because the body beyond a window is a guess: the share of the
  // strain energy there, which is the relative change of the stiffness by the logarithm of the
  // modulus there, times kGuessed. Empty where there is no window.
  std::vector<double> beyond_windows(const std::vector<std::vector<Vec3>>& window_of_setup) const;
  // Whether what lies beyond a window is there at all, and how thick: a standard deviation of the
  // logarithm of its stiffness.
  static constexpr double kGuessed = 0.5;
  // The move that the contact points' distances from the surface show; none of several setups.
  RigidMove move() const;

 private:
  Places() = default;
  std::vector<std::shared_ptr<const SetupPlaces>> setups_;
  std::shared_ptr<const std::vector<Linearisation::Place>> place_;  // by position
};

}  // namespace hapsim
