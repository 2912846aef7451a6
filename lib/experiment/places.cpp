#include "experiment/places.h"

#include "base/median.h"

namespace hapsim {

Places::Places(const std::vector<std::shared_ptr<const ContactLibrary>>& libraries,
               const Dataset& dataset, double nu_low, double nu_high, std::size_t kept) {
  std::vector<std::vector<Vec3>> positions(libraries.size());
  auto place = std::make_shared<std::vector<Linearisation::Place>>();
  for (std::size_t p = 0; p < dataset.positions.size(); ++p) {
    const auto setup = static_cast<std::size_t>(dataset.setup_of[p]);
    place->push_back({setup, positions[setup].size()});
    positions[setup].push_back(dataset.positions[p]);
  }
  place_ = std::move(place);
  for (std::size_t s = 0; s < libraries.size(); ++s)
    setups_.push_back(SetupPlaces::prepare(libraries[s], positions[s], nu_low, nu_high, kept));
}

Linearisation Places::solve(const MaterialSpec& material) const {
  std::vector<SetupLinearisation> solved;
  for (const auto& setup : setups_) solved.push_back(SetupLinearisation::solve(setup, material));
  return {place_, std::move(solved)};
}

Linearisation Places::estimate(const MaterialSpec& material, const Linearisation& known) const {
  std::vector<SetupLinearisation> ready;
  for (std::size_t s = 0; s < setups_.size(); ++s)
    ready.push_back(SetupLinearisation::estimate(setups_[s], material,
                                                 known.empty() ? nullptr : &known.setup(s)));
  return {place_, std::move(ready)};
}

const PreparedContact& Places::contact(std::size_t position) const {
  const Linearisation::Place& place = (*place_)[position];
  return setups_[place.setup]->contacts()[place.position];
}

const Vec3& Places::position(std::size_t position) const {
  const Linearisation::Place& place = (*place_)[position];
  return setups_[place.setup]->positions()[place.position];
}

std::vector<Vec3> Places::normals() const {
  std::vector<Vec3> normals;
  for (std::size_t p = 0; p < size(); ++p) normals.push_back(contact(p).normal);
  return normals;
}

double Places::mesh_uncertainty() const {
  std::vector<double> values;
  for (std::size_t p = 0; p < size(); ++p) values.push_back(contact(p).mesh_uncertainty);
  return upper_median(std::move(values));
}

RigidMove Places::move() const {
  return setups_.size() == 1 ? setups_.front()->move() : RigidMove{};
}

}  // namespace hapsim
