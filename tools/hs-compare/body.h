// The body and the model as a comparison shows them: layers of colour, parameters, a coloured PLY.
#pragma once

#include "compare/error_map.h"
#include "experiment/forces.h"
#include "experiment/nearest_region.h"
#include "formats/ply.h"
#include "hs-compare/report.h"
#include "report/palette.h"

namespace hapsim {

inline double round_up(double value) {
  const double unit = std::pow(10, std::floor(std::log10(value)));
  for (const double step : {1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0})
    if (value <= step * unit * (1 + 1e-9)) return step * unit;
  return value;
}

// The end of the errors' scale [N]: an error as small as the noise must not look alarming.
inline double top_error(const Comparison& c) {
  double top = 2 * c.noise.value;
  for (const BinError& e : c.by_position().errors) top = std::max(top, e.rmse);
  return round_up(top > 0 ? top : 1);
}

inline BodyLayer error_layer(const Comparison& c, const ErrorMap& map) {
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

// How much stiffer the body is than the model, as its presses say.
inline BodyLayer stiffness_layer(const Comparison& c, const ErrorMap& map) {
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
inline BodyLayer region_layer(const Comparison& c, const ErrorMap& map, const Model& model) {
  const MaterialSpec material = material_of(model);
  BodyLayer layer{.name = "regions",
                  .title = "region",
                  .note = "Regions of the model, seen from above.",
                  .scale = BodyLayer::Scale::kKinds,
                  .top = static_cast<double>(material.modulus.size()) - 1,
                  .local = false};
  for (const Vec3& v : map.surface.vertices) layer.value.push_back(region_at(material, v));
  for (const Vec3& p : c.facts.positions) {
    const int region = region_at(material, p);
    layer.at_position.push_back(region);
    layer.at_position_text.push_back(fmt::format(
        "region {}, E {:.3g} Pa", region, material.modulus[static_cast<std::size_t>(region)]));
  }
  return layer;
}

// What the body's surface is coloured by; a map without a surface: only the positions.
inline void add_body(const Comparison& c, const ErrorMap& map, const Model* model, Report& report) {
  report.body.vertices = map.surface.vertices;
  report.body.faces = map.surface.faces;
  report.body.distance = map.distance;
  report.body.reach = map.reach;
  report.body.positions = c.facts.positions;
  report.body.layers = {error_layer(c, map)};
  if (map.surface.faces.empty()) return;
  report.body.layers.push_back(stiffness_layer(c, map));
  if (model != nullptr && material_of(*model).modulus.size() > 1)
    report.body.layers.push_back(region_layer(c, map, *model));
}

inline void add_parameters(const Model& model, Report& report) {
  ReportTable& t = report.parameters;
  t.caption =
      "± is one standard error; in 95 of 100 recordings the interval holds the value that "
      "this kind of model would have.";
  t.columns = {"effect", "region", "parameter", "value", "±", "95 % interval", "unit", "state"};
  constexpr std::size_t kMost = 60;
  for (const Parameter& p : model.parameters) {
    if (t.rows.size() == kMost) {
      t.caption += fmt::format(" The first {} of {}.", kMost, model.parameters.size());
      break;
    }
    const bool known = p.state != ParameterState::kFixed && std::isfinite(p.std_error);
    t.rows.push_back({p.effect, std::to_string(p.region), p.name, fmt::format("{:.4g}", p.value),
                      known ? fmt::format("{:.2g}", p.std_error) : "",
                      known ? fmt::format("{:.4g} to {:.4g}", p.value - 1.96 * p.std_error,
                                          p.value + 1.96 * p.std_error)
                            : "",
                      p.unit == "1" ? "" : p.unit,
                      p.state == ParameterState::kFree      ? "fitted"
                      : p.state == ParameterState::kDerived ? "derived"
                                                            : "fixed"});
  }
}

inline PlyFile coloured_ply(const ErrorMap& map, double top) {
  const auto column = [](const char* name, PlyType type) {
    PlyProperty property;
    property.name = name;
    property.type = type;
    return property;
  };
  PlyElement vertex{"vertex", map.surface.vertices.size(), {}};
  for (const char* name : {"x", "y", "z"})
    vertex.properties.push_back(column(name, PlyType::kFloat64));
  for (const char* name : {"red", "green", "blue"})
    vertex.properties.push_back(column(name, PlyType::kUint8));
  vertex.properties.push_back(column("error", PlyType::kFloat32));
  for (std::size_t i = 0; i < vertex.count; ++i) {
    const bool known = map.distance[i] <= map.reach;
    const Rgb colour = known ? error_colour(map.error[i] / top) : kUnknownColour;
    for (std::size_t k = 0; k < 3; ++k) {
      vertex.properties[k].values.push_back(map.surface.vertices[i][static_cast<Eigen::Index>(k)]);
      vertex.properties[3 + k].values.push_back(colour[k]);
    }
    vertex.properties[6].values.push_back(known ? map.error[i]
                                                : std::numeric_limits<double>::quiet_NaN());
  }
  PlyElement face{"face", map.surface.faces.size(), {column("vertex_indices", PlyType::kInt32)}};
  PlyProperty& corners = face.properties[0];
  corners.is_list = true;
  corners.offset.push_back(0);
  for (const Triangle& f : map.surface.faces) {
    corners.values.insert(corners.values.end(), f.begin(), f.end());
    corners.offset.push_back(corners.values.size());
  }
  PlyFile file;
  file.comments.push_back(
      fmt::format("error: rmse of nearby presses [N], colours from 0 to {:.4g}", top));
  file.elements = {vertex, face};
  return file;
}

}  // namespace hapsim
