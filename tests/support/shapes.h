// Closed surfaces and meshes with known volumes, for the tests of meshing.
#pragma once

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include "base/error.h"
#include "mesh/surface.h"
#include "mesh/tetmesh.h"

namespace hapsim::test {

// A box [0, size] with each side divided n by n.
inline Surface box(const Vec3& size, int n = 1) {
  Surface surface;
  std::map<std::array<int, 3>, int> number;
  const auto vertex = [&](const std::array<int, 3>& at) {
    const auto [found, fresh] = number.emplace(at, static_cast<int>(surface.vertices.size()));
    if (fresh) surface.vertices.push_back(Vec3(at[0], at[1], at[2]).cwiseProduct(size) / n);
    return found->second;
  };
  for (int axis = 0; axis < 3; ++axis)
    for (const int end : {0, n})
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
          const auto corner = [&](int a, int b) {
            std::array<int, 3> at{};
            at[axis] = end;
            at[(axis + 1) % 3] = i + a;
            at[(axis + 2) % 3] = j + b;
            return vertex(at);
          };
          const int p = corner(0, 0), q = corner(1, 0), r = corner(1, 1), s = corner(0, 1);
          if (end == n) {
            surface.faces.push_back({p, q, r});
            surface.faces.push_back({p, r, s});
          } else {
            surface.faces.push_back({p, r, q});
            surface.faces.push_back({p, s, r});
          }
        }
  return surface;
}

// A half-ball of `radius` on the plane z = 0: a box's surface blown up to it.
inline Surface dome(double radius, int n) {
  Surface surface = box({2, 2, 1}, n);
  for (Vec3& p : surface.vertices) {
    const Vec3 q = p - Vec3(1, 1, 0);
    const double largest = std::max({std::abs(q.x()), std::abs(q.y()), q.z()});
    p = q.norm() > 0 ? Vec3(q * (radius * largest / q.norm())) : Vec3(Vec3::Zero());
  }
  return surface;
}

// The error's code and text, or 0 and "" when nothing was thrown.
template <class Action>
std::pair<int, std::string> error_of(const Action& action) {
  try {
    action();
  } catch (const Error& error) {
    return {static_cast<int>(error.code()), error.what()};
  }
  return {0, ""};
}

// Text in a file that goes away with this object.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& text) {
    std::string name = (std::filesystem::temp_directory_path() / "hapsim-test-XXXXXX").string();
    const int file = mkstemp(name.data());
    if (file >= 0) close(file);
    path_ = name;
    std::ofstream(path_, std::ios::binary) << text;
  }
  ~TemporaryFile() { std::filesystem::remove(path_); }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace hapsim::test
