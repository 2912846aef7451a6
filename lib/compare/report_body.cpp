#include "compare/report_body.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compare/wording.h"
#include "contact/element_groups.h"
#include "experiment/forces.h"
#include "experiment/nearest_region.h"

namespace hapsim {
namespace {

// How much stiffer the body is than the model, as its presses say.
BodyLayer stiffness_layer(const Comparison& c, const ErrorMap& map) {
  BodyLayer layer{.name = "stiffness",
                  .title = "stiffer by [%]",
                  .note =
                      "How much stiffer than the model the body is near the pressed positions: "
                      "measured over simulated force, less one.",
                  .scale = BodyLayer::Scale::kSigned};
  double top = 0;
  for (const BinError& e : c.by_position().errors) {
    const bool known = std::isfinite(e.gain);
    layer.at_position.push_back(known ? 100 * (e.gain - 1) : 0);
    layer.at_position_text.push_back(known
                                         ? fmt::format("{:+.1f} ± {:.1f} % stiffer than the model",
                                                       100 * (e.gain - 1), 100 * e.gain_error)
                                         : "stiffness not known");
    top = std::max(top, std::abs(layer.at_position.back()));
  }
  layer.top = round_up(std::clamp(top, 1.0, 200.0));
  layer.value = map_error(map.surface, c.facts.positions, layer.at_position, map.reach).error;
  return layer;
}

// The model's regions in plan view, where it has several.
BodyLayer region_layer(const Comparison& c, const ErrorMap& map, const Model& model,
                       const BodyRegions* labels) {
  const MaterialSpec material = material_of(model);
  std::vector<BodyFeature> features;
  for (const FeatureSpec& f : material.features) features.push_back(f.feature);
  const std::vector<BodyRegions::Growth> growths = growths_of(features);
  const auto region_of = [&](const Vec3& p) {
    return labels != nullptr ? labels->at(p, growths) : region_at(material, p);
  };
  BodyLayer layer{.name = "regions",
                  .title = "region",
                  .note = labels != nullptr ? "Regions of the model where they reach the surface."
                                            : "Regions of the model, seen from above.",
                  .scale = BodyLayer::Scale::kKinds,
                  .top = static_cast<double>(material.modulus.size()) - 1,
                  .local = false};
  for (const Vec3& v : map.surface.vertices) layer.value.push_back(region_of(v));
  for (const Vec3& p : c.facts.positions) {
    const int region = region_of(p);
    layer.at_position.push_back(region);
    layer.at_position_text.push_back(fmt::format(
        "region {}, E {:.3g} Pa", region, material.modulus[static_cast<std::size_t>(region)]));
  }
  return layer;
}

}  // namespace

double round_up(double value) {
  const double unit = std::pow(10, std::floor(std::log10(value)));
  for (const double step : {1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0})
    if (value <= step * unit * (1 + 1e-9)) return step * unit;
  return value;
}

double top_error(const Comparison& c) {
  double top = 2 * c.noise.value;
  for (const BinError& e : c.by_position().errors) top = std::max(top, e.rmse);
  return round_up(top > 0 ? top : 1);
}

BodyLayer error_layer(const Comparison& c, const ErrorMap& map) {
  BodyLayer layer{.name = "error",
                  .title = "error [N]",
                  .note =
                      "Typical error (rmse) of the presses near by; grey where nothing was "
                      "pressed near.",
                  .mark = c.noise.value,
                  .mark_name = "noise",
                  .value = map.error};
  for (const BinError& e : c.by_position().errors) {
    layer.at_position.push_back(e.rmse);
    layer.at_position_text.push_back("error " + newtons(e.rmse));
  }
  layer.top = top_error(c);
  return layer;
}

void add_body(const Comparison& c, const ErrorMap& map, const Model* model,
              const BodyRegions* labels, Report& report) {
  report.body.vertices = map.surface.vertices;
  report.body.faces = map.surface.faces;
  report.body.distance = map.distance;
  report.body.reach = map.reach;
  report.body.positions = c.facts.positions;
  report.body.layers = {error_layer(c, map)};
  if (map.surface.faces.empty()) return;
  report.body.layers.push_back(stiffness_layer(c, map));
  if (model != nullptr && material_of(*model).modulus.size() > 1)
    report.body.layers.push_back(region_layer(c, map, *model, labels));
}

void add_body_before(const Comparison& before, const ErrorMap& map, Report& report) {
  if (map.surface.faces.empty() || before.facts.positions.size() != report.body.positions.size())
    return;
  ErrorMap earlier = map;
  std::vector<double> error;
  for (const BinError& e : before.by_position().errors) error.push_back(e.rmse);
  // The same surface and reach, so that vertices are the same.
  earlier.error = map_error(map.surface, before.facts.positions, error, map.reach).error;
  if (earlier.error.size() != map.error.size()) return;
  BodyLayer layer = error_layer(before, earlier);
  layer.name = "error before";
  layer.note = "Typical error of the first version's presses near by, on the same scale.";
  BodyLayer& now = report.body.layers.front();
  now.top = layer.top = std::max(now.top, layer.top);
  report.body.layers.insert(report.body.layers.begin() + 1, layer);
}

}  // namespace hapsim
