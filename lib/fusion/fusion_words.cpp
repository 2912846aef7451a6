#include "fusion/fusion_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace hapsim {

std::string fusion_words(const FusionReport& report) {
  const auto band = report.band();
  const double mean = report.mean_nis();
  return fmt::format(
      "{} slow forces taken, {} refused; NIS {:.3g}, {} its 95 % band {:.3g} to {:.3g}; "
      "{:.1f} % of them single below their 95 % point; correlation with the one before "
      "{:.2f}",
      report.observations, report.refused, mean,
      mean >= band[0] && mean <= band[1] ? "within" : "outside", band[0], band[1],
      100.0 * static_cast<double>(report.within) / static_cast<double>(std::max(report.judged, 1L)),
      report.correlation());
}

std::vector<std::string> quality_lines(const Recording& fast, const FusedForces& fused,
                                       const Recording& exact) {
  std::vector<std::string> lines;
  if (exact.rows() != fast.rows())
    fail_input(exact.name, fmt::format("it has {} rows, not {}", exact.rows(), fast.rows()),
               "give the exact forces of the same motion");
  double squares = 0;
  for (const Vec3& f : exact.f) squares += f.squaredNorm();
  const double force = std::sqrt(squares / (3 * static_cast<double>(exact.rows())));
  const auto line = [&](const char* name, const std::vector<Vec3>& forces) {
    const ForceQuality q = force_quality(fast, forces, exact.f);
    lines.push_back(
        fmt::format("  {:<18} error {:8.4f} N = {:6.2f} % of the force, largest step {:.4f} N in a "
                    "millisecond",
                    name, q.rms, 100 * q.rms / force, q.largest_step));
  };
  line("fused", fused.force);
  line("fast alone", fast.f);
  line("slow held", fused.held);
  line("slow extrapolated", fused.extrapolated);
  line("exact", exact.f);
  return lines;
}

}  // namespace hapsim
