#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "base/counted.h"
#include "base/error.h"
#include "scan/sections.h"
#include "scan/table_columns.h"

namespace hapsim {
namespace {

struct Traced {
  double z = 0;
  long line = 0;
  std::map<std::string, std::vector<Eigen::Vector2d>> contours;
  std::map<std::string, long> contour_line;
};

void add_point(Traced& section, const std::string& contour, long line, const Eigen::Vector2d& p) {
  auto& points = section.contours[contour];
  if (points.empty()) section.contour_line[contour] = line;
  if (points.empty() || points.back() != p) points.push_back(p);
}

}  // namespace

std::vector<Section> read_sections(const CsvTable& table, double unit, double distance) {
  const std::string section_column = find_column(table, {"section", "slice"});
  const std::string contour_column = find_column(table, {"contour", "part"});
  const std::vector<double> x = table.numbers("x"), y = table.numbers("y");
  const bool has_z = table.find("z") >= 0;
  if (!has_z && (section_column.empty() || !(distance > 0))) {
    fail_input(table.name, "column 'z' is missing",
               section_column.empty() ? "add the height of each section"
                                      : "add it, or give --section-distance");
  }
  std::vector<double> section_number;
  if (!section_column.empty()) section_number = table.numbers(section_column);
  std::vector<double> z;
  if (has_z) z = table.numbers("z");

  std::map<double, Traced> traced;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const double height = has_z ? unit * z[row] : distance * section_number[row];
    const double key = section_number.empty() ? height : section_number[row];
    const auto [at, added] = traced.try_emplace(key);
    Traced& section = at->second;
    if (added) {
      section.z = height;
      section.line = table.line[row];
    } else if (std::abs(section.z - height) > 1e-9) {
      fail_input(fmt::format("{}:{}", table.name, table.line[row]),
                 fmt::format("section {} lies at another z than in line {}", key, section.line),
                 "sections must be flat and square to z");
    }
    const std::string contour =
        contour_column.empty()
            ? ""
            : table.columns[static_cast<std::size_t>(table.find(contour_column))][row];
    add_point(section, contour, table.line[row], unit * Eigen::Vector2d(x[row], y[row]));
  }

  std::vector<Section> sections;
  for (auto& [key, from] : traced) {
    Section section;
    section.z = from.z;
    for (auto& [name, points] : from.contours) {
      if (points.size() > 1 && points.front() == points.back()) points.pop_back();
      if (points.size() < 3) {
        fail_input(fmt::format("{}:{}", table.name, from.contour_line[name]),
                   fmt::format("a contour has only {}",
                               counted(points.size(), "different point", "different points")),
                   "a closed contour needs at least 3; are these points no sections?");
      }
      section.contours.push_back(std::move(points));
    }
    sections.push_back(std::move(section));
  }
  std::sort(sections.begin(), sections.end(),
            [](const Section& a, const Section& b) { return a.z < b.z; });
  if (sections.size() < 2) {
    fail_input(table.name, fmt::format("there are {} sections", sections.size()),
               "give at least 2, better some ten");
  }
  for (std::size_t s = 1; s < sections.size(); ++s) {
    if (!(sections[s].z - sections[s - 1].z > 1e-9)) {
      fail_input(table.name, fmt::format("two sections lie at z = {:.6g} m", sections[s].z),
                 "join them, or correct z");
    }
  }
  return sections;
}

}  // namespace hapsim
