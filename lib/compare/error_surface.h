// A body's surface coloured by its error, for other programs.
#pragma once

#include "compare/error_map.h"
#include "containers/ply.h"

namespace hapsim {

// Vertices with colours (error_colour() of error / top) and the error itself [N]; beyond the map's
// reach grey, and NaN.
PlyFile coloured_ply(const ErrorMap& map, double top);

}  // namespace hapsim
