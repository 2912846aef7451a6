#include "compare/report_views.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "base/median.h"
#include "contact/element_groups.h"
#include "contact/feature_zone.h"
#include "effects/place_field.h"
#include "experiment/forces.h"
#include "experiment/learned_curves.h"
#include "experiment/nearest_region.h"
#include "io/number.h"
#include "mesh/signed_distance.h"
#include "model/model_edit.h"

namespace hapsim {
namespace {

void count_flags(const Recording& r, const std::string& name,
                 const std::vector<std::pair<int, std::string>>& bits, ReportTable& table) {
  const auto column = std::find(r.extra_header.begin(), r.extra_header.end(), name);
  if (column == r.extra_header.end()) return;
  const auto& cells = r.extra[static_cast<std::size_t>(column - r.extra_header.begin())];
  std::vector<std::size_t> rows(bits.size(), 0), first(bits.size(), 0);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    double value = 0;
    if (!parse_number(cells[i], value) || !(std::abs(value) < 1e9)) continue;
    for (std::size_t b = 0; b < bits.size(); ++b)
      if ((std::lround(value) & bits[b].first) != 0 && rows[b]++ == 0) first[b] = i;
  }
  for (std::size_t b = 0; b < bits.size(); ++b) {
    if (rows[b] == 0) continue;
    const double share = static_cast<double>(rows[b]) / static_cast<double>(cells.size());
    table.rows.push_back({fmt::format("{} {}", name, bits[b].first), bits[b].second,
                          fmt::format("line {}", r.line[first[b]]), std::to_string(rows[b])});
    table.bar.push_back(share);
  }
}

// Of the points in a box where the modulus is farthest from that of most; 0 is no point.
Vec3 middle_of_strangest(const Eigen::AlignedBox3d& box,
                         const std::function<double(const Vec3&)>& modulus_at) {
  constexpr int kSteps = 24;
  std::map<double, std::pair<Vec3, int>> sum;  // by modulus
  for (int i = 0; i < kSteps; ++i)
    for (int j = 0; j < kSteps; ++j)
      for (int k = 0; k < kSteps; ++k) {
        const Vec3 share = (Vec3(i, j, k).array() + 0.5) / kSteps;
        const Vec3 p = box.min() + share.cwiseProduct(box.sizes());
        const double modulus = modulus_at(p);
        if (!(modulus > 0)) continue;
        auto& [points, count] = sum.try_emplace(modulus, Vec3::Zero(), 0).first->second;
        points += p;
        ++count;
      }
  if (sum.empty()) return box.center();
  const double most = std::max_element(sum.begin(), sum.end(), [](const auto& a, const auto& b) {
                        return a.second.second < b.second.second;
                      })->first;
  const auto& [points, count] =
      std::max_element(sum.begin(), sum.end(), [&](const auto& a, const auto& b) {
        return std::abs(std::log(a.first / most)) < std::abs(std::log(b.first / most));
      })->second;
  return points / count;
}

}  // namespace

void add_learned_curves(const Model& model, Report& report) {
  for (const LearnedCurveBand& c : learned_curves(model)) {
    const bool length = c.x_unit == "m";
    ReportCurve curve{
        .title = fmt::format("Learned: {}{} over {} ({})", c.y_name,
                             c.name.empty() ? "" : " along " + c.name, c.x_name, c.effect),
        .note =
            "The curve that was learned and its 95 % band, of the values at its knots, taken "
            "for independent.",
        .x_label = fmt::format("{} [{}]", c.x_name, length ? "mm" : c.x_unit),
        .y_label = c.y_unit == "1" ? c.y_name : fmt::format("{} [{}]", c.y_name, c.y_unit)};
    for (std::size_t i = 0; i < c.x.size(); ++i) {
      curve.x.push_back(length ? 1e3 * c.x[i] : c.x[i]);
      curve.middle.push_back(c.y[i]);
      curve.low.push_back(std::isnan(c.low[i]) ? c.y[i] : c.low[i]);
      curve.high.push_back(std::isnan(c.high[i]) ? c.y[i] : c.high[i]);
    }
    report.learned.push_back(std::move(curve));
  }
}

void add_learned_places(const Model& model, Report& report) {
  constexpr int kSteps = 40;
  constexpr double kLeast = 0.1, kMost = 1.5, kTail = 0.05;  // of the depth; of the places
  for (const EffectInstance& instance : effect_instances(model, false)) {
    if (!instance.effect->card().is_field) continue;
    const PlaceField field(instance.values);
    if (field.place.size() < 2) continue;
    ReportCurve curve{.title = fmt::format("Learned at {} places: how the force goes with depth",
                                           field.place.size()),
                      .note =
                          "The force over that of the model without what was learned: the middle "
                          "of the places, and the band that nine in ten of them lie in.",
                      .x_label = "depth [mm]",
                      .y_label = "times the model's force"};
    for (int k = 0; k <= kSteps; ++k) {
      const double depth = field.depth * (kLeast + (kMost - kLeast) * k / kSteps);
      std::vector<double> factor;
      for (const Vec3& p : field.place) {
        const std::array<double, 2> at = field.at(p);
        factor.push_back(std::exp(at[0] + at[1] * field.log_depth(depth)[0]));
      }
      curve.x.push_back(1e3 * depth);
      curve.middle.push_back(quantile(factor, 0.5));
      curve.low.push_back(quantile(factor, kTail));
      curve.high.push_back(quantile(factor, 1 - kTail));
    }
    report.learned.push_back(std::move(curve));
  }
}

void add_slices(const Surface& surface, const Model& model, const BodyRegions* labels,
                Report& report) {
  constexpr int kCells = 64;  // along the longest side
  const MaterialSpec material = material_of(model);
  std::vector<std::pair<LevelSet, double>> zones;  // and the factor inside
  if (surface.faces.empty()) return;
  const auto skin = std::make_shared<const SurfaceTree>(surface);
  for (const FeatureSpec& f : material.features)
    if (is_zone(f.feature.kind))
      zones.emplace_back(zone_level(f.feature, skin), f.feature.value.back());
  if (material.modulus.size() < 2 && zones.empty()) return;
  std::vector<BodyFeature> features;
  for (const FeatureSpec& f : material.features) features.push_back(f.feature);
  const std::vector<BodyRegions::Growth> growths = growths_of(features);
  const auto modulus_at = [&](const Vec3& p) {
    const int region = labels != nullptr ? labels->at(p, growths) : region_at(material, p);
    double modulus = material.modulus[static_cast<std::size_t>(region)];
    for (const auto& [level, factor] : zones)
      if (level(p).value < 0) modulus *= factor;
    return modulus;
  };
  Eigen::AlignedBox3d box;
  for (const Vec3& p : surface.vertices) box.extend(p);
  const Vec3 size = box.sizes();
  const SignedDistance inside(surface);
  const Vec3 middle = middle_of_strangest(
      box, [&](const Vec3& p) { return inside.at(p).distance < 0 ? modulus_at(p) : 0; });
  const double cell = size.maxCoeff() / kCells;
  constexpr const char* kAxis[] = {"x", "y", "z"};
  for (int across = 2; across >= 0; --across) {
    // Right and up: x and y seen from above, x or y and z from the side.
    const int right = across == 0 ? 1 : 0, up = across == 2 ? 1 : 2;
    ReportSlice slice{.title = fmt::format("{} = {:.1f} mm", kAxis[across], 1e3 * middle[across]),
                      .right = fmt::format("{} [mm]", kAxis[right]),
                      .up = fmt::format("{} [mm]", kAxis[up])};
    slice.cell = cell;
    slice.left = box.min()[right];
    slice.bottom = box.min()[up];
    slice.columns = static_cast<int>(std::ceil(size[right] / cell));
    const int rows = static_cast<int>(std::ceil(size[up] / cell));
    for (int row = 0; row < rows; ++row)
      for (int column = 0; column < slice.columns; ++column) {
        Vec3 p = middle;
        p[right] = slice.left + (column + 0.5) * cell;
        p[up] = slice.bottom + (row + 0.5) * cell;
        slice.modulus.push_back(inside.at(p).distance < 0 ? modulus_at(p) : 0);
      }
    report.slices.push_back(std::move(slice));
  }
}

void add_chances(Report& report) {
  if (report.diagnoses.empty()) return;
  ReportTable table{"How sure the diagnosis is: the chance that noise alone looks so",
                    {"effect", "verdict", "chance of a false alarm"},
                    {},
                    {}};
  struct Row {
    double p;
    std::vector<std::string> cells;
  };
  std::vector<Row> rows;
  for (const DiagnosisRow& row : report.diagnoses.back().rows) {
    if (!std::isfinite(row.p_value) || row.effect == "model") continue;
    rows.push_back({std::max(row.p_value, 1e-4),
                    {row.effect, row.verdict,
                     row.p_value < 1e-3 ? "below 0.001" : fmt::format("{:.2g}", row.p_value)}});
  }
  std::stable_sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) { return a.p < b.p; });
  for (Row& row : rows) {
    table.bar.push_back(std::log10(1 / row.p) / 4);
    table.rows.push_back(std::move(row.cells));
  }
  if (!table.rows.empty()) report.tables.push_back(std::move(table));
}

void add_flags(const Recording& recording, const FlagMeanings& meanings, Report& report) {
  ReportTable table{
      "What the live force said of itself", {"flag", "the force is", "first in", "rows"}, {}, {}};
  for (const auto& [column, bits] : meanings) count_flags(recording, column, bits, table);
  if (!table.rows.empty()) report.tables.push_back(std::move(table));
}

}  // namespace hapsim
