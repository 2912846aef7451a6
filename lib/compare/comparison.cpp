#include "compare/comparison.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace hapsim {
namespace {

using Json = nlohmann::ordered_json;

// NaN (no bound, no gain) has no number in JSON.
Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}
Json vector(const Vec3& v) {
  return {v[0], v[1], v[2]};
}

Json bins_json(const Breakdown& breakdown) {
  Json bins = Json::array();
  for (std::size_t b = 0; b < breakdown.errors.size(); ++b) {
    const Grouping::Range& range = breakdown.grouping.bins[b];
    const BinError& e = breakdown.errors[b];
    bins.push_back({{"label", range.label},
                    {"lower", number(range.lower)},
                    {"upper", number(range.upper)},
                    {"rows", e.rows},
                    {"presses", e.presses},
                    {"rmse", e.rmse},
                    {"gain", number(e.gain)},
                    {"gain_error", number(e.gain_error)},
                    {"bias", vector(e.bias)}});
  }
  return bins;
}

}  // namespace

std::vector<int> Comparison::worst_positions() const {
  std::vector<int> order(by_position().errors.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return by_position().errors[a].rmse > by_position().errors[b].rmse;
  });
  return order;
}

Comparison compare(const Recording& measured, const Recording& simulated) {
  check_match(measured, simulated);
  Comparison c;
  c.size = error_size(measured.f, simulated.f);
  c.noise = noise_level(measured);
  c.mesh =
      c.size.force_rms * simulated.metadata.number("mesh_uncertainty", simulated.name).value_or(0);
  c.facts = row_facts(measured);
  c.breakdowns = break_down(c.facts, measured.f, simulated.f, c.noise.value);
  c.observations = find_structure(c.facts, measured.f, simulated.f, c.noise.value);
  c.torque = compare_torques(measured, simulated);
  return c;
}

Recording residuals_of(const Comparison& c, const Recording& measured, const Recording& simulated) {
  Recording residuals = with_residuals(measured, simulated.f);
  if (!c.torque.compared()) return residuals;
  return with_torque_residuals(residuals, c.torque.measured, c.torque.simulated);
}

std::string comparison_json(const Comparison& c, const std::string& measured_name,
                            const std::string& simulated_name) {
  Json observations = Json::array();
  for (const Observation& f : c.observations)
    observations.push_back(
        {{"kind", f.kind}, {"sentence", f.sentence}, {"p_value", f.p_value}, {"share", f.share}});
  Json breakdowns = Json::object();
  for (const Breakdown& b : c.breakdowns) breakdowns[b.grouping.name] = bins_json(b);
  Json json = {{"measured", measured_name},
               {"simulated", simulated_name},
               {"rows", c.facts.press.size()},
               {"presses", c.facts.press_ids.size()},
               {"positions", c.facts.positions.size()},
               {"rmse", c.size.rmse},
               {"rmse_axes", vector(c.size.rmse_axis)},
               {"force_rms", c.size.force_rms},
               {"force_peak", c.size.force_peak},
               {"noise", c.noise.value},
               {"noise_source", c.noise.estimated ? "measured" : "force_noise"},
               {"observations", observations},
               {"breakdowns", breakdowns}};
  if (c.torque.compared()) {
    json["torque_rmse"] = number(c.torque.error.rms);
    json["torque_rms"] = number(c.torque.error.size);
    json["torque_noise"] = number(c.torque.error.noise);
  }
  if (c.markers) {
    json["marker_rmse"] = number(c.markers->rms);
    json["marker_rms"] = number(c.markers->size);
    json["marker_noise"] = number(c.markers->noise);
    Json points = Json::array();
    for (const MarkerComparison::OfPoint& p : c.markers->points)
      points.push_back({{"point", p.name}, {"rows", p.rows}, {"rmse", p.rms}});
    json["marker_points"] = points;
  }
  // A file name need not be UTF-8; what is not becomes a replacement character.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace hapsim
