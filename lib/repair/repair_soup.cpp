#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "mesh/drop_unused.h"
#include "mesh/point_index.h"
#include "repair/repair.h"

namespace hapsim {
namespace {

using Edge = std::pair<int, int>;
constexpr double kSame = 1e-7;    // of the size: vertices this near are one
constexpr double kNear = 0.05;    // of the shorter edge: open vertices this near are one
constexpr double kThin = 1e-6;    // height over longest side of a triangle without area
constexpr double kOnSide = 1e-4;  // of a side's length: a vertex this near lies on it

double size_of(const std::vector<Vec3>& points) {
  Vec3 low = points.front(), high = points.front();
  for (const Vec3& p : points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return (high - low).norm();
}

// Renames corners and drops triangles that lose one.
void rename(Surface& surface, const std::vector<int>& name) {
  std::vector<Triangle> faces;
  for (const Triangle& f : surface.faces) {
    const Triangle g{name[f[0]], name[f[1]], name[f[2]]};
    if (g[0] != g[1] && g[1] != g[2] && g[2] != g[0]) faces.push_back(g);
  }
  surface.faces = std::move(faces);
}

// Edges with one triangle, and that triangle.
std::map<Edge, int> open_edges(const Surface& surface) {
  std::map<Edge, std::array<int, 2>> count;
  for (std::size_t f = 0; f < surface.faces.size(); ++f) {
    const Triangle& t = surface.faces[f];
    for (int k = 0; k < 3; ++k) {
      auto& entry = count[std::minmax(t[k], t[(k + 1) % 3])];
      ++entry[0];
      entry[1] = static_cast<int>(f);
    }
  }
  std::map<Edge, int> open;
  for (const auto& [edge, entry] : count) {
    if (entry[0] == 1) open.emplace(edge, entry[1]);
  }
  return open;
}

int weld_equal(Surface& surface, double size) {
  const PointIndex index(surface.vertices);
  std::vector<int> name(surface.vertices.size());
  int welded = 0;
  for (std::size_t v = 0; v < name.size(); ++v) {
    name[v] = static_cast<int>(v);
    for (const Neighbour& m : index.within(surface.vertices[v], kSame * size)) {
      if (m.index < name[v]) name[v] = name[m.index];
    }
    if (name[v] != static_cast<int>(v)) ++welded;
  }
  if (welded > 0) rename(surface, name);
  return welded;
}

// Merges vertices of open edges that nearly meet.
int weld_open(Surface& surface) {
  std::map<int, double> shortest;  // edge at each open vertex
  for (const auto& [edge, face] : open_edges(surface)) {
    const double length = (surface.vertices[edge.first] - surface.vertices[edge.second]).norm();
    for (const int v : {edge.first, edge.second}) {
      const auto [at, fresh] = shortest.try_emplace(v, length);
      if (!fresh) at->second = std::min(at->second, length);
    }
  }
  if (shortest.empty()) return 0;
  std::vector<Vec3> points;
  std::vector<int> vertex;
  for (const auto& [v, length] : shortest) {
    points.push_back(surface.vertices[v]);
    vertex.push_back(v);
  }
  const PointIndex index(points);
  std::vector<int> name(surface.vertices.size());
  std::iota(name.begin(), name.end(), 0);
  int welded = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (const Neighbour& m : index.within(points[i], kNear * shortest[vertex[i]])) {
      const int w = vertex[m.index];
      if (w >= vertex[i] || m.distance > kNear * shortest[w] || name[vertex[i]] != vertex[i]) {
        continue;
      }
      name[vertex[i]] = name[w];
      ++welded;
    }
  }
  if (welded > 0) rename(surface, name);
  return welded;
}

int drop_degenerate(Surface& surface) {
  std::vector<Triangle> faces;
  for (std::size_t f = 0; f < surface.faces.size(); ++f) {
    const Triangle& t = surface.faces[f];
    double longest = 0;
    for (int k = 0; k < 3; ++k) {
      longest =
          std::max(longest, (surface.vertices[t[k]] - surface.vertices[t[(k + 1) % 3]]).norm());
    }
    const double twice = face_normal(surface, static_cast<int>(f)).norm();
    if (twice > kThin * longest * longest) faces.push_back(t);
  }
  const int dropped = static_cast<int>(surface.faces.size() - faces.size());
  surface.faces = std::move(faces);
  return dropped;
}

int drop_duplicates(Surface& surface) {
  std::set<std::array<int, 3>> seen;
  std::vector<Triangle> faces;
  for (const Triangle& f : surface.faces) {
    std::array<int, 3> key = f;
    std::sort(key.begin(), key.end());
    if (seen.insert(key).second) faces.push_back(f);
  }
  const int dropped = static_cast<int>(surface.faces.size() - faces.size());
  surface.faces = std::move(faces);
  return dropped;
}

// Splits open triangles at vertices that lie on their open side; returns how many.
int split_t_junctions(Surface& surface) {
  int split = 0;
  for (int pass = 0; pass < 20; ++pass) {
    const std::map<Edge, int> open = open_edges(surface);
    if (open.empty()) return split;
    std::set<int> rim;
    double longest = 0;
    for (const auto& [edge, face] : open) {
      rim.insert({edge.first, edge.second});
      longest =
          std::max(longest, (surface.vertices[edge.first] - surface.vertices[edge.second]).norm());
    }
    const std::vector<int> vertex(rim.begin(), rim.end());
    std::vector<Vec3> points;
    for (const int v : vertex) points.push_back(surface.vertices[v]);
    const PointIndex index(points);
    std::set<int> touched;
    bool changed = false;
    for (const auto& [edge, face] : open) {
      if (touched.count(face) > 0) continue;
      const Vec3 a = surface.vertices[edge.first];
      const Vec3 d = surface.vertices[edge.second] - a;
      const double length = d.norm();
      int best = -1;
      double least = kOnSide * length;
      for (const Neighbour& m : index.within(a + d / 2, 0.5 * length)) {
        const int v = vertex[m.index];
        const Triangle& t = surface.faces[face];
        if (std::find(t.begin(), t.end(), v) != t.end()) continue;
        const double along = (points[m.index] - a).dot(d) / (length * length);
        if (along < 1e-3 || along > 1 - 1e-3) continue;
        const double off = (points[m.index] - a - along * d).norm();
        if (off < least) {
          least = off;
          best = v;
        }
      }
      if (best < 0) continue;
      Triangle& t = surface.faces[face];
      int k = 0;
      while (Edge(std::minmax(t[k], t[(k + 1) % 3])) != edge) ++k;
      Triangle other = t;
      other[k] = best;
      t[(k + 1) % 3] = best;
      surface.faces.push_back(other);
      touched.insert(face);
      changed = true;
      ++split;
    }
    if (!changed) return split;
  }
  return split;
}

// Turns the triangles of each connected part alike, and outward by its volume; returns how many
// turned. Edges of more than two triangles do not connect.
int orient(Surface& surface) {
  std::map<Edge, std::vector<int>> faces_of;
  for (std::size_t f = 0; f < surface.faces.size(); ++f) {
    const Triangle& t = surface.faces[f];
    for (int k = 0; k < 3; ++k) {
      faces_of[std::minmax(t[k], t[(k + 1) % 3])].push_back(static_cast<int>(f));
    }
  }
  const auto runs = [&](int face, int a, int b) {
    const Triangle& t = surface.faces[face];
    for (int k = 0; k < 3; ++k) {
      if (t[k] == a && t[(k + 1) % 3] == b) return true;
    }
    return false;
  };
  std::vector<char> turn(surface.faces.size(), 2);  // 2: not yet known
  int flipped = 0;
  for (std::size_t seed = 0; seed < turn.size(); ++seed) {
    if (turn[seed] != 2) continue;
    std::vector<int> part{static_cast<int>(seed)};
    turn[seed] = 0;
    for (std::size_t next = 0; next < part.size(); ++next) {
      const int f = part[next];
      const Triangle t = surface.faces[f];
      for (int k = 0; k < 3; ++k) {
        const auto& both = faces_of[std::minmax(t[k], t[(k + 1) % 3])];
        if (both.size() != 2) continue;
        const int g = both[0] == f ? both[1] : both[0];
        if (turn[g] != 2) continue;
        const bool alike = !runs(g, t[k], t[(k + 1) % 3]);
        turn[g] = alike ? turn[f] : static_cast<char>(1 - turn[f]);
        part.push_back(g);
      }
    }
    // An open part, too, has most of its volume about its middle.
    Vec3 middle = Vec3::Zero();
    double area = 0;
    for (const int f : part) {
      const double a = face_normal(surface, f).norm();
      const Triangle& t = surface.faces[f];
      middle += a * (surface.vertices[t[0]] + surface.vertices[t[1]] + surface.vertices[t[2]]) / 3;
      area += a;
    }
    middle /= area;
    double volume = 0;
    for (const int f : part) {
      volume += (turn[f] == 1 ? -1 : 1) *
                face_normal(surface, f).dot(surface.vertices[surface.faces[f][0]] - middle);
    }
    for (const int f : part) {
      if (volume < 0) turn[f] = static_cast<char>(1 - turn[f]);
      if (turn[f] == 0) continue;
      std::swap(surface.faces[f][1], surface.faces[f][2]);
      ++flipped;
    }
  }
  return flipped;
}

}  // namespace

Surface repair_soup(const Surface& given, RepairReport& report) {
  Surface surface = given;
  report.stray_vertices += drop_unused(surface);
  if (surface.faces.empty()) return surface;
  const std::size_t before = surface.faces.size();
  report.welded += weld_equal(surface, size_of(surface.vertices));
  report.degenerate += static_cast<int>(before - surface.faces.size());
  report.duplicate += drop_duplicates(surface);
  report.degenerate += drop_degenerate(surface);
  report.welded += weld_open(surface);
  report.degenerate += drop_degenerate(surface);
  report.t_junctions += split_t_junctions(surface);
  report.duplicate += drop_duplicates(surface);
  drop_unused(surface);
  report.flipped += orient(surface);
  return surface;
}

}  // namespace hapsim
