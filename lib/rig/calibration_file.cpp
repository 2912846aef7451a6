#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>

#include "base/error.h"
#include "base/nearest.h"
#include "io/csv.h"
#include "io/number.h"
#include "rig/calibration.h"

namespace hapsim {
namespace {

const std::vector<std::string> kColumns{"parameter", "value", "unit", "std_error",
                                        "lower",     "upper", "state"};
// Where each quantity begins, and the end.
constexpr CalibratedNumber kFirst[] = {kRotation,    kCrosstalk, kMass, kGravity,
                                       kOffset,      kDrift,     kCom,  kTorqueOffset,
                                       kTorqueDrift, kWeightAt,  kArm,  kCalibratedNumbers};

std::size_t number_of(const std::string& parameter, const std::string& where) {
  std::vector<std::string> all;
  for (const CalibratedName& name : calibrated_names()) {
    if (parameter == name.name) return all.size();
    all.emplace_back(name.name);
  }
  const std::string near = nearest(parameter, all);
  fail_input(where, "a calibration has no parameter " + shown(parameter),
             near.empty() ? "write it by hs-calibrate" : "did you mean '" + near + "'?");
}

// A vector or a matrix has all its numbers or none.
void require_whole(const Calibration& c) {
  for (std::size_t q = 0; q + 1 < std::size(kFirst); ++q) {
    std::size_t there = 0;
    for (int k = kFirst[q]; k < kFirst[q + 1]; ++k)
      there += !c.numbers[static_cast<std::size_t>(k)].state.empty();
    if (there == 0 || there == static_cast<std::size_t>(kFirst[q + 1] - kFirst[q])) continue;
    for (int k = kFirst[q]; k < kFirst[q + 1]; ++k)
      if (c.numbers[static_cast<std::size_t>(k)].state.empty())
        fail_input(c.name,
                   fmt::format("{} is missing beside {}",
                               calibrated_names()[static_cast<std::size_t>(k)].name,
                               calibrated_names()[static_cast<std::size_t>(kFirst[q])].name),
                   "a vector or matrix has all its numbers");
  }
}

void check_meaning(const Calibration& c) {
  require_whole(c);
  if (!c.has_sensor() && !c.has(kArm))
    fail_input(c.name, "it calibrates neither a sensor nor an arm",
               "it needs rows rotation_x, ... or arm_xx, ...");
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(c.crosstalk());
  if (!(svd.singularValues()[2] > 1e-3 * svd.singularValues()[0]))
    fail_input(c.name, "its cross-talk cannot be undone: an axis shows nothing of its own force",
               "see crosstalk_xx to crosstalk_yz");
  if (c.has(kMass) && c.numbers[kMass].value < 0)
    fail_input(c.name, "mass is " + format_number(c.numbers[kMass].value) + " kg",
               "it cannot be negative");
  if (c.has(kDrift) && !c.metadata.find("temp_ref"))
    fail_input(c.name, "it has a drift and no temperature that counts from",
               "add a line '# temp_ref: 20' (degC) at the top");
  c.temp_ref();
}

}  // namespace

Calibration read_calibration(Input& input) {
  const CsvTable table = read_csv(input);
  const std::vector<double> values = table.numbers("value");
  if (table.find("parameter") < 0)
    fail_missing_column(table.name, "parameter", table.header, kColumns);
  const auto cell = [&table](const char* column, std::size_t row) -> std::string {
    const int c = table.find(column);
    return c < 0 ? "" : table.columns[static_cast<std::size_t>(c)][row];
  };
  Calibration calibration;
  calibration.name = table.name;
  calibration.metadata = table.metadata;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const std::string where = fmt::format("{}:{}", table.name, table.line[row]);
    const std::string parameter = cell("parameter", row), unit = cell("unit", row);
    const std::size_t k = number_of(parameter, where);
    CalibratedValue& number = calibration.numbers[k];
    if (!number.state.empty()) fail_input(where, parameter + " stands here again", "remove one");
    if (!unit.empty() && unit != calibrated_names()[k].unit)
      fail_input(where, fmt::format("{} is in {}", parameter, shown(unit)),
                 fmt::format("give it in {}", calibrated_names()[k].unit));
    number.value = values[row];
    number.state = cell("state", row);
    if (number.state.empty()) number.state = "given";
    for (const auto& [column, place] : {std::pair{"std_error", &number.std_error},
                                        {"lower", &number.lower},
                                        {"upper", &number.upper}}) {
      const std::string text = cell(column, row);
      if (!text.empty() && !parse_number(text, *place))
        fail_input(where, fmt::format("{} is {}", column, shown(text)), "leave it empty");
    }
  }
  check_meaning(calibration);
  return calibration;
}

void write_calibration(std::ostream& out, const Calibration& calibration) {
  CsvWriter writer(out, calibration.metadata, kColumns);
  const auto text = [](double value) {
    return std::isfinite(value) ? fmt::format("{:.6g}", value) : std::string();
  };
  for (std::size_t k = 0; k < calibration.numbers.size(); ++k) {
    const CalibratedValue& n = calibration.numbers[k];
    if (n.state.empty()) continue;
    writer.row({calibrated_names()[k].name, fmt::format("{:.9g}", n.value),
                calibrated_names()[k].unit, text(n.std_error), text(n.lower), text(n.upper),
                n.state});
  }
}

}  // namespace hapsim
