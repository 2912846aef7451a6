#include "experiment/body_stiffness.h"

#include <algorithm>

#include "base/median.h"

namespace hapsim {

BodyStiffness::BodyStiffness(const std::vector<std::unique_ptr<ContactLibrary>>& libraries,
                             const Dataset& dataset, double nu_low, double nu_high) {
  std::vector<std::vector<Vec3>> positions(libraries.size());
  for (std::size_t p = 0; p < dataset.positions.size(); ++p) {
    const auto setup = static_cast<std::size_t>(dataset.setup_of[p]);
    place_.push_back({setup, positions[setup].size()});
    positions[setup].push_back(dataset.positions[p]);
  }
  for (std::size_t s = 0; s < libraries.size(); ++s)
    setups_.push_back(
        std::make_unique<SetupStiffness>(*libraries[s], positions[s], nu_low, nu_high));
}

PositionStiffness BodyStiffness::at(std::size_t position, const MaterialSpec& material) const {
  const Place& place = place_[position];
  return setups_[place.setup]->at(place.position, material);
}

void BodyStiffness::solve(const MaterialSpec& material) const {
  for (const auto& setup : setups_) setup->solve(material);
}

bool BodyStiffness::is_solved(const MaterialSpec& material) const {
  return std::all_of(setups_.begin(), setups_.end(),
                     [&](const auto& setup) { return setup->is_solved(material); });
}

void BodyStiffness::forget(const MaterialSpec& material) const {
  for (const auto& setup : setups_) setup->forget(material);
}

const PreparedContact& BodyStiffness::contact(std::size_t position) const {
  const Place& place = place_[position];
  return setups_[place.setup]->contacts()[place.position];
}

const Vec3& BodyStiffness::position(std::size_t position) const {
  const Place& place = place_[position];
  return setups_[place.setup]->positions()[place.position];
}

std::vector<Vec3> BodyStiffness::normals() const {
  std::vector<Vec3> normals;
  for (std::size_t p = 0; p < size(); ++p) normals.push_back(contact(p).normal);
  return normals;
}

double BodyStiffness::mesh_uncertainty() const {
  std::vector<double> values;
  for (std::size_t p = 0; p < size(); ++p) values.push_back(contact(p).mesh_uncertainty);
  return upper_median(std::move(values));
}

RigidMove BodyStiffness::move() const {
  return setups_.size() == 1 ? setups_.front()->move() : RigidMove{};
}

}  // namespace hapsim
