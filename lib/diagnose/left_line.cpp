#include "diagnose/left_line.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "diagnose/foreseen.h"
#include "estimate/spectral_line.h"

namespace hapsim {
namespace {

// Of some presses, one after the other.
struct Span {
  std::vector<double> t;
  std::vector<Vec3> values;
  double squares = 0;
};

// A sine and a cosine take off most of these squares.
bool mostly_line(const Span& span, const SpectralLine& line) {
  double rest = 0;
  for (std::size_t i = 0; i < span.t.size(); ++i) {
    const double angle = 2 * M_PI * line.frequency * span.t[i];
    rest += (span.values[i] - std::sin(angle) * line.sine - std::cos(angle) * line.cosine)
                .squaredNorm();
  }
  return rest < 0.5 * span.squares;
}

}  // namespace

LineLeft find_line_left(const Eigen::VectorXd& residual, const Dataset& dataset) {
  constexpr std::size_t kShortest = 4, kFewest = 4;  // of the session; presses
  std::vector<Span> presses;
  Eigen::Index at = 0;
  for (const Episode& e : dataset.episodes) {
    Span& press = presses.emplace_back();
    for (std::size_t i = 0; i < e.rows.size(); ++i, at += 3) {
      if (e.view.session.empty()) continue;
      press.t.push_back(e.view.session[i]);
      press.values.emplace_back(residual.segment<3>(at));
    }
  }
  for (std::size_t parts = kShortest; parts > 0; parts /= 2) {
    const std::size_t count = presses.size() / parts;
    const bool part = parts > 1;
    if (part && count < kFewest) continue;
    // The whole session's hum gives a part no more than its part.
    const double least = part ? 0.5 + 0.5 / static_cast<double>(parts) : 0;
    for (std::size_t first = 0; first + count <= presses.size();
         first += std::max<std::size_t>(1, count / 2)) {
      Span span;
      for (std::size_t k = first; k < first + count; ++k) {
        span.t.insert(span.t.end(), presses[k].t.begin(), presses[k].t.end());
        span.values.insert(span.values.end(), presses[k].values.begin(), presses[k].values.end());
      }
      for (const Vec3& v : span.values) span.squares += v.squaredNorm();
      if (span.squares < least * residual.squaredNorm()) continue;
      const SpectralLine line = find_line(span.t, span.values, count, kNyquist);
      if (line.frequency > 0 && (!part || mostly_line(span, line)))
        return {line.frequency, span.t.front(), span.t.back(), !part};
    }
  }
  return {};
}

double swing_left(const Eigen::VectorXd& residual, const Dataset& dataset, double noise) {
  constexpr double kMost = 0.5, kLeastShare = 0.05, kMostShare = 0.9;  // of the Nyquist frequency
  std::vector<Eigen::Index> lengths;
  std::vector<double> steps;
  for (const Episode& e : dataset.episodes) {
    lengths.push_back(static_cast<Eigen::Index>(e.rows.size()));
    for (std::size_t i = 1; i < e.view.t.size(); ++i)
      steps.push_back(e.view.t[i] - e.view.t[i - 1]);
  }
  const double squares = residual.squaredNorm();
  const double beyond =
      squares - noise * noise * dataset.axes() / 3.0 * static_cast<double>(residual.size());
  if (steps.empty() || !(beyond > 0)) return 0;
  const Forecast next = forecast(residual, lengths, 2);
  const double a = next.by[0], b = next.by[1];
  if (next.share * squares < kMost * beyond || a * a + 4 * b >= 0) return 0;
  const double share = std::acos(std::clamp(a / (2 * std::sqrt(-b)), -1.0, 1.0)) / M_PI;
  if (share < kLeastShare || share > kMostShare) return 0;
  std::nth_element(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2),
                   steps.end());
  const double step = steps[steps.size() / 2];
  return step > 0 ? share / (2 * step) : 0;
}

}  // namespace hapsim
