#include <CGAL/Advancing_front_surface_reconstruction.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <array>
#include <iterator>

#include "base/error.h"
#include "reconstruct/raw_surface.h"

namespace hapsim {

Surface advancing_front(const std::vector<Vec3>& points) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  std::vector<Kernel::Point_3> samples;
  for (const Vec3& p : points) samples.emplace_back(p.x(), p.y(), p.z());
  std::vector<std::array<std::size_t, 3>> facets;
  CGAL::advancing_front_surface_reconstruction(samples.begin(), samples.end(),
                                               std::back_inserter(facets));
  Surface surface;
  surface.vertices = points;
  for (const auto& f : facets) {
    surface.faces.push_back(
        {static_cast<int>(f[0]), static_cast<int>(f[1]), static_cast<int>(f[2])});
  }
  if (surface.faces.empty()) {
    fail_numerics("", "the advancing front found no triangle", "use --method poisson or height");
  }
  return surface;
}

}  // namespace hapsim
