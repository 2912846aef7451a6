// OFF, the surface format of Geomview.
#pragma once

#include <string>

#include "mesh/surface.h"

namespace hapsim {

// ASCII, polygons as fans; stray vertices are dropped. Error(kBadInput) with the line.
Surface parse_off(const std::string& bytes, const std::string& name);

}  // namespace hapsim
