#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "acfm/acfm.h"
#include "base/error.h"
#include "io/csv.h"

namespace hapsim {
namespace {

constexpr std::array<const char*, 3> kAxes{"t1", "t2", "n"};

// ks 0, k1 1, tau1 2, k2 3, ...; -1: no such name.
int slot_of(const std::string& name) {
  if (name == "ks") return 0;
  if (name == "s") return static_cast<int>(AcfmAxis::kStiffening);
  const bool time = name.rfind("tau", 0) == 0;
  double number = 0;
  if (name.empty() || (!time && name[0] != 'k') ||
      !parse_number(name.substr(time ? 3 : 1), number) || number != std::floor(number) ||
      number < 1 || number > AcfmAxis::kMostTerms)
    return -1;
  return 2 * static_cast<int>(number) - (time ? 0 : 1);
}

std::string name_of(std::size_t slot) {
  if (slot == 0) return "ks";
  if (slot == AcfmAxis::kStiffening) return "s";
  return (slot % 2 == 0 ? "tau" : "k") + std::to_string((slot + 1) / 2);
}

}  // namespace

bool is_acfm(const std::string& bytes) {
  Input input = Input::from_bytes(bytes, "model");
  std::string line;
  while (input.read_line(line))
    if (!line.empty() && line[0] != '#')
      return line.find("axis") != line.npos && line.find("parameter") != line.npos;
  return false;
}

Acfm read_acfm(Input& input) {
  const CsvTable csv = read_csv(input);
  Acfm model;
  model.metadata = csv.metadata;
  const auto position = csv.numbers("position"), value = csv.numbers("value");
  std::array<std::vector<double>, 6> place;
  const std::array<const char*, 6> names{"x", "y", "z", "nx", "ny", "nz"};
  for (std::size_t k = 0; k < 6; ++k) place[k] = csv.numbers(names[k]);
  const auto text = [&](const char* column) -> const std::vector<std::string>& {
    const int c = csv.find(column);
    if (c < 0) fail_missing_column(csv.name, column, csv.header);
    return csv.columns[static_cast<std::size_t>(c)];
  };
  const std::vector<std::string>&axis = text("axis"), &parameter = text("parameter");
  const int errors = csv.find("std_error"), states = csv.find("state");
  std::vector<double> known;  // numbers of the positions
  std::vector<std::array<std::array<char, AcfmAxis{}.value.size()>, 3>> given;
  for (std::size_t row = 0; row < csv.rows(); ++row) {
    const std::string where = csv.name + ":" + std::to_string(csv.line[row]);
    const auto found = std::find(known.begin(), known.end(), position[row]);
    const auto p = static_cast<std::size_t>(found - known.begin());
    const Vec3 point(place[0][row], place[1][row], place[2][row]);
    const Vec3 normal(place[3][row], place[4][row], place[5][row]);
    if (found == known.end()) {
      known.push_back(position[row]);
      given.emplace_back();
      model.positions.emplace_back();
      model.positions[p].point = point;
      if (std::abs(normal.norm() - 1) > 1e-3)
        fail_input(where, "the normal is not of unit length", "give its direction in nx, ny, nz");
      if (point.cwiseAbs().maxCoeff() > 10)
        fail_input(where, "the position is more than 10 m away", "give positions in metres");
      model.positions[p].normal = normal.normalized();
    } else if ((model.positions[p].point - point).norm() > 1e-9) {
      fail_input(where, "position " + format_number(position[row]) + " is at two places",
                 "number the positions");
    }
    const auto a =
        static_cast<std::size_t>(std::find(kAxes.begin(), kAxes.end(), axis[row]) - kAxes.begin());
    if (a == kAxes.size())
      fail_input(where, "axis " + shown(axis[row]) + " is not known", "write t1, t2 or n");
    const int slot = slot_of(parameter[row]);
    if (slot < 0)
      fail_input(where, "parameter " + shown(parameter[row]) + " is not known",
                 fmt::format("write ks, s, or k1, tau1 to k{0}, tau{0}", AcfmAxis::kMostTerms));
    const auto at = static_cast<std::size_t>(slot);
    if (given[p][a][at])
      fail_input(where, parameter[row] + " is given twice for this axis", "remove one of the rows");
    given[p][a][at] = 1;
    const bool stiffens = at == AcfmAxis::kStiffening, time = slot > 0 && slot % 2 == 0;
    if (!stiffens && (!(value[row] >= 0) || ((slot == 0 || time) && value[row] == 0)))
      fail_input(where, parameter[row] + " = " + format_number(value[row]) + " is not positive",
                 "springs and relaxation times are");
    AcfmAxis& to = model.positions[p].axis[a];
    to.value[at] = value[row];
    double error = 0;
    to.error[at] =
        errors >= 0 && parse_number(csv.columns[static_cast<std::size_t>(errors)][row], error)
            ? error
            : std::numeric_limits<double>::quiet_NaN();
    if (states >= 0 && csv.columns[static_cast<std::size_t>(states)][row] == "derived")
      to.derived = true;
    if (!stiffens) model.terms = std::max(model.terms, (slot + 1) / 2);
  }
  if (known.empty())
    fail_input(csv.name, "the model has no position", "identify it again: hs-identify --acfm");
  for (std::size_t p = 0; p < known.size(); ++p)
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t slot = 0; slot < static_cast<std::size_t>(1 + 2 * model.terms); ++slot)
        if (!given[p][a][slot])
          fail_input(csv.name,
                     fmt::format("position {} has no {} for axis {}", format_number(known[p]),
                                 name_of(slot), kAxes[a]),
                     "give every axis of every position the same parameters; k = 0 switches one "
                     "off");
  return model;
}

void write_acfm(std::ostream& out, const Acfm& model) {
  CsvWriter csv(out, model.metadata,
                {"position", "x", "y", "z", "nx", "ny", "nz", "axis", "parameter", "value", "unit",
                 "std_error", "state"});
  for (std::size_t p = 0; p < model.positions.size(); ++p) {
    const SubModel& sub = model.positions[p];
    std::vector<std::string> row{std::to_string(p + 1)};
    for (const Vec3* v : {&sub.point, &sub.normal})
      for (int k = 0; k < 3; ++k) row.push_back(format_number((*v)[k]));
    for (std::size_t a = 0; a < 3; ++a) {
      std::vector<std::size_t> slots;
      for (int slot = 0; slot < 1 + 2 * model.terms; ++slot)
        slots.push_back(static_cast<std::size_t>(slot));
      if (sub.axis[a].stiffening() != 0) slots.push_back(AcfmAxis::kStiffening);
      for (const std::size_t slot : slots) {
        std::vector<std::string> full = row;
        const double error = sub.axis[a].error[slot];
        full.insert(full.end(), {kAxes[a], name_of(slot), format_number(sub.axis[a].value[slot]),
                                 slot == AcfmAxis::kStiffening ? "1/m"
                                 : slot > 0 && slot % 2 == 0   ? "s"
                                                               : "N/m",
                                 std::isfinite(error) ? format_number(error) : "",
                                 sub.axis[a].derived ? "derived" : "free"});
        csv.row(full);
      }
    }
  }
}

}  // namespace hapsim
