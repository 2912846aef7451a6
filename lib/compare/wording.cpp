#include "compare/wording.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compare/gain_sentences.h"

namespace hapsim {
namespace {

constexpr double kAlike = 1.15;  // two typical errors that far apart count as one

bool points_explained(const Comparison& c) {
  return !c.markers || markers_explained(*c.markers);
}

}  // namespace

std::string newtons(double force) {
  return fmt::format("{:.3g} N", force);
}

std::string percent_of(double part, double whole) {
  return whole > 0 ? fmt::format("{:.2g} %", 100 * part / whole) : "-";
}

std::string times_noise(const Comparison& c) {
  return c.noise.value > 0 ? fmt::format("{:.2g}", c.size.rmse / c.noise.value) : "?";
}

bool within_doubt(const Comparison& c) {
  return c.size.rmse <= kAlike * std::hypot(c.noise.value, c.mesh) && torques_explained(c.torque) &&
         points_explained(c);
}

bool only_noise_left(const Comparison& c) {
  return c.observations.empty() && c.size.rmse <= kAlike * c.noise.value &&
         torques_explained(c.torque) && points_explained(c);
}

std::string verdict_line(const Comparison& c) {
  if (only_noise_left(c))
    return fmt::format("Nothing is left but sensor noise: typical error {}, noise {}.",
                       newtons(c.size.rmse), newtons(c.noise.value));
  if (within_doubt(c))
    return fmt::format(
        "The model is as good as sensor and meshes let it be: typical error {}, noise {}.",
        newtons(c.size.rmse), newtons(c.noise.value));
  if (!torques_explained(c.torque) && c.size.rmse <= kAlike * std::hypot(c.noise.value, c.mesh))
    return fmt::format(
        "The model has the forces (typical error {}), but misses the torques by {:.3g} N m, {:.2g} "
        "times their noise.",
        newtons(c.size.rmse), c.torque.error.rms, c.torque.error.rms / c.torque.error.noise);
  if (!points_explained(c) && c.size.rmse <= kAlike * std::hypot(c.noise.value, c.mesh))
    return fmt::format(
        "The model has the forces (typical error {}), but misses the marked points by {:.3g} mm, "
        "{:.2g} times their noise.",
        newtons(c.size.rmse), 1e3 * c.markers->rms, c.markers->rms / c.markers->noise);
  std::string text =
      fmt::format("The model misses the measurement by typically {}, {} of the force",
                  newtons(c.size.rmse), percent_of(c.size.rmse, c.size.force_rms));
  if (c.noise.value > 0) text += fmt::format(" and {} times the sensor noise", times_noise(c));
  return text + ".";
}

Summary comparison_summary(const Comparison& c, const Recording& measured,
                           const std::vector<SimulatedVersion>& versions) {
  Summary s;
  const bool noise = only_noise_left(c), even = c.observations.empty(), doubt = within_doubt(c);
  s.mark = noise || (even && doubt) ? Summary::Mark::kGood
           : even || doubt          ? Summary::Mark::kOpen
                                    : Summary::Mark::kBad;
  s.verdict =
      measured.name +
      (noise   ? ": nothing is left but sensor noise"
       : doubt ? ": as good as sensor and meshes let it be"
       : !torques_explained(c.torque) && c.size.rmse <= kAlike * std::hypot(c.noise.value, c.mesh)
           ? ": the model has the forces and misses the torques"
       : !points_explained(c) && c.size.rmse <= kAlike * std::hypot(c.noise.value, c.mesh)
           ? ": the model has the forces and misses the marked points"
       : even ? ": more is left than sensor noise"
              : ": the model misses the measurement");
  if (doubt && !even) s.verdict += ", but for a trace";
  s.size = fmt::format("error {} = {} x noise", newtons(c.size.rmse), times_noise(c));
  s.items.push_back(
      {"ERROR",
       "",
       "",
       {fmt::format(
            "{} of the force's rms, {} of its peak {}; x {:.3g}, y {:.3g}, z {:.3g} N over {} rows",
            percent_of(c.size.rmse, c.size.force_rms), percent_of(c.size.rmse, c.size.force_peak),
            newtons(c.size.force_peak), c.size.rmse_axis[0], c.size.rmse_axis[1],
            c.size.rmse_axis[2], measured.rows()),
        fmt::format("sensor noise {} ({})", newtons(c.noise.value), c.noise.origin)}});
  if (versions.size() > 1)
    for (const SimulatedVersion& v : versions)
      s.items[0].facts.push_back(
          fmt::format("{}: {}", v.name, newtons(error_size(measured.f, v.recording.f).rmse)));
  if (std::vector<std::string> facts = torque_facts(c.torque); !facts.empty())
    s.items.push_back({"TORQUE", "", "", std::move(facts)});
  if (c.markers) s.items.push_back({"MARKERS", "", "", marker_facts(*c.markers)});
  SummaryItem depends{"DEPENDS", "", "", {}};
  for (const Observation& o : c.observations) depends.facts.push_back(o.sentence);
  if (depends.facts.empty())
    depends.facts.push_back("on nothing that was looked at: no structure beyond noise");
  s.items.push_back(std::move(depends));
  const std::vector<int> worst = c.worst_positions();
  SummaryItem places{"WORST", "", "", {}};
  for (std::size_t i = 0; i < std::min<std::size_t>(3, worst.size()) && worst.size() > 1; ++i) {
    const BinError& e = c.by_position().errors[static_cast<std::size_t>(worst[i])];
    std::string fact = c.by_position().grouping.bins[static_cast<std::size_t>(worst[i])].label +
                       ": " + newtons(e.rmse);
    if (!right_on_the_whole(e)) fact += ", " + stiffness_words(e);
    places.facts.push_back(std::move(fact));
  }
  if (!places.facts.empty() && !noise) s.items.push_back(std::move(places));
  return s;
}

}  // namespace hapsim
