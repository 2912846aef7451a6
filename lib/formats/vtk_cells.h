// Numbers that VTK gives to types of cells, in files of either kind (VTK file formats, "Cell
// types").
#pragma once

namespace hapsim::vtk {

constexpr double kTetra = 10, kQuadraticTetra = 24;

// Cells with three dimensions that are left out.
inline bool is_other_volume(double type) {
  return (type >= 11 && type <= 16) || (type >= 25 && type <= 29) || type >= 32;
}

}  // namespace hapsim::vtk
