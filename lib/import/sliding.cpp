#include "import/sliding.h"

#include <algorithm>

#include "base/median.h"

namespace hapsim {
namespace {

constexpr double kFar = 3e-3;  // [m]

// Force above which a row has contact: a fifth of the largest over what stands in the air.
double contact_force(const Samples& samples, const std::vector<int>& rows) {
  std::vector<double> force;
  for (const int row : rows) force.push_back(samples[VectorRole::kForce][at(row)].norm());
  const double top = quantile(force, 0.98), rest = quantile(force, 0.02);
  return rest + 0.2 * (top - rest);
}

double extent(const std::vector<double>& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return *high - *low;
}

}  // namespace

Vec3 mean_force_direction(const Samples& samples, const std::vector<int>& rows) {
  const double limit = contact_force(samples, rows);
  Vec3 sum = Vec3::Zero();
  for (const int row : rows) {
    const Vec3& f = samples[VectorRole::kForce][at(row)];
    if (f.norm() >= limit) sum += f;
  }
  return sum.norm() > 0 ? Vec3(sum.normalized()) : Vec3::UnitZ();
}

bool slides(const std::vector<Vec3>& tip, const Samples& samples, const std::vector<int>& rows) {
  if (samples[VectorRole::kForce].empty() || rows.size() < 20) return false;
  const double limit = contact_force(samples, rows);
  const Vec3 along = mean_force_direction(samples, rows);
  const Vec3 one = along.unitOrthogonal(), two = along.cross(one);
  std::vector<double> steps;
  for (std::size_t i = 1; i < rows.size(); ++i)
    steps.push_back((tip[at(rows[i])] - tip[at(rows[i - 1])]).norm());
  const double jump = std::max(4 * quantile(std::move(steps), 0.75), 1e-3);
  std::size_t touching = 0, sliding = 0;
  for (std::size_t i = 0; i < rows.size();) {
    std::vector<double> a, b, c;
    // One contact; a few rows without force do not end it, a jump to another place does.
    std::size_t quiet = 0;
    for (; i < rows.size() && quiet < 5; ++i) {
      const Vec3& p = tip[at(rows[i])];
      if (!a.empty() && (p - tip[at(rows[i - 1])]).norm() > jump) break;
      if (samples[VectorRole::kForce][at(rows[i])].norm() < limit) {
        ++quiet;
        continue;
      }
      quiet = 0;
      a.push_back(p.dot(along));
      b.push_back(p.dot(one));
      c.push_back(p.dot(two));
    }
    if (a.size() < 3) continue;
    touching += a.size();
    const double sideways = std::max(extent(b), extent(c));
    if (sideways > kFar && sideways > 2 * extent(a)) sliding += a.size();
  }
  return touching > 0 && 2 * sliding > touching;
}

}  // namespace hapsim
