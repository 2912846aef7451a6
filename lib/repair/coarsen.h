// Fewer and larger, or more and smaller triangles for the same body.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "mesh/surface.h"

namespace hapsim {

struct CoarsenOptions {
  double tolerance =
      0.06;  // distance from the old surface a collapse may cost, over the edge length
  double outline_tolerance = 0.01;  // the same for the outline between classes
  double volume_tolerance = 0.005;  // relative
};

// A surface whose faces carry a class, 0 or 1 (say, bonded): the outline between them is kept.
struct ClassedSurface {
  Surface surface;
  std::vector<std::uint8_t> face_class;  // one a face
};

// Edge collapse with Lindstrom and Turk's volume-preserving placement (IEEE Visualization 1998)
// until edges are about edge(p) long [m] at the place p, finer where the surface bends; the outline
// between the classes loses vertices only where it runs straight. Never refines. The result is
// closed, free of self-intersections and has the input's volume within the tolerance: where a
// collapse this far breaks that, 0.7 of the edge length is tried, and so on; in the end the input
// is returned. Deterministic. `surface` must have passed check_surface(). Error(kBadInput) when it
// is no manifold.
ClassedSurface coarsen_surface(const ClassedSurface& surface,
                               const std::function<double(const Vec3&)>& edge,
                               const CoarsenOptions& options = {});

// Bisects longest edges until none is longer than limit(p) [m] at its middle p (Rivara 1984); the
// shape is unchanged.
ClassedSurface split_long_edges(const ClassedSurface& surface,
                                const std::function<double(const Vec3&)>& limit);

}  // namespace hapsim
