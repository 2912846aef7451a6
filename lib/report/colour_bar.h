// The colours of a layer of the body, and the bar that explains them.
#pragma once

#include <array>
#include <cstddef>
#include <string>

#include "report/palette.h"
#include "report/report.h"

namespace hapsim {

// Of a value on the layer's scale; kKinds: of its number.
Rgb colour_of(const BodyLayer& layer, double value);
double bottom_of(const BodyLayer& layer);  // of its scale
// The six colours between which the viewer mixes.
std::array<Rgb, 6> stops_of(const BodyLayer& layer);
// An SVG; `number` tells it from others of the page, and all but number 0 begin hidden.
std::string colour_bar(const BodyLayer& layer, std::size_t number, int height);

}  // namespace hapsim
