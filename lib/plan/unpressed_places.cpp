#include "plan/unpressed_places.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "plan/spacing.h"

namespace hapsim {
namespace {

constexpr std::size_t kMostFaces = 5000;  // that are looked at
constexpr double kSameWay = 0.7;          // cosine between the normals
constexpr double kAround = 0.75;          // of the spacing of the pressed positions
constexpr double kAlone = 6;              // spacing where one position is all, in tool radii

struct Place {
  Vec3 point;
  double distance;  // from what is pressed or chosen
};

// Of the pressed places, in tool radii where one is all.
double spacing_of_pressed(const std::vector<PreparedContact>& pressed, double tool_radius) {
  std::vector<Vec3> points;
  for (const PreparedContact& p : pressed) points.push_back(p.point);
  const double spacing = spacing_of(points);
  return std::isfinite(spacing) ? spacing : kAlone * tool_radius;
}

std::vector<Place> places_near(const Surface& surface, const std::vector<PreparedContact>& pressed,
                               double least, double most) {
  std::vector<Place> places;
  const std::size_t every = 1 + surface.faces.size() / kMostFaces;
  for (std::size_t f = 0; f < surface.faces.size(); f += every) {
    const Triangle& face = surface.faces[f];
    const Vec3 middle =
        (surface.vertices[face[0]] + surface.vertices[face[1]] + surface.vertices[face[2]]) / 3;
    const PreparedContact* nearest = &pressed.front();
    for (const PreparedContact& p : pressed)
      if ((p.point - middle).squaredNorm() < (nearest->point - middle).squaredNorm()) nearest = &p;
    const double distance = (nearest->point - middle).norm();
    const Vec3 normal = face_normal(surface, static_cast<int>(f)).normalized();
    if (distance < least || distance > most || normal.dot(nearest->normal) < kSameWay) continue;
    places.push_back({middle, distance});
  }
  return places;
}

}  // namespace

std::vector<Vec3> unpressed_places(const Surface& surface,
                                   const std::vector<PreparedContact>& pressed, double tool_radius,
                                   std::size_t count) {
  std::vector<Vec3> chosen;
  if (pressed.empty()) return chosen;
  std::vector<Place> places = places_near(surface, pressed, tool_radius,
                                          kAround * spacing_of_pressed(pressed, tool_radius));
  while (chosen.size() < count && !places.empty()) {
    const auto farthest =
        std::max_element(places.begin(), places.end(),
                         [](const Place& a, const Place& b) { return a.distance < b.distance; });
    if (farthest->distance < tool_radius) break;
    const Vec3 point = farthest->point;
    chosen.push_back(point);
    for (Place& p : places) p.distance = std::min(p.distance, (p.point - point).norm());
  }
  return chosen;
}

}  // namespace hapsim
