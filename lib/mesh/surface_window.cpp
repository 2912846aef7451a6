#include "mesh/surface_window.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace hapsim {
namespace {

constexpr double kReach = 4;    // widths
constexpr double kPart = 0.5;   // longest edge of the triangles that are taken as points, in widths
constexpr double kMerge = 0.4;  // cells whose points become one, in widths

}  // namespace

SurfaceWindow::Cell SurfaceWindow::cell_of(const Vec3& p, double size) {
  Cell cell;
  for (std::size_t k = 0; k < 3; ++k)
    cell[k] = static_cast<int>(std::floor(p[static_cast<Eigen::Index>(k)] / size));
  return cell;
}

SurfaceWindow::SurfaceWindow(const Surface& surface, const std::vector<std::uint8_t>& marked,
                             double width)
    : width_(width) {
  std::map<Cell, Piece> merged;
  std::vector<std::array<Vec3, 3>> parts;
  for (std::size_t f = 0; f < surface.faces.size(); ++f) {
    const Triangle& face = surface.faces[f];
    parts.push_back(
        {surface.vertices[face[0]], surface.vertices[face[1]], surface.vertices[face[2]]});
    while (!parts.empty()) {
      const std::array<Vec3, 3> t = parts.back();
      parts.pop_back();
      std::size_t longest = 0;
      double length = 0;
      for (std::size_t k = 0; k < 3; ++k)
        if (const double l = (t[(k + 1) % 3] - t[k]).norm(); l > length) length = l, longest = k;
      if (length > kPart * width) {
        const Vec3 &a = t[longest], &b = t[(longest + 1) % 3], &c = t[(longest + 2) % 3];
        const Vec3 middle = 0.5 * (a + b);
        parts.push_back({a, middle, c});
        parts.push_back({middle, b, c});
        continue;
      }
      const Vec3 centre = (t[0] + t[1] + t[2]) / 3;
      const Vec3 normal = 0.5 * (t[1] - t[0]).cross(t[2] - t[0]);
      const double area = normal.norm();
      Piece& piece = merged[cell_of(centre, kMerge * width)];
      piece.centre += area * centre;
      piece.normal += normal;
      piece.area += area;
      if (marked[f]) piece.marked += area;
    }
  }
  for (auto& [cell, piece] : merged) {
    if (piece.area <= 0) continue;
    piece.centre /= piece.area;
    near_[cell_of(piece.centre, kReach * width)].push_back(static_cast<int>(pieces_.size()));
    pieces_.push_back(piece);
  }
}

SurfaceView SurfaceWindow::at(const Vec3& p) const {
  SurfaceView view;
  const Cell own = cell_of(p, kReach * width_);
  for (int i = -1; i <= 1; ++i)
    for (int j = -1; j <= 1; ++j)
      for (int k = -1; k <= 1; ++k) {
        const auto found = near_.find({own[0] + i, own[1] + j, own[2] + k});
        if (found == near_.end()) continue;
        for (const int index : found->second) {
          const Piece& piece = pieces_[static_cast<std::size_t>(index)];
          const Vec3 away = piece.centre - p;
          const double square = away.squaredNorm() / (width_ * width_);
          if (square > kReach * kReach) continue;
          const double near = 1 - square / (kReach * kReach), near4 = near * near * near * near;
          const double weight = near4 * near4;
          view.normal += weight * piece.normal;
          view.shape += weight / width_ * away * piece.normal.transpose();
          view.marked += weight * piece.marked;
        }
      }
  const double scale = 9 / (kReach * kReach * std::numbers::pi * width_ * width_);
  view.normal *= scale;
  view.marked *= scale;
  view.shape = (0.5 * scale * (view.shape + view.shape.transpose())).eval();
  return view;
}

}  // namespace hapsim
