#include "solid/body_regions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "mesh/drop_unused.h"
#include "solid/inhomogeneity.h"

namespace hapsim {
namespace {

constexpr int kCuts = 2;      // each tetrahedron at a boundary into 8^2 parts
constexpr int kThinCuts = 2;  // and so often again where two boundaries pass between corners

struct TetFace {
  std::array<int, 3> sorted;
  Triangle corners;
  std::size_t tet;
};

std::vector<TetFace> all_faces(const TetMesh& body) {
  constexpr int kCorners[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
  std::vector<TetFace> faces;
  for (std::size_t t = 0; t < body.tets.size(); ++t)
    for (const auto& c : kCorners) {
      const auto& n = body.tets[t];
      const Triangle corners{n[c[0]], n[c[1]], n[c[2]]};
      TetFace face{{corners[0], corners[1], corners[2]}, corners, t};
      std::sort(face.sorted.begin(), face.sorted.end());
      faces.push_back(face);
    }
  std::sort(faces.begin(), faces.end(), [](const TetFace& a, const TetFace& b) {
    return std::pair(a.sorted, a.tet) < std::pair(b.sorted, b.tet);
  });
  return faces;
}

}  // namespace

struct BodyRegions::Corner {
  Vec3 at;
  int region;
  double distance;  // to the nearest boundary [m]
  int face;         // of between_
  Vec3 from;        // the nearest point of that boundary to here
};

std::shared_ptr<const BodyRegions> BodyRegions::of(const TetMesh& body) {
  if (std::all_of(body.region.begin(), body.region.end(), [](int r) { return r == 0; }))
    return nullptr;
  return std::make_shared<const BodyRegions>(body);
}

BodyRegions::BodyRegions(const TetMesh& body) : region_(body.region), tets_(body) {
  region_.resize(body.tets.size(), 0);
  numbers_ = region_;
  std::sort(numbers_.begin(), numbers_.end());
  numbers_.erase(std::unique(numbers_.begin(), numbers_.end()), numbers_.end());
  Surface outside, between;
  outside.vertices = between.vertices = body.nodes;
  const std::vector<TetFace> faces = all_faces(body);
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const int own = region_[faces[f].tet];
    if (f + 1 < faces.size() && faces[f + 1].sorted == faces[f].sorted) {
      const int other = region_[faces[++f].tet];
      if (other == own) continue;
      between.faces.push_back(faces[f].corners);
      sides_.emplace_back(own, other);
    } else {
      outside.faces.push_back(faces[f].corners);
      region_of_face_.push_back(own);
    }
  }
  if (numbers_.size() > 2)
    for (const int region : numbers_) {
      Surface own;
      own.vertices = between.vertices;
      for (std::size_t f = 0; f < sides_.size(); ++f)
        if (sides_[f].first == region || sides_[f].second == region)
          own.faces.push_back(between.faces[f]);
      drop_unused(own);
      of_[region] = std::make_unique<SurfaceTree>(std::move(own));
    }
  drop_unused(outside);
  drop_unused(between);
  outside_ = std::make_unique<SurfaceTree>(std::move(outside));
  between_ = std::make_unique<SurfaceTree>(std::move(between));
}

int BodyRegions::at(const Vec3& p) const {
  if (const int t = tets_.find(p); t >= 0) return region_[static_cast<std::size_t>(t)];
  return region_of_face_[static_cast<std::size_t>(outside_->nearest(p).face)];
}

int BodyRegions::at(const Vec3& p, const std::vector<Growth>& growth) const {
  const Corner c = corner(p);
  if (c.face < 0) return c.region;
  int shrunk = c.region;
  for (const Growth& g : growth) {
    const double level = distance(c, g.region) - g.by;
    if (level < 0) return g.region;
    if (g.region != c.region) continue;
    const auto& [a, b] = sides_[static_cast<std::size_t>(c.face)];
    shrunk = a == c.region ? b : a;
  }
  return shrunk;
}

BodyRegions::Corner BodyRegions::corner(const Vec3& p) const {
  const SurfacePoint nearest = between_->nearest(p);
  return {p, at(p), nearest.distance, nearest.face, p - nearest.point};
}

double BodyRegions::distance(const Corner& c, int region) const {
  const double sign = c.region == region ? -1 : 1;
  if (of_.empty()) return sign * c.distance;
  const auto& [a, b] = sides_[static_cast<std::size_t>(c.face)];
  if (a == region || b == region) return sign * c.distance;
  return sign * of_.at(region)->nearest(c.at).distance;
}

LevelSet BodyRegions::level(int region) const {
  return [this, region](const Vec3& p) {
    const Corner c = corner(p);
    const bool none = c.face < 0 || (!of_.empty() && of_.count(region) == 0);
    const double level =
        none ? (c.region == region ? -1.0 : 1.0) * std::numeric_limits<double>::infinity()
             : distance(c, region);
    return LevelValue{level, Eigen::VectorXd(0), std::abs(level)};
  };
}

struct BodyRegions::Cut {
  const std::vector<Growth>& growth;
  double most = 0;  // of the growths, either way [m]
  std::vector<Part> parts;

  Part& of(int region) {
    for (Part& p : parts)
      if (p.region == region) return p;
    parts.push_back({region, 0, std::vector<double>(growth.size(), 0)});
    return parts.back();
  }
};

void BodyRegions::add_part(const std::array<const Corner*, 4>& x, int subdivisions, double weight,
                           Cut& cut) const {
  double longest = 0;
  for (std::size_t i = 1; i < 4; ++i) longest = std::max(longest, (x[i]->at - x[0]->at).norm());
  if (x[0]->distance > longest + cut.most) {
    cut.of(x[0]->region).share += weight;
    return;
  }
  // Two corners of one region that see boundaries in opposite directions: something thin lies
  // between them, of which their distances know nothing.
  bool thin = false;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < i; ++j)
      thin = thin || (x[i]->region == x[j]->region && x[i]->from.dot(x[j]->from) < 0);
  if (subdivisions <= (thin ? -kThinCuts : 0)) return add_leaf(x, weight, cut);
  const auto mid = [&](std::size_t i, std::size_t j) {
    return corner(0.5 * (x[i]->at + x[j]->at));
  };
  const Corner a = mid(0, 1), b = mid(0, 2), c = mid(0, 3), d = mid(1, 2), e = mid(1, 3),
               f = mid(2, 3);
  // Eight of equal volume: four at the corners, four of the octahedron between (Bey, 1995).
  const std::array<const Corner*, 4> eighths[] = {
      {x[0], &a, &b, &c}, {&a, x[1], &d, &e}, {&b, &d, x[2], &f}, {&c, &e, &f, x[3]},
      {&a, &b, &c, &e},   {&a, &b, &d, &e},   {&b, &c, &e, &f},   {&b, &d, &e, &f}};
  for (const auto& part : eighths) add_part(part, subdivisions - 1, weight / 8, cut);
}

// Of the regions that may be here, each by itself: first what grows, of what that leaves the others
// as they share it without.
void BodyRegions::add_leaf(const std::array<const Corner*, 4>& x, double weight, Cut& cut) const {
  std::vector<int> here;
  for (const Corner* c : x)
    for (const int region : {c->region, sides_[static_cast<std::size_t>(c->face)].first,
                             sides_[static_cast<std::size_t>(c->face)].second})
      if (std::find(here.begin(), here.end(), region) == here.end()) here.push_back(region);
  for (const Growth& g : cut.growth)
    if (std::find(here.begin(), here.end(), g.region) == here.end()) here.push_back(g.region);
  std::sort(here.rbegin(), here.rend());
  const auto share_of = [&](int region, double growth) {
    return cut_share({distance(*x[0], region) - growth, distance(*x[1], region) - growth,
                      distance(*x[2], region) - growth, distance(*x[3], region) - growth});
  };
  double left = 1, sum = 0;
  std::vector<double> left_by(cut.growth.size(), 0);
  std::vector<std::pair<int, double>> rest;
  for (const int region : here) {
    const auto grown = std::find_if(cut.growth.begin(), cut.growth.end(),
                                    [&](const Growth& g) { return g.region == region; });
    if (grown == cut.growth.end()) {
      rest.emplace_back(region, share_of(region, 0).share);
      sum += rest.back().second;
      continue;
    }
    const CutShare own = share_of(region, grown->by);
    Part& part = cut.of(region);
    if (own.share >= left) {  // the higher numbers have the other part
      part.share += weight * left;
      for (std::size_t k = 0; k < left_by.size(); ++k) {
        part.by_growth[k] += weight * left_by[k];
        left_by[k] = 0;
      }
      left = 0;
      continue;
    }
    double by = 0;
    for (const double v : own.by_value) by -= v;
    const auto k = static_cast<std::size_t>(grown - cut.growth.begin());
    part.share += weight * own.share;
    part.by_growth[k] += weight * by;
    left -= own.share;
    left_by[k] -= by;
  }
  if (rest.empty()) {  // what has shrunk leaves room to what has grown most
    const auto most =
        std::max_element(cut.growth.begin(), cut.growth.end(),
                         [](const Growth& a, const Growth& b) { return a.by < b.by; });
    rest.emplace_back(most->region, sum = 1);
  }
  // Where what has shrunk was, none of the others is: the first of them goes on there.
  if (!(sum > 0)) {
    rest.front().second = sum = 1;
    for (const auto& [region, share] : rest) {
      const auto& [a, b] = sides_[static_cast<std::size_t>(x[0]->face)];
      if (region != a && region != b) continue;
      for (auto& one : rest) one.second = one.first == region ? 1 : 0;
      break;
    }
  }
  for (const auto& [region, share] : rest) {
    if (share <= 0) continue;
    Part& part = cut.of(region);
    part.share += weight * left * share / sum;
    for (std::size_t k = 0; k < left_by.size(); ++k)
      part.by_growth[k] += weight * left_by[k] * share / sum;
  }
}

std::vector<BodyRegions::Part> BodyRegions::parts(const TetMesh& mesh, std::size_t t,
                                                  const std::vector<Growth>& growth) const {
  const auto& n = mesh.tets[t];
  const std::array<Vec3, 4> p{mesh.nodes[n[0]], mesh.nodes[n[1]], mesh.nodes[n[2]],
                              mesh.nodes[n[3]]};
  const Vec3 centre = 0.25 * (p[0] + p[1] + p[2] + p[3]);
  Cut cut{growth, 0, {}};
  for (const Growth& g : growth) cut.most = std::max(cut.most, std::abs(g.by));
  double reach = cut.most;
  for (const Vec3& c : p) reach = std::max(reach, cut.most + (c - centre).norm());
  if (!(between_->nearest(centre).distance <= reach)) {
    cut.of(at(centre)).share = 1;
    return cut.parts;
  }
  const std::array<Corner, 4> x{corner(p[0]), corner(p[1]), corner(p[2]), corner(p[3])};
  add_part({&x[0], &x[1], &x[2], &x[3]}, kCuts, 1, cut);
  std::erase_if(cut.parts, [](const Part& part) {
    return part.share <= 0 && std::all_of(part.by_growth.begin(), part.by_growth.end(),
                                          [](double by) { return by == 0; });
  });
  std::sort(cut.parts.begin(), cut.parts.end(),
            [](const Part& a, const Part& b) { return a.region < b.region; });
  return cut.parts;
}

}  // namespace hapsim
