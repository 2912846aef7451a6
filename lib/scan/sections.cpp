#include "scan/sections.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/median.h"

namespace hapsim {
namespace {

using Vec2 = Eigen::Vector2d;

// Whether the ray from p along +x crosses the polygon an odd number of times.
bool odd_crossings(const std::vector<Vec2>& polygon, const Vec2& p) {
  bool odd = false;
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
    const Vec2 &a = polygon[i], &b = polygon[j];
    if ((a.y() > p.y()) == (b.y() > p.y())) continue;
    if (p.x() < (b.x() - a.x()) * (p.y() - a.y()) / (b.y() - a.y()) + a.x()) odd = !odd;
  }
  return odd;
}

double signed_area(const std::vector<Vec2>& polygon) {
  double sum = 0;
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
    sum += polygon[j].x() * polygon[i].y() - polygon[i].x() * polygon[j].y();
  }
  return sum / 2;
}

// Outward in the plane at each point of a contour, by the chord of its neighbours; a contour within
// an odd number of others is a hole.
std::vector<Vec2> contour_normals(const Section& section, std::size_t c) {
  const std::vector<Vec2>& contour = section.contours[c];
  bool hole = false;
  for (std::size_t o = 0; o < section.contours.size(); ++o) {
    if (o != c && odd_crossings(section.contours[o], contour[0])) hole = !hole;
  }
  const double sign = (signed_area(contour) > 0) != hole ? 1 : -1;
  std::vector<Vec2> normals;
  for (std::size_t i = 0; i < contour.size(); ++i) {
    const Vec2 &before = contour[(i + contour.size() - 1) % contour.size()],
               &after = contour[(i + 1) % contour.size()];
    // By the circle through the three: each chord's direction weighs as the other's length.
    const Vec2 a = contour[i] - before, b = after - contour[i];
    Vec2 along = a * b.squaredNorm() + b * a.squaredNorm();
    if (!(along.norm() > 0)) along = b;
    normals.push_back(sign * Vec2(along.y(), -along.x()).normalized());
  }
  return normals;
}

double usual_spacing(const std::vector<Section>& sections) {
  std::vector<double> steps;
  for (const Section& s : sections) {
    for (const auto& c : s.contours) {
      for (std::size_t i = 1; i < c.size(); ++i) steps.push_back((c[i] - c[i - 1]).norm());
    }
  }
  return upper_median(std::move(steps));
}

// Along the in-plane direction n from p: the place where the field between two sections is zero.
bool find_between(const Section& low, const Section& high, double part, const Vec2& p,
                  const Vec2& n, Vec2& found) {
  const auto field = [&](double s) {
    const Vec2 at = p + s * n;
    return (1 - part) * low.distance(at) + part * high.distance(at);
  };
  double a = 0, fa = field(0);
  // Distances change no faster than the place: the zero lies at least this far, try twice it.
  double b = -2 * fa, fb = field(b);
  if (fa == 0) {
    found = p;
    return true;
  }
  if (fa * fb > 0) return false;
  for (int k = 0; k < 60 && std::abs(b - a) > 1e-9; ++k) {
    const double middle = (a + b) / 2, fm = field(middle);
    (fa * fm <= 0 ? b : a) = middle;
    if (fa * fm > 0) fa = fm;
  }
  found = p + (a + b) / 2 * n;
  return true;
}

void add(Scan& scan, const Vec2& at, double z, const Vec2& in_plane, double slope) {
  scan.cloud.points.emplace_back(at.x(), at.y(), z);
  scan.cloud.normals.push_back(Vec3(in_plane.x(), in_plane.y(), slope).normalized());
}

void add_between(const Section& low, const Section& high, int levels, Scan& scan) {
  for (int level = 1; level < levels; ++level) {
    const double part = static_cast<double>(level) / levels, height = high.z - low.z;
    const Section& near = part < 0.5 ? low : high;
    for (std::size_t c = 0; c < near.contours.size(); ++c) {
      const std::vector<Vec2> normals = contour_normals(near, c);
      for (std::size_t i = 0; i < normals.size(); ++i) {
        Vec2 at;
        if (!find_between(low, high, part, near.contours[c][i], normals[i], at)) continue;
        Vec2 one, two;
        const double d_low = low.distance(at, &one), d_high = high.distance(at, &two);
        const Vec2 gradient = (1 - part) * one + part * two;
        const double slope = (d_high - d_low) / height;
        if (gradient.norm() + std::abs(slope) < 1e-9) continue;
        add(scan, at, low.z + part * height, gradient, slope);
      }
    }
  }
}

}  // namespace

double Section::distance(const Vec2& p, Vec2* gradient) const {
  double least = std::numeric_limits<double>::infinity();
  Vec2 nearest = p;
  bool inside = false;
  for (const auto& contour : contours) {
    if (odd_crossings(contour, p)) inside = !inside;
    for (std::size_t i = 0, j = contour.size() - 1; i < contour.size(); j = i++) {
      const Vec2 &a = contour[j], edge = contour[i] - a;
      const double length = edge.squaredNorm();
      const double t = length > 0 ? std::clamp((p - a).dot(edge) / length, 0.0, 1.0) : 0;
      const Vec2 on = a + t * edge;
      const double squared = (p - on).squaredNorm();
      if (squared >= least) continue;
      least = squared;
      nearest = on;
    }
  }
  const double length = std::sqrt(least), sign = inside ? -1 : 1;
  if (gradient != nullptr) {
    *gradient = length > 0 ? Vec2(sign * (p - nearest) / length) : Vec2(Vec2::Zero());
  }
  return sign * length;
}

Scan sections_scan(const std::vector<Section>& sections) {
  constexpr int kMostLevels = 10;
  Scan scan;
  const double spacing = usual_spacing(sections);
  for (std::size_t s = 0; s < sections.size(); ++s) {
    const Section& here = sections[s];
    const Section& below = sections[s > 0 ? s - 1 : s];
    const Section& above = sections[s + 1 < sections.size() ? s + 1 : s];
    for (std::size_t c = 0; c < here.contours.size(); ++c) {
      const std::vector<Vec2> normals = contour_normals(here, c);
      for (std::size_t i = 0; i < normals.size(); ++i) {
        const Vec2& p = here.contours[c][i];
        const double rise = above.distance(p) - below.distance(p);
        add(scan, p, here.z, normals[i], rise / (above.z - below.z));
      }
    }
    if (s + 1 == sections.size()) continue;
    const double gap = above.z - here.z;
    const int levels =
        static_cast<int>(std::clamp(std::round(gap / spacing), 1.0, 1.0 * kMostLevels));
    add_between(here, above, levels, scan);
  }
  return scan;
}

}  // namespace hapsim
