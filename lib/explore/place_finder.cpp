#include "explore/place_finder.h"

#include <algorithm>
#include <limits>

#include "mesh/window.h"

namespace hapsim {

PlaceFinder::PlaceFinder(const TetMesh& body, const std::vector<Vec3>& window,
                         const std::vector<SeenPlace>& seen, const PlaceRules& rules)
    : body_(body),
      seen_(seen),
      rules_(rules),
      all_(pressable_places(boundary_surface(body), rules.tool_radius, rules.steepest)) {
  if (window.size() > 2)
    std::erase_if(all_, [&](const PressablePlace& p) { return !inside_window(window, p.point); });
}

std::shared_ptr<const SetupPlaces> PlaceFinder::prepare(const std::vector<Vec3>& positions) const {
  const ExperimentOptions& options = rules_.experiment;
  if (!library_) {
    ContactLibraryOptions own;
    own.threads = options.threads;
    own.cache = options.cache;
    own.rim_edge = options.rim_edge;
    own.draft = true;
    library_ = std::make_shared<const ContactLibrary>(body_, rules_.tool_radius, own);
  }
  return SetupPlaces::prepare(library_, positions, options.nu_low, options.nu_high);
}

double PlaceFinder::to_nearest_pressed(const Vec3& p) const {
  double least = std::numeric_limits<double>::infinity();
  for (const SeenPlace& s : seen_) least = std::min(least, (s.point - p).norm());
  return least;
}

std::vector<PressablePlace> PlaceFinder::fresh(const PlaceChoice& choose, std::size_t count) const {
  std::vector<PressablePlace> left = all_;
  std::erase_if(left, [&](const PressablePlace& p) {
    return to_nearest_pressed(p.point) < rules_.tool_radius;
  });
  return left.empty() ? left : fitting_places(std::move(left), count, choose, preparing());
}

std::vector<PressablePlace> PlaceFinder::pressed_again(std::size_t count) const {
  std::vector<PressablePlace> pressed;
  for (const SeenPlace& s : seen_) pressed.push_back({s.point, Vec3::UnitZ()});
  return fitting_places(
      std::move(pressed), count,
      [](std::vector<PressablePlace> left, std::size_t n) {
        left.resize(std::min(n, left.size()));
        return left;
      },
      preparing());
}

std::vector<double> PlaceFinder::shares() const {
  std::vector<double> shares(seen_.size(), 0);
  for (const PressablePlace& p : all_) {
    const auto nearer = [&](const SeenPlace& a, const SeenPlace& b) {
      return (a.point - p.point).squaredNorm() < (b.point - p.point).squaredNorm();
    };
    const auto nearest = std::min_element(seen_.begin(), seen_.end(), nearer);
    if (nearest != seen_.end()) ++shares[static_cast<std::size_t>(nearest - seen_.begin())];
  }
  return shares;
}

double PlaceFinder::widest_gap() const {
  double widest = 0;
  for (const PressablePlace& p : all_)
    if (!seen_.empty()) widest = std::max(widest, to_nearest_pressed(p.point));
  return widest;
}

}  // namespace hapsim
