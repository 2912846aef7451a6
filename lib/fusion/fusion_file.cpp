#include "fusion/fusion_file.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "io/csv.h"

namespace hapsim {
namespace {

constexpr std::array<const char*, 3> kAxes{"x", "y", "z"};

double* share_named(CorrectionShares& shares, const std::string& name) {
  for (std::size_t c = 0; c < kWayBands; ++c)
    if (name == fmt::format("share{}", c)) return &shares.way[c];
  for (std::size_t c = 0; c < kAgeBands; ++c)
    if (name == fmt::format("age_share{}", c)) return &shares.age[c];
  return nullptr;
}

// What was taught, in the table: its scale and times, then the weights.
struct TaughtEntry {
  std::string name, axis, unit;
  double* value;
};
std::vector<TaughtEntry> taught_entries(TaughtCorrection& taught) {
  std::vector<TaughtEntry> entries;
  for (std::size_t a = 0; a < 3; ++a)
    entries.push_back({"taught_scale", kAxes[a], "m", &taught.scale[static_cast<int>(a)]});
  for (std::size_t a = 0; a < 3; ++a)
    entries.push_back({"taught_place", kAxes[a], "m", &taught.place[static_cast<int>(a)]});
  entries.push_back({"taught_reach", "", "m", &taught.reach});
  for (std::size_t m = 0; m < TaughtCorrection::kTimes; ++m)
    entries.push_back({fmt::format("taught_time{}", m + 1), "", "s", &taught.time[m]});
  for (std::size_t a = 0; a < 3; ++a)
    for (std::size_t k = 0; k < TaughtCorrection::kWeights; ++k)
      entries.push_back({fmt::format("taught{}", k + 1), kAxes[a], "N", &taught.weight[a][k]});
  return entries;
}

}  // namespace

const std::array<FusionEntry, 10>& fusion_entries() {
  static const std::array<FusionEntry, 10> table{{
      {"offset_walk", "N/s^0.5", &AxisFusion::offset_walk, 1e-9, 1e3},
      {"walk_rate", "m/s", &AxisFusion::walk_rate, 1e-3, 1e6},
      {"offset_time", "s", &AxisFusion::offset_time, 1e-3, 1e6},
      {"drift_walk", "N/s^1.5", &AxisFusion::drift_walk, 1e-9, 1e3},
      {"drift_time", "s", &AxisFusion::drift_time, 1e-3, 1e3},
      {"gain_walk", "1", &AxisFusion::gain_walk, 1e-9, 1e3},
      {"gain_spread", "1", &AxisFusion::gain_spread, 1e-6, 1e3},
      {"noise", "N", &AxisFusion::noise, 1e-9, 1e3},
      {"noise_rise", "N s/m", &AxisFusion::noise_rise, 1e-9, 1e3},
      {"force_scale", "N", &AxisFusion::force_scale, 1e-6, 1e6},
  }};
  return table;
}

FusionParameters read_fusion(Input& input) {
  const CsvTable csv = read_csv(input);
  FusionParameters parameters;
  const std::vector<TaughtEntry> taught = taught_entries(parameters.taught);
  const std::vector<double> value = csv.numbers("value");
  const int column = csv.find("parameter"), axes = csv.find("axis");
  for (const auto& [found, name] : {std::pair{column, "parameter"}, std::pair{axes, "axis"}})
    if (found < 0) fail_missing_column(csv.name, name, csv.header);
  for (std::size_t row = 0; row < csv.rows(); ++row) {
    const std::string& name = csv.columns[static_cast<std::size_t>(column)][row];
    const std::string& axis = csv.columns[static_cast<std::size_t>(axes)][row];
    const std::string where = csv.name + ":" + std::to_string(csv.line[row]);
    const auto bounded = [&](double lower, double upper) {
      if (value[row] < lower || value[row] > upper)
        fail_input(where, name + " = " + format_number(value[row]) + " is out of its bounds",
                   fmt::format("give {:g} to {:g}", lower, upper));
      return value[row];
    };
    if (double* share = share_named(parameters.share, name)) {
      *share = bounded(0, 1);
      continue;
    }
    if (name == "share_known") {
      parameters.share_known = bounded(0.1, 1e6);
      continue;
    }
    if (name == "blend") {
      parameters.blend = bounded(0, 10);
      continue;
    }
    const auto lesson = std::find_if(taught.begin(), taught.end(), [&](const TaughtEntry& e) {
      return e.name == name && e.axis == axis;
    });
    if (lesson != taught.end()) {
      *lesson->value = lesson->unit == "N"   ? bounded(-1e9, 1e9)
                       : lesson->unit == "s" ? bounded(1e-9, 1e6)
                                             : bounded(-1e3, 1e3);
      continue;
    }
    const auto found = std::find_if(fusion_entries().begin(), fusion_entries().end(),
                                    [&](const FusionEntry& e) { return name == e.name; });
    const auto a =
        static_cast<std::size_t>(std::find(kAxes.begin(), kAxes.end(), axis) - kAxes.begin());
    if (found == fusion_entries().end() || a == kAxes.size())
      fail_input(where, "parameter " + shown(name) + " of axis " + shown(axis) + " is not known",
                 "see hs-fuse(1)");
    parameters.axis[a].*(found->value) = bounded(found->lower, found->upper);
  }
  return parameters;
}

void write_fusion(std::ostream& out, const FusionParameters& parameters) {
  CsvWriter csv(out, {}, {"parameter", "axis", "value", "unit"});
  for (std::size_t a = 0; a < 3; ++a)
    for (const FusionEntry& e : fusion_entries())
      csv.row({e.name, kAxes[a], format_number(parameters.axis[a].*(e.value)), e.unit});
  csv.row({"blend", "", format_number(parameters.blend), "s"});
  for (std::size_t c = 0; c < kWayBands; ++c)
    csv.row({fmt::format("share{}", c), "", format_number(parameters.share.way[c]), "1"});
  for (std::size_t c = 0; c < kAgeBands; ++c)
    csv.row({fmt::format("age_share{}", c), "", format_number(parameters.share.age[c]), "1"});
  csv.row({"share_known", "", format_number(parameters.share_known), "1"});
  TaughtCorrection taught = parameters.taught;
  if (!taught.taught()) return;
  for (const TaughtEntry& e : taught_entries(taught))
    csv.row({e.name, e.axis, format_number(*e.value), e.unit});
}

}  // namespace hapsim
