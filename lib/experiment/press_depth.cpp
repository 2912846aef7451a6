#include "experiment/press_depth.h"

#include <fmt/format.h>

#include <limits>
#include <numeric>

#include "base/error.h"

namespace hapsim {
namespace {

void include(const SignedDistance& surface, const Recording& r, const std::vector<int>& rows,
             PressDepth& deepest) {
  WayThrough way(&surface);
  const Vec3* last = nullptr;  // contact point
  for (const int row : rows) {
    if (r.in_air(static_cast<std::size_t>(row))) continue;
    const Vec3 &point = r.position[row], &u = r.u[row];
    if (last == nullptr || *last != point) {
      const SurfaceSide side = surface.at(point);
      way.begin(side.point, side.normal);
      last = &point;
    }
    deepest.depth = std::max(deepest.depth, way.depth(u));
    const double share = way.share(u);
    if (share <= deepest.share) continue;
    deepest.share = share;
    deepest.row = row;
    if (share >= 1)
      fail_input(fmt::format("{}:{}", r.name, r.line[row]),
                 fmt::format("a displacement of {:.3g} m goes through the body, which is {:.3g} m "
                             "thick there",
                             u.norm(), u.norm() / share),
                 "correct or remove the row; all lengths are in metres");
  }
}

SignedDistance surface_of(const TetMesh& body) {
  return SignedDistance(boundary_surface(body), "body");
}

}  // namespace

PressDepth press_depth(const TetMesh& body, const Recording& recording) {
  PressDepth deepest;
  std::vector<int> rows(recording.rows());
  std::iota(rows.begin(), rows.end(), 0);
  include(surface_of(body), recording, rows, deepest);
  return deepest;
}

PressDepth press_depth(const std::vector<TetMesh>& bodies, const Dataset& dataset) {
  PressDepth deepest;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const SignedDistance surface = surface_of(bodies[b]);
    for (const Episode& e : dataset.episodes) {
      const int setup = dataset.setup_of[static_cast<std::size_t>(e.position)];
      if (dataset.setups[static_cast<std::size_t>(setup)].body == static_cast<int>(b))
        include(surface, dataset.recording, e.rows, deepest);
    }
  }
  return deepest;
}

double fitted_depth(const Model& model) {
  return model.metadata.number("depth", model.name)
      .value_or(std::numeric_limits<double>::infinity());
}

std::string beyond_depth(const PressDepth& depth, const Model& model, const Recording& recording) {
  if (depth.share > kValidShare)
    return fmt::format(
        "line {} goes {:.0f} % of the way through the body: beyond {:.0f} % these forces mean "
        "little",
        recording.line[depth.row], 100 * depth.share, 100 * kValidShare);
  const double fitted = fitted_depth(model);
  if (depth.depth > 1.001 * fitted)
    return fmt::format("presses go {:.3g} mm deep, and the model was fitted to {:.3g} mm",
                       1e3 * depth.depth, 1e3 * fitted);
  return "";
}

}  // namespace hapsim
