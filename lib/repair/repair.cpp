#include "repair/repair.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "base/error.h"
#include "repair/repair_parts.h"

namespace hapsim {
namespace {

constexpr double kNothing = 1e-7;  // volume over area to 3/2
constexpr double kCrumb = 0.01;    // of the largest part's area: a loose part this small is a crumb

int root(std::vector<int>& parent, int v) {
  while (parent[v] != v) v = parent[v] = parent[parent[v]];
  return v;
}

// What hangs together by vertices, the largest area first.
std::vector<Surface> parts_of(const Surface& surface) {
  std::vector<int> parent(surface.vertices.size());
  std::iota(parent.begin(), parent.end(), 0);
  for (const Triangle& f : surface.faces) {
    parent[root(parent, f[1])] = root(parent, f[0]);
    parent[root(parent, f[2])] = root(parent, f[0]);
  }
  std::vector<int> part(surface.vertices.size(), -1), number(surface.vertices.size(), -1);
  std::vector<Surface> parts;
  for (const Triangle& f : surface.faces) {
    int& at = part[root(parent, f[0])];
    if (at < 0) {
      at = static_cast<int>(parts.size());
      parts.emplace_back();
    }
    Surface& own = parts[at];
    Triangle g;
    for (int k = 0; k < 3; ++k) {
      if (number[f[k]] < 0) {
        number[f[k]] = static_cast<int>(own.vertices.size());
        own.vertices.push_back(surface.vertices[f[k]]);
      }
      g[k] = number[f[k]];
    }
    own.faces.push_back(g);
  }
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t p = 0; p < parts.size(); ++p) order.emplace_back(-surface_area(parts[p]), p);
  std::sort(order.begin(), order.end());
  std::vector<Surface> sorted;
  for (const auto& [area, p] : order) sorted.push_back(std::move(parts[p]));
  return sorted;
}

// Solid angle of a closed surface seen from p over the full one: 1 inside, 0 outside (Van Oosterom,
// Strackee 1983).
double winding(const Surface& surface, const Vec3& p) {
  double sum = 0;
  for (const Triangle& f : surface.faces) {
    const Vec3 a = surface.vertices[f[0]] - p, b = surface.vertices[f[1]] - p,
               c = surface.vertices[f[2]] - p;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    sum +=
        std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return sum / (2 * M_PI);
}

void turn_outward(Surface& surface, RepairReport& report) {
  if (signed_volume(surface) >= 0) return;
  for (Triangle& f : surface.faces) std::swap(f[1], f[2]);
  report.flipped += static_cast<int>(surface.faces.size());
}

Vec3 centre_of(const Surface& surface, int face) {
  const Triangle& f = surface.faces[face];
  return (surface.vertices[f[0]] + surface.vertices[f[1]] + surface.vertices[f[2]]) / 3;
}

// Takes away pairs of triangles that cut each other.
void uncut(Surface& surface, const std::string& name, RepairReport& report) {
  std::array<int, 2> first{};
  const std::size_t pairs = count_cuts(surface, first);
  if (pairs == 0) return;
  const Vec3 a = centre_of(surface, first[0]);
  Surface mended = surface;
  remove_cuts(mended);
  std::array<int, 2> left{};
  if (count_cuts(mended, left) > 0 || !is_closed(mended)) {
    fail_input(name,
               fmt::format("{} pairs of triangles cut each other, the first {} and {} about "
                           "({:.6g}, {:.6g}, {:.6g}), and cannot be replaced",
                           pairs, first[0], first[1], a.x(), a.y(), a.z()),
               "wrap the triangles instead: --method wrap");
  }
  report.self_intersections += static_cast<int>(pairs);
  surface = std::move(mended);
}

// One body from closed parts.
Surface one_body(std::vector<Surface> parts, RepairReport& report) {
  std::stable_sort(parts.begin(), parts.end(), [](const Surface& a, const Surface& b) {
    return signed_volume(a) > signed_volume(b);
  });
  Surface body = std::move(parts.front());
  for (std::size_t p = 1; p < parts.size(); ++p) {
    Surface joined;
    if (parts_cut(body, parts[p]) && join_parts(body, parts[p], joined) && is_closed(joined)) {
      body = std::move(joined);
      ++report.joined;
    } else if (winding(body, parts[p].vertices.front()) > 0.5) {
      ++report.inner_shells;
    } else {
      ++report.components;
      report.components_volume += signed_volume(parts[p]);
    }
  }
  return body;
}

struct Count {
  const char* key;
  const char* text;
  int value;
};

std::vector<Count> counts(const RepairReport& r) {
  return {{"stray_vertices", "stray vertices dropped", r.stray_vertices},
          {"welded", "vertices merged", r.welded},
          {"degenerate", "triangles without area dropped", r.degenerate},
          {"duplicate", "triangles given twice dropped", r.duplicate},
          {"t_junctions", "sides split at a vertex on them", r.t_junctions},
          {"flipped", "triangles turned outward", r.flipped},
          {"split_vertices", "vertices where parts only touched taken apart", r.split_vertices},
          {"holes", "holes closed", r.holes},
          {"self_intersections", "pairs of triangles that cut each other replaced",
           r.self_intersections},
          {"joined", "overlapping parts joined", r.joined},
          {"components", "loose parts removed", r.components},
          {"inner_shells", "inner shells removed (cavities are filled)", r.inner_shells}};
}

}  // namespace

int RepairReport::total() const {
  int sum = 0;
  for (const Count& c : counts(*this)) sum += c.value;
  return sum;
}

std::string RepairReport::text() const {
  std::string text;
  for (const Count& c : counts(*this)) {
    if (c.value == 0) continue;
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", c.value, c.text);
    if (c.value == holes && std::string(c.key) == "holes") {
      text += fmt::format(" (the largest with a rim of {:.3g} mm about ({:.4g}, {:.4g}, {:.4g}))",
                          1e3 * largest_hole, largest_hole_at.x(), largest_hole_at.y(),
                          largest_hole_at.z());
    }
  }
  return text.empty() ? "nothing to mend" : text;
}

std::string RepairReport::json() const {
  std::string text = "{";
  for (const Count& c : counts(*this)) text += fmt::format("\"{}\": {}, ", c.key, c.value);
  return text + fmt::format(
                    "\"added_triangles\": {}, \"largest_hole_rim\": {}, "
                    "\"components_volume\": {}}}",
                    added_triangles, largest_hole, components_volume);
}

Surface repair_surface(const Surface& given, const std::string& name, RepairReport& report) {
  if (given.faces.empty()) fail_input(name, "there are no triangles", "give a surface");
  for (std::size_t v = 0; v < given.vertices.size(); ++v) {
    if (!given.vertices[v].allFinite()) {
      fail_input(name, fmt::format("vertex {} is not finite", v), "remove its triangles");
    }
  }
  Surface soup = repair_soup(given, report);
  if (soup.faces.empty()) {
    fail_input(name, "no triangle has an area", "give a surface, not a line or a point");
  }
  report.split_vertices += take_apart(soup);

  std::vector<Surface> parts = parts_of(soup), closed;
  const double largest = surface_area(parts.front());
  for (Surface& part : parts) {
    const bool open = !is_closed(part);
    if (open && surface_area(part) < kCrumb * largest) {
      ++report.components;
      continue;
    }
    if (open) {
      for (const Surface& other : closed) {
        if (is_closed(other)) continue;
        const Vec3 a = centre_of(other, 0), b = centre_of(part, 0);
        fail_input(name,
                   fmt::format("the surface falls into open parts, one about ({:.4g}, {:.4g}, "
                               "{:.4g}), one about ({:.4g}, {:.4g}, {:.4g})",
                               a.x(), a.y(), a.z(), b.x(), b.y(), b.z()),
                   "wrap them as one instead: --method wrap");
      }
    }
    closed.push_back(std::move(part));
  }
  for (Surface& part : closed) {
    if (!is_closed(part)) close_holes(part, name, report);
    turn_outward(part, report);
    if (signed_volume(part) < kNothing * std::pow(surface_area(part), 1.5)) {
      fail_input(name, "the triangles enclose no volume", "give the surface of a body");
    }
    uncut(part, name, report);
  }
  Surface body = one_body(std::move(closed), report);
  if (!is_closed(body) || !(signed_volume(body) > 0)) {
    fail_input(name, "the triangles enclose no volume", "wrap them instead: --method wrap");
  }
  uncut(body, name, report);
  return body;
}

}  // namespace hapsim
