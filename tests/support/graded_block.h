// A block of second-order elements, 2 L wide and `depth` deep on a bonded base, whose edges grow
// from `edge` at the origin, the middle of its top (coordinates graded by sinh).
#pragma once

#include <cmath>

#include "support/block_mesh.h"

namespace hapsim::test {

inline TetMesh graded_block(double L, double depth, double edge, int n, int layers) {
  TetMesh mesh = block_mesh({2, 2, 1}, n, n, layers, 1);
  // c sinh(k s): first step `edge`, reach L at s = 1.
  const auto graded = [&](double s, double reach, double step) {
    double k = 1e-3;
    while (reach * std::sinh(k * step) / std::sinh(k) > edge) k += 1e-3;
    return reach * std::sinh(k * s) / std::sinh(k);
  };
  for (Vec3& p : mesh.nodes)
    p = {graded(p.x() - 1, L, 2.0 / n), graded(p.y() - 1, L, 2.0 / n),
         -graded(1 - p.z(), depth, 1.0 / layers)};
  return to_second_order(mesh);
}

}  // namespace hapsim::test
