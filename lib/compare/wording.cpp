#include "compare/wording.h"

#include <fmt/format.h>

#include <algorithm>

#include "compare/gain_sentences.h"

namespace hapsim {

std::string newtons(double force) {
  return fmt::format("{:.3g} N", force);
}

std::string percent_of(double part, double whole) {
  return whole > 0 ? fmt::format("{:.2g} %", 100 * part / whole) : "-";
}

std::string times_noise(const Comparison& c) {
  return c.noise.value > 0 ? fmt::format("{:.2g}", c.size.rmse / c.noise.value) : "?";
}

bool only_noise_left(const Comparison& c) {
  return c.observations.empty() && c.size.rmse <= 1.15 * c.noise.value;
}

std::string verdict_line(const Comparison& c) {
  if (only_noise_left(c))
    return fmt::format("Nothing is left but sensor noise: typical error {}, noise {}.",
                       newtons(c.size.rmse), newtons(c.noise.value));
  std::string text =
      fmt::format("The model misses the measurement by typically {}, {} of the force",
                  newtons(c.size.rmse), percent_of(c.size.rmse, c.size.force_rms));
  if (c.noise.value > 0) text += fmt::format(" and {} times the sensor noise", times_noise(c));
  return text + ".";
}

std::vector<std::string> summary_lines(const Comparison& c, const Recording& measured,
                                       const std::vector<SimulatedVersion>& versions) {
  std::vector<std::string> lines{verdict_line(c)};
  const auto line = [&](const std::string& text) { lines.push_back(text); };
  line(fmt::format(
      "rmse {} over {} rows, measured components pooled (x {:.3g}, y {:.3g}, z {:.3g}); {} of the "
      "force's rms, {} of its peak {}",
      newtons(c.size.rmse), measured.rows(), c.size.rmse_axis[0], c.size.rmse_axis[1],
      c.size.rmse_axis[2], percent_of(c.size.rmse, c.size.force_rms),
      percent_of(c.size.rmse, c.size.force_peak), newtons(c.size.force_peak)));
  line(fmt::format("sensor noise {} ({}): the error is {} times that", newtons(c.noise.value),
                   c.noise.estimated ? "estimated from differences in time: there is no "
                                       "force_noise in the recording"
                                     : "force_noise of the recording",
                   times_noise(c)));
  if (versions.size() > 1)
    for (const SimulatedVersion& v : versions)
      line(fmt::format("  {}: rmse {}", v.name,
                       newtons(error_size(measured.f, v.recording.f).rmse)));
  for (const Observation& o : c.observations) line("  " + o.sentence);
  if (c.observations.empty())
    line("  no structure beyond noise: the error depends on nothing that was looked at");
  const std::vector<int> worst = c.worst_positions();
  for (std::size_t i = 0; i < std::min<std::size_t>(3, worst.size()) && worst.size() > 1; ++i) {
    const BinError& e = c.by_position().errors[static_cast<std::size_t>(worst[i])];
    line(fmt::format("  {} {}: rmse {}, {}", i == 0 ? "worst position" : "          then",
                     c.by_position().grouping.bins[static_cast<std::size_t>(worst[i])].label,
                     newtons(e.rmse), stiffness_words(e)));
  }
  return lines;
}

}  // namespace hapsim
