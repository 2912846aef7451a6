#include "diagnose/locked_events.h"

#include <algorithm>
#include <array>

#include "diagnose/gates.h"
#include "estimate/probability.h"

namespace hapsim {
namespace {

// P(X >= k) of n draws of chance q (the binomial law as Fisher's F).
double at_least(int k, int n, double q) {
  if (k <= 0 || q >= 1) return 1;
  const double more = k, others = n - k + 1;
  return fisher_upper(more * (1 - q) / (others * q), 2 * others, 2 * more);
}

}  // namespace

LockedEvents find_locked_events(const Dataset& dataset, const Eigen::VectorXd& residual,
                                double noise) {
  constexpr int kParts = LockedEvents::kParts;
  const double far = LockedEvents::kFarOff * noise;
  std::array<int, kParts> presses{};
  LockedEvents events;
  Eigen::Index at = 0;
  for (const Episode& e : dataset.episodes) {
    const std::size_t n = e.rows.size();
    std::array<bool, kParts> has{};
    for (std::size_t i = 0; i < n; ++i, at += 3)
      if (residual.segment<3>(at).cwiseAbs().maxCoeff() > far) has[i * kParts / n] = true;
    if (n < kParts) continue;
    ++events.of;
    for (std::size_t b = 0; b < kParts; ++b) presses[b] += has[b] ? 1 : 0;
  }
  int all = 0;
  for (const int k : presses) all += k;
  if (all == 0) return events;
  const auto most = std::max_element(presses.begin(), presses.end());
  const auto part = static_cast<double>(most - presses.begin());
  events.presses = *most;
  events.from = part / kParts;
  events.until = (part + 1) / kParts;
  events.found =
      kParts * at_least(*most, events.of, static_cast<double>(all) / (kParts * events.of)) <
      kStrained;
  return events;
}

}  // namespace hapsim
