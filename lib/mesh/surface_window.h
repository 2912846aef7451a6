// How a body's surface runs about a point, seen through a smooth window.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "mesh/surface.h"

namespace hapsim {

// Integrals over the surface, weighted by w = 9 (1 - r^2 / (4 width)^2)^8 / (16 pi width^2) within
// four widths, much like a Gaussian, r the distance from the point x: what edges, curvature, thin
// walls and supports have in common. On a flat face `normal` is the face's, `shape` zero.
struct SurfaceView {
  Vec3 normal = Vec3::Zero();                       // of w n; shorter at edges and in thin parts
  Eigen::Matrix3d shape = Eigen::Matrix3d::Zero();  // of w (y - x) n' / width, symmetric part
  double marked = 0;                                // of w over the marked faces
};

// The surface as points closer than half a width, in a grid of cells. Queries allocate nothing and
// are thread-safe; cost: the points within four widths, some 500.
class SurfaceWindow {
 public:
  // `marked`: one a face.
  SurfaceWindow(const Surface& surface, const std::vector<std::uint8_t>& marked, double width);
  SurfaceView at(const Vec3& p) const;
  double width() const { return width_; }

 private:
  using Cell = std::array<int, 3>;
  struct Piece {
    Vec3 centre = Vec3::Zero(), normal = Vec3::Zero();  // normal of the length of its area
    double area = 0, marked = 0;
  };
  static Cell cell_of(const Vec3& p, double size);

  double width_;
  std::vector<Piece> pieces_;
  std::map<Cell, std::vector<int>> near_;
};

}  // namespace hapsim
