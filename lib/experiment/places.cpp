#include "experiment/places.h"

#include <algorithm>

#include "base/median.h"
#include "mesh/window.h"

namespace hapsim {

Places::Places(const std::vector<std::shared_ptr<const ContactLibrary>>& libraries,
               const Dataset& dataset, double nu_low, double nu_high) {
  std::vector<std::vector<Vec3>> positions(libraries.size());
  auto place = std::make_shared<std::vector<Linearisation::Place>>();
  for (std::size_t p = 0; p < dataset.positions.size(); ++p) {
    const auto setup = static_cast<std::size_t>(dataset.setup_of[p]);
    place->push_back({setup, positions[setup].size()});
    positions[setup].push_back(dataset.positions[p]);
  }
  place_ = std::move(place);
  for (std::size_t s = 0; s < libraries.size(); ++s)
    setups_.push_back(SetupPlaces::prepare(libraries[s], positions[s], nu_low, nu_high));
}

Places Places::chosen(const std::vector<std::size_t>& places) const {
  std::vector<std::vector<std::size_t>> of_setup(setups_.size());
  auto place = std::make_shared<std::vector<Linearisation::Place>>();
  for (const std::size_t p : places) {
    const Linearisation::Place& old = (*place_)[p];
    place->push_back({old.setup, of_setup[old.setup].size()});
    of_setup[old.setup].push_back(old.position);
  }
  Places result;
  result.place_ = std::move(place);
  for (std::size_t s = 0; s < setups_.size(); ++s)
    result.setups_.push_back(setups_[s]->chosen(of_setup[s]));
  return result;
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

std::vector<ToolStand> Places::stands() const {
  std::vector<ToolStand> stands;
  for (const Linearisation::Place& place : *place_)
    stands.push_back(setups_[place.setup]->stand(place.position));
  return stands;
}

bool Places::has_labels(const MaterialSpec& material) const {
  return std::any_of(setups_.begin(), setups_.end(),
                     [&](const auto& setup) { return setup->labels_of(material) != nullptr; });
}

std::vector<int> Places::labels() const {
  std::vector<int> labels;
  for (std::size_t p = 0; p < size(); ++p) {
    const auto& of_body = setups_[(*place_)[p].setup]->labels();
    labels.push_back(of_body ? of_body->at(position(p)) : 0);
  }
  if (std::all_of(labels.begin(), labels.end(), [](int l) { return l == 0; })) labels.clear();
  return labels;
}

double Places::mesh_uncertainty() const {
  std::vector<double> values;
  for (std::size_t p = 0; p < size(); ++p) values.push_back(contact(p).mesh_uncertainty);
  return upper_median(std::move(values));
}

std::vector<double> Places::beyond_windows(const std::vector<std::vector<Vec3>>& windows) const {
  std::vector<double> doubt;
  if (std::all_of(windows.begin(), windows.end(), [](const auto& w) { return w.empty(); }))
    return doubt;
  std::vector<std::vector<char>> beyond;  // by setup and cell of its grid
  for (std::size_t s = 0; s < setups_.size(); ++s) {
    const PlanGrid grid = setups_[s]->grid();
    beyond.emplace_back(static_cast<std::size_t>(grid.columns) * grid.rows);
    for (std::size_t c = 0; c < beyond[s].size() && !windows[s].empty(); ++c)
      beyond[s][c] = !inside_window(windows[s], grid.centre(static_cast<int>(c)));
  }
  for (std::size_t p = 0; p < size(); ++p) {
    const std::vector<float>& share = contact(p).plan_share;
    double sum = 0;
    for (std::size_t c = 0; c < share.size(); ++c)
      if (beyond[(*place_)[p].setup][c]) sum += share[c];
    doubt.push_back(kGuessed * sum);
  }
  return doubt;
}

RigidMove Places::move() const {
  return setups_.size() == 1 ? setups_.front()->move() : RigidMove{};
}

}  // namespace hapsim
