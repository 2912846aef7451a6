#include "volume/isosurface.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "volume/voxel_parts.h"

namespace hapsim {
namespace {

enum : std::uint8_t { kOutside = 0, kBody = 1, kOther = 2, kCavity = 3 };

// Gradient by the voxel numbers: central differences, one-sided at the border.
Eigen::Vector3d gradient(const Volume& v, const Eigen::Vector3i& at) {
  Eigen::Vector3d g;
  for (int a = 0; a < 3; ++a) {
    Eigen::Vector3i low = at, high = at;
    low[a] = std::max(0, at[a] - 1);
    high[a] = std::min(v.size[static_cast<std::size_t>(a)] - 1, at[a] + 1);
    g[a] = (v.at(high[0], high[1], high[2]) - v.at(low[0], low[1], low[2])) / (high[a] - low[a]);
  }
  return g;
}

// The body's voxels as kBody, what else reaches the threshold as kOther, cavities as kCavity.
std::vector<std::uint8_t> segment(const Volume& volume, const IsoOptions& options,
                                  const std::string& name, IsoReport& report) {
  std::vector<std::uint8_t> mask(volume.count());
  std::size_t inside = 0;
  for (std::size_t i = 0; i < mask.size(); ++i) {
    const float v = volume.values[i];
    const bool in = options.below ? v <= options.threshold : v >= options.threshold;
    mask[i] = in ? kBody : kOutside;
    inside += in ? 1 : 0;
  }
  if (inside == 0 || inside == mask.size()) {
    const ValueRange range = value_range(volume);
    fail_input(name,
               fmt::format("{} voxel is {} the threshold {:.6g}; values go from {:.6g} to {:.6g}",
                           inside == 0 ? "no" : "every", options.below ? "below" : "above",
                           options.threshold, range.least, range.largest),
               fmt::format("try --threshold {:.4g}", range.otsu));
  }
  const VoxelParts parts(volume.size, mask, kBody);
  report.parts = parts.parts().size();
  std::size_t largest = 0;
  for (std::size_t p = 1; p < parts.parts().size(); ++p) {
    if (parts.parts()[p].voxels > parts.parts()[largest].voxels) largest = p;
  }
  if (!options.all_parts) {
    parts.mark([&](std::size_t p) { return p != largest; }, kOther, mask);
  }
  for (std::size_t p = 0; p < parts.parts().size(); ++p) {
    if (!options.all_parts && p != largest) continue;
    report.voxels += parts.parts()[p].voxels;
    report.cut += parts.parts()[p].border;
  }
  report.share = static_cast<double>(report.voxels) / static_cast<double>(inside);
  std::size_t runs = parts.runs();
  if (!options.cavities) {
    // What is not the body and does not reach the border is a cavity, with all that lies in it.
    std::vector<std::uint8_t> rest(mask.size());
    std::transform(mask.begin(), mask.end(), rest.begin(),
                   [](std::uint8_t m) { return m == kBody ? kBody : kOutside; });
    const VoxelParts around(volume.size, rest, kOutside);
    around.mark([&](std::size_t p) { return around.parts()[p].border == 0; }, kCavity, mask);
    runs += around.runs();
  }
  report.memory = 4.0 * static_cast<double>(volume.count()) +
                  (options.cavities ? 1.0 : 2.0) * static_cast<double>(mask.size()) +
                  20.0 * static_cast<double>(runs);
  return mask;
}

}  // namespace

PointCloud isosurface(const Volume& volume, const IsoOptions& options, const std::string& name,
                      IsoReport& report) {
  report = {};
  const std::vector<std::uint8_t> mask = segment(volume, options, name, report);
  const Eigen::Matrix3d to_normal = volume.to_world.linear().inverse().transpose();
  const double sign = options.below ? 1 : -1;
  PointCloud cloud;
  const auto [nx, ny, nz] = volume.size;
  const std::size_t step[3] = {1, static_cast<std::size_t>(nx), static_cast<std::size_t>(nx) * ny};
  std::size_t here = 0;
  for (int k = 0; k < nz; ++k) {
    for (int j = 0; j < ny; ++j) {
      for (int i = 0; i < nx; ++i, ++here) {
        const Eigen::Vector3i at(i, j, k);
        for (int a = 0; a < 3; ++a) {
          if (at[a] + 1 >= volume.size[static_cast<std::size_t>(a)]) continue;
          const std::size_t next = here + step[a];
          const bool one = mask[here] == kBody, two = mask[next] == kBody;
          if (one == two || (one ? mask[next] : mask[here]) == kCavity) continue;
          const double p = volume.values[here], q = volume.values[next];
          const double part = (options.threshold - p) / (q - p);
          if (!(part >= 0 && part <= 1)) continue;  // beside a voxel without a value
          const Eigen::Vector3i beyond = at + Eigen::Vector3i::Unit(a);
          Vec3 normal =
              sign *
              (to_normal * ((1 - part) * gradient(volume, at) + part * gradient(volume, beyond)));
          if (!(normal.norm() > 0 && normal.allFinite())) {
            normal = volume.to_world.linear().col(a) * (one ? 1 : -1);
          }
          cloud.points.push_back(volume.to_world * (at.cast<double>() + part * Vec3::Unit(a)));
          cloud.normals.push_back(normal.normalized());
        }
      }
    }
  }
  return cloud;
}

}  // namespace hapsim
