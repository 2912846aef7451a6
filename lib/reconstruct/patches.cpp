#include "reconstruct/patches.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "base/median.h"
#include "base/union_find.h"

namespace hapsim {
namespace {

constexpr int kNear = 12;                // points in a plane
constexpr int kWide = 24;                // points whose planes a point may take
constexpr double kOwn = 0.6;             // another's plane must fit this much better than its own
constexpr double kTurnDeg = 22;          // between neighbours of one piece
constexpr std::size_t kLeastPiece = 10;  // points of a piece
constexpr double kOff = 4;               // noises a point may lie off a piece it is given to

// Planes of the neighbourhoods, and for each point that which it takes.
struct Planes {
  std::vector<LocalPlane> of;
  std::vector<int> taken;
  double noise = 0;  // [m]
};

Planes kuwahara(const PointCloud& cloud, const std::vector<std::vector<Neighbour>>& near) {
  Planes planes;
  const std::size_t n = cloud.points.size();
  std::vector<double> thickness;
  for (std::size_t i = 0; i < n; ++i) {
    std::vector<Vec3> points;
    const std::size_t count = std::min<std::size_t>(kNear, near[i].size());
    for (std::size_t k = 0; k < count; ++k) points.push_back(cloud.points[near[i][k].index]);
    planes.of.push_back(fit_plane(points));
    LocalPlane& plane = planes.of.back();
    if (plane.normal.dot(cloud.normals[i]) < 0) plane.normal = -plane.normal;
    thickness.push_back(plane.thickness);
  }
  planes.noise = upper_median(thickness);
  for (std::size_t i = 0; i < n; ++i) {
    int best = static_cast<int>(i);
    double least = kOwn * std::max(planes.of[i].thickness, planes.noise / 2);
    for (const Neighbour& m : near[i]) {
      const LocalPlane& plane = planes.of[m.index];
      const double off = plane.normal.dot(cloud.points[i] - plane.centre);
      const double cost = std::hypot(plane.thickness, off);
      if (cost < least) {
        least = cost;
        best = m.index;
      }
    }
    planes.taken.push_back(best);
  }
  return planes;
}

PointCloud members(const PointCloud& cloud, const std::vector<Vec3>& normals,
                   const std::vector<int>& patch_of, int patch) {
  PointCloud part;
  for (std::size_t i = 0; i < patch_of.size(); ++i) {
    if (patch_of[i] != patch) continue;
    part.points.push_back(cloud.points[i]);
    part.normals.push_back(normals[i]);
  }
  return part;
}

// Numbers 0, 1, ... for the pieces of at least kLeastPiece points, -1 for the rest.
int number_pieces(std::vector<int>& piece) {
  std::map<int, std::size_t> count;
  for (const int p : piece) {
    if (p >= 0) ++count[p];
  }
  std::map<int, int> number;
  for (const auto& [p, c] : count) {
    if (c >= kLeastPiece) number.emplace(p, static_cast<int>(number.size()));
  }
  for (int& p : piece) {
    const auto at = number.find(p);
    p = at == number.end() ? -1 : at->second;
  }
  return static_cast<int>(number.size());
}

std::vector<Patch> patches_of(const PointCloud& cloud, const std::vector<Vec3>& normals,
                              const std::vector<int>& piece, int count) {
  std::vector<Patch> patches;
  for (int k = 0; k < count; ++k) patches.emplace_back(members(cloud, normals, piece, k));
  return patches;
}

// Joins pieces whose surfaces meet at less than the angle; true when any did.
bool join(const PointCloud& cloud, const std::vector<std::vector<Neighbour>>& near,
          const std::vector<Patch>& patches, double crease_deg, std::vector<int>& piece) {
  std::map<std::pair<int, int>, std::vector<double>> angles;
  for (std::size_t i = 0; i < piece.size(); ++i) {
    if (piece[i] < 0) continue;
    const std::size_t count = std::min<std::size_t>(kNear, near[i].size());
    for (std::size_t k = 1; k < count; ++k) {
      const int j = near[i][k].index;
      if (piece[j] <= piece[i]) continue;
      const Vec3 middle = (cloud.points[i] + cloud.points[j]) / 2;
      const Patch::Height a = patches[piece[i]].height(middle);
      const Patch::Height b = patches[piece[j]].height(middle);
      angles[{piece[i], piece[j]}].push_back(
          std::acos(std::clamp(a.normal.dot(b.normal), -1.0, 1.0)) * 180 / M_PI);
    }
  }
  std::vector<int> parent(patches.size());
  std::iota(parent.begin(), parent.end(), 0);
  bool joined = false;
  for (const auto& [pair, angle] : angles) {
    if (angle.size() < 3 || upper_median(angle) >= crease_deg) continue;
    parent[root(parent, pair.second)] = root(parent, pair.first);
    joined = true;
  }
  for (int& p : piece) {
    if (p >= 0) p = root(parent, p);
  }
  return joined;
}

}  // namespace

Segmentation find_patches(const PointCloud& cloud, double spacing, double crease_deg) {
  const std::size_t n = cloud.points.size();
  const PointIndex index(cloud.points);
  std::vector<std::vector<Neighbour>> near(n);
  for (std::size_t i = 0; i < n; ++i) {
    for (const Neighbour& m : index.nearest(cloud.points[i], kWide)) {
      // Not across to another sheet.
      if (m.distance < 6 * spacing && cloud.normals[i].dot(cloud.normals[m.index]) > -0.3) {
        near[i].push_back(m);
      }
    }
  }
  const Planes planes = kuwahara(cloud, near);
  std::vector<Vec3> normals;
  for (const int j : planes.taken) normals.push_back(planes.of[j].normal);

  // Flattest places first.
  std::vector<int> order(n);
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return planes.of[a].thickness < planes.of[b].thickness; });
  const double turn = std::cos(kTurnDeg * M_PI / 180);
  Segmentation result;
  std::vector<int>& piece = result.patch_of;
  piece.assign(n, -1);
  for (const int seed : order) {
    if (piece[seed] >= 0) continue;
    std::vector<int> open{seed};
    piece[seed] = seed;
    while (!open.empty()) {
      const int i = open.back();
      open.pop_back();
      const std::size_t count = std::min<std::size_t>(kNear, near[i].size());
      for (std::size_t k = 0; k < count; ++k) {
        const int j = near[i][k].index;
        if (piece[j] >= 0 || normals[i].dot(normals[j]) < turn) continue;
        // A step between parallel sheets is no neighbour.
        const double step =
            std::abs((cloud.points[j] - cloud.points[i]).dot(normals[i] + normals[j])) / 2;
        if (step > kOff * planes.noise + 0.2 * near[i][k].distance) continue;
        piece[j] = seed;
        open.push_back(j);
      }
    }
  }
  int count = number_pieces(piece);
  result.patches = patches_of(cloud, normals, piece, count);
  for (int pass = 0; pass < 4; ++pass) {
    if (!join(cloud, near, result.patches, crease_deg, piece)) break;
    count = number_pieces(piece);
    result.patches = patches_of(cloud, normals, piece, count);
  }
  // Crumbs, to the piece nearby on whose surface they lie best.
  for (std::size_t i = 0; i < n; ++i) {
    if (piece[i] >= 0) continue;
    double least = kOff * planes.noise;
    int best = -1;
    for (const Neighbour& m : near[i]) {
      const int k = piece[m.index];
      if (k < 0 || k >= count) continue;
      const double off = std::abs(result.patches[k].height(cloud.points[i]).value);
      if (off < least) {
        least = off;
        best = k;
      }
    }
    piece[i] = best;
    if (best >= 0) normals[i] = result.patches[best].height(cloud.points[i]).normal;
  }
  result.patches = patches_of(cloud, normals, piece, count);
  return result;
}

}  // namespace hapsim
