// A smooth field over the body, learned from what each place asks for.
#pragma once

#include <ostream>
#include <vector>

#include "effects/place_field.h"
#include "experiment/forces.h"
#include "mesh/surface.h"

namespace hapsim {

// Fewer places do not tell how smooth a field is.
inline constexpr std::size_t kLeastPlaces = 20;

// The model has a field that fits learn: its places are derived. A field that is held stays as it
// is.
bool learns_field(const Model& model);
// As it is before anything was learned.
void forget_field(Model& model);
// Learns the field of a model that learns_field() from the chosen episodes, `about` being its
// material's stiffness. What each place asks for, the factor of the model's force without the field
// and the power of the depth on top, is the likeliest under the sensor's noise (or what such two
// numbers leave, where that is larger) and a wide prior; both are then interpolated by kriging. The
// mean of the factor goes into the modulus where that is free. `keep_scales`: lengths and nuggets
// stay as they are, if they have been learned. Of fewer than ten places nothing is learned.
void learn_field(Model& model, const Experiment& experiment, const Linearisation& about,
                 const Selection& selection, double noise, bool keep_scales);

// The field of a model, which must have one.
PlaceField place_field(const Model& model);
// What a field says of a place that was never pressed, each place's own part (nugget) included.
struct FieldAt {
  double log_factor = 0, log_factor_sd = 0;  // at the field's depth
  double power = 0, power_sd = 0;            // of the depth
};
std::vector<FieldAt> field_at(const PlaceField& field, const std::vector<Vec3>& places);
// x,y,z,pressed,factor,low,high,power,power_sd: the factor with its 95 % band, at the pressed
// places (1) and at the vertices of a surface (0).
void write_field(std::ostream& out, const PlaceField& field, const Surface& surface);

}  // namespace hapsim
