// Places for presses at which the tool really fits, and the presses there.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "experiment/setup_places.h"
#include "plan/press_plan.h"
#include "plan/spread_places.h"

namespace hapsim {

// What asks for the next `count` places among those that are left.
using PlaceChoice = std::function<std::vector<PressablePlace>(
    const std::vector<PressablePlace>& left, std::size_t count)>;

// `count` places as `choose` wants them, in its order, with the normals of the meshed contact; one
// at which the tool's disc cannot be meshed is left out and another asked for. `prepare` meshes and
// solves a place. Fewer where there are no more.
std::vector<PressablePlace> fitting_places(
    std::vector<PressablePlace> places, std::size_t count, const PlaceChoice& choose,
    const std::function<std::shared_ptr<const SetupPlaces>(const std::vector<Vec3>&)>& prepare);

// Of a full press at a place with that outward normal [m].
using DepthAt = std::function<double(const Vec3& point, const Vec3& normal)>;

// Presses at these places, one after the other, each along the path of its turn (path_in_turn());
// numbers from 1, times from 0.
MeasurementPlan presses_in_turn(const std::vector<PressablePlace>& places,
                                const std::vector<std::size_t>& turns, const DepthAt& depth,
                                double step);

// Numbers and times that go on after a recording's last press.
void go_on_after(const Recording& recording, MeasurementPlan& plan);

}  // namespace hapsim
