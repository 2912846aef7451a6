#include "diagnose/law_samples.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <vector>

namespace hapsim {
namespace {

constexpr std::size_t kMany = 10000;  // samples
constexpr double kTurn = 0.01;        // of the longest way, within which an axis turns

using Column = LawSamples::Column;
using Vectors = LawSamples::Vectors;

Vectors slope(const Vectors& v, const std::vector<double>& t) {
  Vectors d = Vectors::Zero(3, v.cols());
  const auto last = v.cols() - 1;
  for (Eigen::Index i = 0; i <= last; ++i) {
    const Eigen::Index a = std::max<Eigen::Index>(0, i - 1), b = std::min(last, i + 1);
    const double dt = t[static_cast<std::size_t>(b)] - t[static_cast<std::size_t>(a)];
    if (dt > 0) d.col(i) = (v.col(b) - v.col(a)) / dt;
  }
  return d;
}

// Of the presses before, of all or of one place.
struct Before {
  int presses = 0;
  double deepest = 0, ended = 0;
  Vec3 point = Vec3::Zero(), u = Vec3::Zero();  // of the last one: where, and where the tool left

  // How long ago at `now`, the natural logarithm [s]; of none `ever`.
  double rest(double now, double ever) const {
    constexpr double kShortest = 0.1;
    return std::log(std::max(kShortest, presses > 0 ? now - ended : ever));
  }
};

}  // namespace

LawSamples law_samples(const Eigen::VectorXd& forces, const Dataset& dataset) {
  const std::size_t stride = 1 + static_cast<std::size_t>(forces.size()) / 3 / kMany;
  const Eigen::Index all = forces.size() / 3;
  const Eigen::Index count =
      (all + static_cast<Eigen::Index>(stride) - 1) / static_cast<Eigen::Index>(stride);
  LawSamples s;
  s.timed = s.warmed = true;
  for (Column* c :
       {&s.depth, &s.speed, &s.fastest, &s.deepest, &s.ever, &s.growth, &s.age, &s.session,
        &s.number, &s.temperature, &s.last_depth, &s.rest, &s.rest_here, &s.here})
    *c = Column::Zero(count);
  for (Vectors* v : {&s.f, &s.along, &s.across, &s.normal, &s.u, &s.velocity, &s.acceleration,
                     &s.way, &s.rate, &s.came, &s.last_u, &s.place})
    *v = Vectors::Zero(3, count);
  double longest = 0;
  for (const Vec3& u : dataset.recording.u) longest = std::max(longest, u.norm());
  std::map<int, Before> places;
  Before before;
  double span = 0;
  for (const Episode& e : dataset.episodes)
    if (!e.view.session.empty()) span = std::max(span, e.view.session.back());
  Eigen::Index at = 0;
  int press = -1;
  for (const Episode& e : dataset.episodes) {
    ++press;
    const auto n = static_cast<Eigen::Index>(e.rows.size());
    const Vectors f = forces.segment(3 * at, 3 * n).reshaped(3, n);
    Vectors u(3, n);
    for (Eigen::Index i = 0; i < n; ++i)
      u.col(i) = dataset.recording.u[static_cast<std::size_t>(e.rows[static_cast<std::size_t>(i)])];
    s.timed = s.timed && !e.view.session.empty();
    s.warmed = s.warmed && !e.view.temperature.empty();
    const Vectors v = s.timed ? slope(u, e.view.t) : Vectors::Zero(3, n);
    const Vectors a = s.timed ? slope(v, e.view.t) : Vectors::Zero(3, n);
    const Vectors df = s.timed ? slope(f, e.view.t) : Vectors::Zero(3, n);
    Before& place = places[e.position];
    const Vec3& point = dataset.positions[static_cast<std::size_t>(e.position)];
    const double began = s.timed ? e.view.session.front() : 0;
    double fastest = 0, deepest = 0;
    Vec3 way = Vec3::Zero();
    for (Eigen::Index i = 0; i < n; ++i) {
      fastest = std::max(fastest, v.col(i).norm());
      deepest = std::max(deepest, u.col(i).norm());
      if (i > 0)
        way = (way + (u.col(i) - u.col(i - 1)) / (kTurn * longest)).cwiseMax(-1).cwiseMin(1);
      if ((at + i) % static_cast<Eigen::Index>(stride) != 0) continue;
      const auto k = static_cast<Eigen::Index>(s.kept.size());
      s.kept.push_back(at + i);
      s.since.push_back(i);
      s.press.push_back(press);
      s.depth[k] = u.col(i).norm();
      s.speed[k] = v.col(i).norm();
      s.fastest[k] = fastest;
      s.growth[k] = s.depth[k] > 0 ? v.col(i).dot(u.col(i)) / s.depth[k] : s.speed[k];
      s.deepest[k] = deepest;
      s.ever[k] = std::max(deepest, place.deepest);
      s.number[k] = place.presses;
      s.last_depth[k] = before.deepest;
      s.rest[k] = before.rest(began, span);
      s.rest_here[k] = place.rest(began, span);
      s.here[k] = place.presses > 0 ? 1 : 0;
      if (before.presses > 0) s.came.col(k) = before.point - point;
      s.last_u.col(k) = before.u;
      s.place.col(k) = point;
      if (s.warmed) s.temperature[k] = e.view.temperature[static_cast<std::size_t>(i)];
      if (s.timed) {
        s.age[k] = e.view.t[static_cast<std::size_t>(i)];
        s.session[k] = e.view.session[static_cast<std::size_t>(i)];
      }
      s.f.col(k) = f.col(i);
      s.along.col(k) = f.col(i).dot(e.view.normal) * e.view.normal;
      s.across.col(k) = s.f.col(k) - s.along.col(k);
      s.normal.col(k) = e.view.normal;
      s.u.col(k) = u.col(i);
      s.velocity.col(k) = v.col(i);
      s.acceleration.col(k) = a.col(i);
      s.way.col(k) = way;
      s.rate.col(k) = df.col(i);
    }
    at += n;
    for (Before* of : {&place, &before}) {
      ++of->presses;
      of->ended = s.timed ? e.view.session.back() : 0;
      of->point = point;
      of->u = u.col(n - 1);
    }
    place.deepest = std::max(place.deepest, deepest);
    before.deepest = deepest;
  }
  return s;
}

std::vector<Eigen::Index> stacked_components(const LawSamples& s) {
  std::vector<Eigen::Index> rows;
  for (const Eigen::Index sample : s.kept)
    for (Eigen::Index c = 0; c < 3; ++c) rows.push_back(3 * sample + c);
  return rows;
}

}  // namespace hapsim
