#include "fit/marker_words.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/counted.h"

namespace hapsim {
namespace {

constexpr double kMostOfTold = 1.15, kMostOfMeasured = 1.3;  // as torques (torque_left.cpp)
constexpr double kStraight = 1.15;                           // of the noise that is declared

bool is_measured(const MarkerError& error) {
  return error.noise_origin != "declared";
}

}  // namespace

bool marker_explained(const MarkerError& e) {
  if (e.rows == 0) return true;
  return e.whitened <= std::max(is_measured(e) ? kMostOfMeasured : kMostOfTold, e.most_whitened);
}

std::vector<std::string> marker_facts(const MarkerError& e) {
  std::vector<std::string> facts{
      fmt::format("{} of {} count beside the forces: error {:.3g} mm = {:.3g} x noise ({:.3g} mm, "
                  "{}), {:.3g} of what noise and meshes let it be; rms {:.3g} mm",
                  counted(e.rows, "row", "rows"), counted(e.points, "point", "points"), 1e3 * e.rms,
                  e.rms / e.noise, 1e3 * e.noise, e.noise_origin, e.whitened, 1e3 * e.size)};
  if (!e.worst.empty())
    facts.push_back(
        fmt::format("point {} is off most, by {:.3g} mm rms", e.worst, 1e3 * e.worst_rms));
  if (!is_measured(e) && e.bent > kStraight)
    facts.push_back(
        fmt::format("{:.2g} x noise is left of whatever is in proportion to the tool's "
                    "displacement: look at the camera's clock, at slip, and at its noise",
                    e.bent));
  return facts;
}

}  // namespace hapsim
