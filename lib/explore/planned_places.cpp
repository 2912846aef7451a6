#include "explore/planned_places.h"

#include <algorithm>

#include "plan/press_paths.h"

namespace hapsim {

std::vector<PressablePlace> fitting_places(
    std::vector<PressablePlace> places, std::size_t count, const PlaceChoice& choose,
    const std::function<std::shared_ptr<const SetupPlaces>(const std::vector<Vec3>&)>& prepare) {
  while (true) {
    const std::vector<PressablePlace> wanted = choose(places, count);
    std::vector<PressablePlace> fit;
    std::vector<Vec3> points, unfit;
    for (const PressablePlace& place : wanted) points.push_back(place.point);
    if (points.empty()) return fit;
    const std::shared_ptr<const SetupPlaces> there = prepare(points);
    for (std::size_t k = 0; k < points.size(); ++k) {
      if (there->contacts()[k].unfit.empty())
        fit.push_back({points[k], there->stand(k).normal});
      else
        unfit.push_back(points[k]);
    }
    if (unfit.empty()) return fit;
    std::erase_if(places, [&](const PressablePlace& p) {
      return std::find(unfit.begin(), unfit.end(), p.point) != unfit.end();
    });
  }
}

MeasurementPlan presses_in_turn(const std::vector<PressablePlace>& places,
                                const std::vector<std::size_t>& turns, const DepthAt& depth,
                                double step) {
  MeasurementPlan plan;
  double start = 0;
  for (std::size_t k = 0; k < places.size(); ++k) {
    const PressablePlace& place = places[k];
    const std::vector<PressPath> paths = press_paths(depth(place.point, place.normal));
    const PressPath& path = path_in_turn(paths, turns.at(k));
    plan.presses.push_back({path.name, place.point, 0});
    append_press(plan.motion, static_cast<int>(plan.presses.size()), start, step, place.point,
                 place.normal, path);
    start = plan.motion.t.back() + kPauseBetweenPresses;
  }
  return plan;
}

void go_on_after(const Recording& recording, MeasurementPlan& plan) {
  if (recording.rows() == 0) return;
  const int last = *std::max_element(recording.press.begin(), recording.press.end());
  for (int& press : plan.motion.press) press += last;
  if (recording.t.empty()) return;
  const double end = *std::max_element(recording.t.begin(), recording.t.end());
  for (double& t : plan.motion.t) t += end + kPauseBetweenPresses;
}

}  // namespace hapsim
