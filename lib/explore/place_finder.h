// Places for the next presses on a body, and how far apart those are that were pressed.
#pragma once

#include <memory>
#include <vector>

#include "explore/planned_places.h"
#include "plan/spread_places.h"

namespace hapsim {

struct PlaceRules {
  double tool_radius = 0;        // of the disc [m]
  double steepest = 0;           // between a place's normal and +z [rad]
  ExperimentOptions experiment;  // nu_low and nu_high as the model leaves them
};

class PlaceFinder {
 public:
  // Keeps `body` and `seen`.
  PlaceFinder(const TetMesh& body, const std::vector<Vec3>& window,
              const std::vector<SeenPlace>& seen, const PlaceRules& rules);
  // `count` places as `choose` wants them among those that are a tool's radius or more away from
  // all that were pressed (nearer, a press says the same again), and at which the tool fits, with
  // the normals of the meshed contact. Where that is found out by meshing, the next round finds it
  // in the cache.
  std::vector<PressablePlace> fresh(const PlaceChoice& choose, std::size_t count) const;
  // The places that were pressed, once more.
  std::vector<PressablePlace> pressed_again(std::size_t count) const;
  // How many of the places that could be pressed lie nearest to each that was, in their order.
  std::vector<double> shares() const;
  // How far the place that could be pressed and is farthest from all that were lies from the
  // nearest of them [m]; 0 where there is none.
  double widest_gap() const;

 private:
  std::shared_ptr<const SetupPlaces> prepare(const std::vector<Vec3>& positions) const;
  auto preparing() const {
    return [this](const std::vector<Vec3>& positions) { return prepare(positions); };
  }
  double to_nearest_pressed(const Vec3& p) const;

  const TetMesh& body_;
  const std::vector<SeenPlace>& seen_;
  PlaceRules rules_;
  std::vector<PressablePlace> all_;
  mutable std::shared_ptr<const ContactLibrary> library_;  // made when a place is meshed
};

}  // namespace hapsim
