// Location samples from a recording, thesis Algorithm 5.1.
#pragma once

#include "fit/fit.h"
#include "regions/location_file.h"

namespace hapsim {

// For each contact position by itself: E and nu fitted as if the whole body were of that material,
// all other parameters of `model` held and its regions left out. nu is held at the model's value,
// with nu_std 0 in all rows, when the model holds it or any position's presses alone do not
// determine it to 0.1 (normal presses hardly do). Positions whose fit fails are left out and
// counted in the metadata `failed`. Standard errors as fit()'s, with options.floor.
LocationTable fit_locations(const Model& model, const Experiment& experiment,
                            const FitOptions& options);

}  // namespace hapsim
