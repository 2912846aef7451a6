#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "compare/residuals.h"

namespace hapsim {
namespace {

constexpr double kSamePosition = 1e-4;    // [m]
constexpr double kTouching = 1e-9;        // [m]; less displacement is none
constexpr double kRateWindow = 0.01;      // [s] to each side
constexpr double kHoldShare = 0.05;       // of the press's fastest motion
constexpr double kSidewaysCosine = 0.94;  // 20 degrees

// Numbers distinct points, each found again through a grid of cells of its own tolerance.
class PointIndex {
 public:
  explicit PointIndex(std::vector<Vec3>& points) : points_(points) {}
  int of(const Vec3& p) {
    if (last_ >= 0 && (points_[last_] - p).norm() < kSamePosition) return last_;
    const std::array<long, 3> cell{at(p[0]), at(p[1]), at(p[2])};
    for (long a = -1; a <= 1; ++a)
      for (long b = -1; b <= 1; ++b)
        for (long c = -1; c <= 1; ++c) {
          const auto found = cells_.find({cell[0] + a, cell[1] + b, cell[2] + c});
          if (found != cells_.end() && (points_[found->second] - p).norm() < kSamePosition)
            return last_ = found->second;
        }
    last_ = static_cast<int>(points_.size());
    points_.push_back(p);
    cells_.emplace(cell, last_);
    return last_;
  }

 private:
  static long at(double x) { return std::lround(x / kSamePosition); }
  std::vector<Vec3>& points_;
  std::map<std::array<long, 3>, int> cells_;
  int last_ = -1;
};

// Velocity of the tool about row i of a press, over the rows within the window.
Vec3 velocity(const Recording& r, const std::vector<int>& rows, std::size_t i) {
  std::size_t a = i > 0 ? i - 1 : i;
  std::size_t b = i + 1 < rows.size() ? i + 1 : i;
  while (a > 0 && r.t[rows[i]] - r.t[rows[a - 1]] <= kRateWindow) --a;
  while (b + 1 < rows.size() && r.t[rows[b + 1]] - r.t[rows[i]] <= kRateWindow) ++b;
  const double dt = r.t[rows[b]] - r.t[rows[a]];
  if (!(dt > 0)) return Vec3::Zero();
  return (r.u[rows[b]] - r.u[rows[a]]) / dt;
}

// The row from which a press touches: the last one before the first displacement or contact.
std::size_t touching_from(const Recording& r, const std::vector<int>& rows) {
  std::size_t first = 0;
  while (first < rows.size() &&
         (r.in_air(rows[first]) || (r.contact.empty() && r.u[rows[first]].norm() <= kTouching)))
    ++first;
  if (first == rows.size()) return 0;
  return first > 0 && r.contact.empty() ? first - 1 : first;
}

// Loading, unloading or hold from the growth of the depth; without time by row.
void set_phases(const Recording& r, const std::vector<int>& rows, RowFacts& facts) {
  const std::size_t n = rows.size();
  const std::size_t touch = touching_from(r, rows);
  std::vector<double> growth(n, 0), speed(n, 0);
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3& u = r.u[rows[i]];
    Vec3 v = r.t.empty() ? Vec3(r.u[rows[std::min(i + 1, n - 1)]] - r.u[rows[i > 0 ? i - 1 : 0]])
                         : velocity(r, rows, i);
    speed[i] = v.norm();
    growth[i] = u.norm() > kTouching ? v.dot(u) / u.norm() : speed[i] * (i < n / 2 ? 1 : -1);
    if (!r.t.empty()) facts.rate[rows[i]] = speed[i];
  }
  const double hold = kHoldShare * *std::max_element(speed.begin(), speed.end());
  for (std::size_t i = 0; i < n; ++i) {
    Phase& phase = facts.phase[rows[i]];
    if (i < touch || r.in_air(rows[i]))
      phase = Phase::kAir;
    else if (speed[i] <= hold)
      phase = Phase::kHold;
    else
      phase = growth[i] >= 0 ? Phase::kLoading : Phase::kUnloading;
  }
}

// Time since touch, and the clock of the session.
void set_ages(const Recording& r, const std::vector<int>& rows, double& clock, double& last_time,
              RowFacts& facts) {
  if (r.t.empty()) return;
  const std::size_t touch = touching_from(r, rows);
  // A press that begins before the last one ended has a clock of its own: lay it end to end.
  const double begin = r.t[rows.front()];
  if (begin + clock < last_time) clock = last_time - begin;
  for (const int row : rows) {
    facts.contact_age[row] = r.t[row] - r.t[rows[touch]];
    facts.session[row] = r.t[row] + clock;
  }
  last_time = r.t[rows.back()] + clock;
}

Vec3 deepest_direction(const Recording& r, const std::vector<int>& rows) {
  int deepest = rows.front();
  for (const int row : rows)
    if (r.u[row].squaredNorm() > r.u[deepest].squaredNorm()) deepest = row;
  const double length = r.u[deepest].norm();
  return length > kTouching ? Vec3(r.u[deepest] / length) : Vec3(Vec3::Zero());
}

// The direction with the largest sum of cosines to the others, turned out of the body.
Vec3 outward(const std::vector<Vec3>& directions) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& d : directions) sum += d;
  Vec3 best(0, 0, -1);
  double most = -1e300;
  for (const Vec3& d : directions)
    if (!d.isZero() && d.dot(sum) > most) {
      most = d.dot(sum);
      best = d;
    }
  return -best;
}

}  // namespace

RowFacts row_facts(const Recording& measured) {
  const std::size_t n = measured.rows();
  RowFacts facts;
  facts.press.resize(n);
  facts.position.resize(n);
  facts.depth.resize(n);
  facts.phase.resize(n);
  facts.temperature = measured.temp;
  for (auto* timed : {&facts.rate, &facts.contact_age, &facts.session})
    timed->resize(measured.t.empty() ? 0 : n);

  PointIndex points(facts.positions);
  for (std::size_t i = 0; i < n; ++i) {
    facts.position[i] = points.of(measured.position[i]);
    facts.depth[i] = measured.u[i].norm();
  }
  double clock = 0, last_time = -1e300;
  std::vector<std::vector<Vec3>> directions(facts.positions.size());
  std::vector<std::pair<int, Vec3>> deepest;  // of each press: its position and direction
  for (const Press& press : measured.presses()) {
    for (const int row : press.rows) facts.press[row] = static_cast<int>(facts.press_ids.size());
    facts.press_ids.push_back(press.id);
    set_phases(measured, press.rows, facts);
    set_ages(measured, press.rows, clock, last_time, facts);
    deepest.emplace_back(facts.position[press.rows.front()],
                         deepest_direction(measured, press.rows));
    facts.repeated.push_back(!directions[deepest.back().first].empty());
    directions[deepest.back().first].push_back(deepest.back().second);
  }
  for (const auto& at_position : directions) facts.normal.push_back(outward(at_position));
  for (const auto& [position, direction] : deepest)
    facts.sideways.push_back(!direction.isZero() &&
                             -direction.dot(facts.normal[position]) < kSidewaysCosine);
  return facts;
}

}  // namespace hapsim
