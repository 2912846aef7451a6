#include "compare/idle_force.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "estimate/probability.h"

namespace hapsim {
namespace {

struct Intercept {
  Vec3 b;       // [N]
  double time;  // middle of the press in the session [s]
};

// Sums of one press for the regression of the residual on (s, 1) with a common gain.
struct PressSums {
  double n = 0, ss = 0, sr = 0, time = 0;
  Vec3 s = Vec3::Zero(), r = Vec3::Zero();
};

std::vector<Intercept> intercepts(const RowFacts& facts, const std::vector<Vec3>& measured,
                                  const std::vector<Vec3>& simulated) {
  std::vector<PressSums> presses(facts.press_ids.size());
  for (std::size_t i = 0; i < measured.size(); ++i) {
    PressSums& p = presses[facts.press[i]];
    const Vec3 r = measured[i] - simulated[i];
    p.n += 1;
    p.s += simulated[i];
    p.r += r;
    p.ss += simulated[i].squaredNorm();
    p.sr += simulated[i].dot(r);
    if (!facts.session.empty()) p.time += facts.session[i];
  }
  std::vector<Intercept> result;
  for (const PressSums& p : presses) {
    const double spread = p.ss - p.s.squaredNorm() / p.n;
    if (p.n < 5 || !(spread > 0.05 * p.ss)) continue;  // a constant force tells no intercept
    const double gain = (p.sr - p.s.dot(p.r) / p.n) / spread;
    result.push_back({(p.r - gain * p.s) / p.n, p.time / p.n});
  }
  return result;
}

// Squared error that is left when a common gain is fitted as well.
double error_with_gain(const std::vector<Vec3>& m, const std::vector<Vec3>& s,
                       const std::vector<Vec3>& offset) {
  double ss = 0, sr = 0, rr = 0;
  for (std::size_t i = 0; i < m.size(); ++i) {
    const Vec3 r = m[i] - s[i] - (offset.empty() ? Vec3(Vec3::Zero()) : offset[i]);
    ss += s[i].squaredNorm();
    sr += s[i].dot(r);
    rr += r.squaredNorm();
  }
  return rr - (ss > 0 ? sr * sr / ss : 0);
}

OffsetHypothesis finish(OffsetHypothesis h, const std::vector<Vec3>& offset,
                        const std::vector<Vec3>& measured, const std::vector<Vec3>& simulated,
                        double chance) {
  h.explained = error_with_gain(measured, simulated, {}) -
                error_with_gain(measured, simulated, offset) - chance;
  h.corrected = simulated;
  for (std::size_t i = 0; i < simulated.size(); ++i) h.corrected[i] += offset[i];
  return h;
}

std::string newtons(const Vec3& v) {
  return fmt::format("({:+.3f}, {:+.3f}, {:+.3f})", v[0], v[1], v[2]);
}

}  // namespace

std::vector<OffsetHypothesis> try_offsets(const RowFacts& facts, const std::vector<Vec3>& measured,
                                          const std::vector<Vec3>& simulated, double noise) {
  const std::vector<Intercept> presses = intercepts(facts, measured, simulated);
  const auto C = static_cast<double>(presses.size());
  const double chance = 3 * noise * noise;
  std::vector<OffsetHypothesis> result;
  if (C < 4) return result;

  Vec3 mean = Vec3::Zero(), square = Vec3::Zero();
  double time = 0, spread = 0;
  for (const Intercept& p : presses) mean += p.b / C, time += p.time / C;
  Vec3 slope = Vec3::Zero();
  for (const Intercept& p : presses) {
    square += (p.b - mean).cwiseAbs2();
    spread += (p.time - time) * (p.time - time);
    slope += (p.time - time) * (p.b - mean);
  }
  const auto smallest = [](const Vec3& value, const Vec3& variance, double freedom) {
    double p = 1;
    for (int k = 0; k < 3; ++k)
      if (variance[k] > 0)
        p = std::min(p, student_two_sided(value[k] / std::sqrt(variance[k]), freedom));
    return std::min(1.0, 3 * p);
  };

  OffsetHypothesis constant;
  constant.name = "offset";
  constant.p_value = smallest(mean, square / (C - 1) / C, C - 1);
  constant.sentence = fmt::format(
      "The measured force is off by a constant {} N, {}.", newtons(mean),
      std::find(facts.phase.begin(), facts.phase.end(), Phase::kAir) != facts.phase.end()
          ? "pressed or not, as by a sensor's zero"
          : "at any depth; samples in the air would tell whether it is the sensor's zero");
  result.push_back(finish(std::move(constant), std::vector<Vec3>(measured.size(), mean), measured,
                          simulated, chance));

  if (C < 5 || facts.session.empty() || !(spread > 0)) return result;
  slope /= spread;
  Vec3 rest = Vec3::Zero();
  for (const Intercept& p : presses) rest += (p.b - mean - slope * (p.time - time)).cwiseAbs2();
  OffsetHypothesis drift;
  drift.name = "drift";
  drift.p_value = smallest(slope, rest / (C - 2) / spread, C - 2);
  const double start = *std::min_element(facts.session.begin(), facts.session.end());
  drift.sentence = fmt::format(
      "The measured force drifts: off by {} N at the start, changing by {} N per minute.",
      newtons(mean + slope * (start - time)), newtons(60 * slope));
  std::vector<Vec3> offset(measured.size());
  for (std::size_t i = 0; i < offset.size(); ++i)
    offset[i] = mean + slope * (facts.session[i] - time);
  result.push_back(finish(std::move(drift), offset, measured, simulated, 2 * chance));
  return result;
}

}  // namespace hapsim
