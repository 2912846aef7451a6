// What of a body and of its motion a model was fitted to: beyond that its forces are a guess.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "experiment/dataset.h"
#include "io/metadata.h"

namespace hapsim {

// Infinite, or empty, where the model does not say.
struct FittedRange {
  double depth = std::numeric_limits<double>::infinity();  // deepest displacement [m]
  double speed = std::numeric_limits<double>::infinity();  // fastest in contact (ToolSpeed) [m/s]
  std::vector<Vec3> places;                                // that were pressed [m]
  // These stand for others as far as this from one of them [m]; 0: they are all.
  double covers = 0;
  // So far from one of them a place is still among them [m].
  double reach = std::numeric_limits<double>::infinity();

  // No allocation; what was fitted to itself is within, whatever its numbers were rounded to.
  bool has_depth(double d) const noexcept { return d <= kRounded * depth; }
  bool has_speed(double v) const noexcept { return v <= kRounded * speed; }
  bool has_place(const Vec3& point) const noexcept;

 private:
  static constexpr double kRounded = 1.001;
};

// Of a model's metadata depth, speed, places (x y z of one after the other), covers and reach.
// Error(kBadInput) with the model's name: they are no such numbers.
FittedRange fitted_range(const Metadata& metadata, const std::string& name);

// What fitted_range() reads, but for the depth, of which PressDepth tells. Of many places so many
// that lie apart stand for the others; reach is what nine in ten places have to their next one, and
// two tool radii at least. No speed of recordings without times; no places of several bodies, which
// have a frame each.
void record_range(const Dataset& dataset, Metadata& metadata);

// How fast a tool in contact moves, over ways of kTime at least: what a sensor of position
// scatters from sample to sample is not motion.
class ToolSpeed {
 public:
  static constexpr double kTime = 0.01;  // [s]
  void restart() noexcept { begun_ = false; }
  // At time t [s] displaced by u [m]: of the last whole way [m/s], 0 before the first.
  double add(double t, const Vec3& u) noexcept;

 private:
  bool begun_ = false;
  double t_ = 0, speed_ = 0;
  Vec3 u_ = Vec3::Zero();
};

}  // namespace hapsim
