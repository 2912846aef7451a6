#include "diagnose/left_line.h"

#include <algorithm>
#include <cmath>
#include <vector>

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

}  // namespace hapsim
