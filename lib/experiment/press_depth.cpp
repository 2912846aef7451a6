#include "experiment/press_depth.h"

#include <fmt/format.h>

#include <numeric>

#include "base/error.h"
#include "experiment/fitted_range.h"

namespace hapsim {
namespace {

// What a row says that goes through the body, and where; the rest of the rows is not looked at
// then.
struct Through {
  std::string place, what;  // "": none
};

Through include(const SignedDistance& surface, const Recording& r, const std::vector<int>& rows,
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
    deepest.line = r.line[row];
    if (share >= 1)
      return {fmt::format("{}:{}", r.name, r.line[row]),
              fmt::format("a displacement of {:.3g} m goes through the body, which is {:.3g} m "
                          "thick there",
                          u.norm(), u.norm() / share)};
  }
  return {};
}

[[noreturn]] void fail(const Through& through) {
  fail_input(through.place, through.what, "correct or remove the row; all lengths are in metres");
}

SignedDistance surface_of(const TetMesh& body) {
  return SignedDistance(boundary_surface(body), "body");
}

struct PositionDepth {
  PressDepth deepest;
  Through through;
};
std::vector<PositionDepth> by_position(std::span<const TetMesh> bodies, const Dataset& dataset) {
  std::vector<PositionDepth> of(dataset.positions.size());
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const SignedDistance surface = surface_of(bodies[b]);
    for (const Episode& e : dataset.episodes) {
      const auto p = static_cast<std::size_t>(e.position);
      const int setup = dataset.setup_of[p];
      if (dataset.setups[static_cast<std::size_t>(setup)].body != static_cast<int>(b)) continue;
      if (of[p].through.what.empty())
        of[p].through = include(surface, dataset.recording, e.rows, of[p].deepest);
    }
  }
  return of;
}

void merge(const PressDepth& other, PressDepth& deepest) {
  deepest.depth = std::max(deepest.depth, other.depth);
  if (other.share <= deepest.share) return;
  deepest.share = other.share;
  deepest.line = other.line;
}

}  // namespace

PressDepth press_depth(const TetMesh& body, const Recording& recording) {
  PressDepth deepest;
  std::vector<int> rows(recording.rows());
  std::iota(rows.begin(), rows.end(), 0);
  const Through through = include(surface_of(body), recording, rows, deepest);
  if (!through.what.empty()) fail(through);
  return deepest;
}

PressDepth press_depth(std::span<const TetMesh> bodies, const Dataset& dataset) {
  PressDepth deepest;
  for (const PositionDepth& position : by_position(bodies, dataset)) {
    if (!position.through.what.empty()) fail(position.through);
    merge(position.deepest, deepest);
  }
  return deepest;
}

PositionsThrough positions_through(std::span<const TetMesh> bodies, const Dataset& dataset) {
  PositionsThrough out;
  const std::vector<PositionDepth> of = by_position(bodies, dataset);
  std::size_t through = 0;
  for (const PositionDepth& position : of) {
    const Through& t = position.through;
    out.why.push_back(t.what.empty() ? "" : t.place + ": " + t.what);
    if (t.what.empty()) {
      merge(position.deepest, out.others);
      continue;
    }
    if (2 * ++through > of.size()) fail(t);
  }
  return out;
}

std::string beyond_depth(const PressDepth& depth, const Model& model) {
  if (depth.share > kValidShare)
    return fmt::format(
        "line {} goes {:.0f} % of the way through the body: beyond {:.0f} % these forces mean "
        "little",
        depth.line, 100 * depth.share, 100 * kValidShare);
  const FittedRange fitted = fitted_range(model.metadata, model.name);
  if (!fitted.has_depth(depth.depth))
    return fmt::format("presses go {:.3g} mm deep, and the model was fitted to {:.3g} mm",
                       1e3 * depth.depth, 1e3 * fitted.depth);
  return "";
}

}  // namespace hapsim
