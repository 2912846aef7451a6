// The surface of what is brighter than a threshold in a volume.
#pragma once

#include <cstddef>

#include "mesh/surface.h"
#include "volume/volume.h"

namespace hapsim {

struct IsoOptions {
  double threshold = 0;    // the body is where values reach it
  bool below = false;      // ... or stay below it
  bool all_parts = false;  // not the largest connected part only
  bool cavities = false;   // surfaces of cavities too
};

struct IsoReport {
  std::size_t voxels = 0;  // of the body
  std::size_t parts = 0;   // connected parts brighter than the threshold
  double share = 0;        // of those voxels in the body
  std::size_t cut = 0;     // voxels of the body at the volume's border: it is cut there
  double memory = 0;       // most that volume and working space took [bytes]
};

// Points where the values cross the threshold along the edges between neighbouring voxel centres
// (linear in between, so exact to a small part of a voxel), with outward unit normals against the
// gradient: central differences at both voxels, interpolated alike and brought to the world by the
// inverse transpose of the voxel axes. Parts are connected across voxel faces. Error(kBadInput,
// name): nothing or everything lies on one side. Memory: 1 byte a voxel besides the volume, and
// 16 bytes a run of equal voxels.
PointCloud isosurface(const Volume& volume, const IsoOptions& options, const std::string& name,
                      IsoReport& report);

}  // namespace hapsim
