#include "experiment/contact_radius.h"

#include <algorithm>
#include <cmath>

#include "io/number.h"

namespace hapsim {
namespace {

constexpr const char* kKey = "contact_radius";
constexpr double kMargin = 1.1;  // of the radius: a first touch that was declared late
// Radii are R over powers of this, so that recordings of one ball and like depth share their
// prepared stiffnesses.
constexpr double kGrid = 1.189207115002721;  // the fourth root of 2

}  // namespace

void set_contact_radius(Recording& recording) {
  recording.metadata.remove(kKey);
  if (!recording.has_ball()) return;
  const double ball = recording.tool_radius();
  double deepest = 0;
  for (std::size_t row = 0; row < recording.rows(); ++row)
    if (!recording.in_air(row)) deepest = std::max(deepest, recording.u[row].norm());
  const double widest = kMargin * std::sqrt(ball * deepest);
  if (!(widest > 0 && widest < ball)) return;
  const double steps = std::floor(std::log(ball / widest) / std::log(kGrid));
  if (steps > 0) recording.metadata.set(kKey, format_number(ball * std::pow(kGrid, -steps)));
}

void set_contact_radius(Recording& recording, const Model& model) {
  recording.metadata.remove(kKey);
  if (const auto radius = model.metadata.find(kKey)) recording.metadata.set(kKey, *radius);
}

double contact_radius(const Model& model, double tool_radius) {
  return model.metadata.number(kKey, model.name).value_or(tool_radius);
}

}  // namespace hapsim
