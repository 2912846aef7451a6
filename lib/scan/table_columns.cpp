#include "scan/table_columns.h"

#include <algorithm>

#include "base/error.h"

namespace hapsim {

std::string zone_column(const CsvTable& table) {
  return find_column(table, {"zone", "region", "view"});
}

std::string touch_force_column(const CsvTable& table) {
  return find_column(table, {"touch_force", "force", "f_touch"});
}

void take_zones(const CsvTable& table, const std::vector<int>& kept, Scan& scan) {
  const std::string column = zone_column(table);
  if (column.empty()) return;
  const auto& cells = table.columns[static_cast<std::size_t>(table.find(column))];
  for (const int row : kept) {
    const std::string name(trim(cells[static_cast<std::size_t>(row)]));
    if (name.empty()) {
      fail_input(table.name + ":" + std::to_string(table.line[static_cast<std::size_t>(row)]),
                 "the zone is empty", "name it, or remove the row");
    }
    const auto at = std::find(scan.zone_names.begin(), scan.zone_names.end(), name);
    scan.zone.push_back(static_cast<int>(at - scan.zone_names.begin()));
    if (at == scan.zone_names.end()) scan.zone_names.push_back(name);
  }
}

void take_touch_force(const CsvTable& table, const std::vector<int>& kept, Scan& scan) {
  const std::string column = touch_force_column(table);
  if (column.empty()) return;
  const std::vector<double> force = table.numbers(column);
  for (const int row : kept) {
    // Sensors of either sign convention: the size of the push counts.
    scan.touch_force.push_back(std::abs(force[static_cast<std::size_t>(row)]));
  }
}

std::vector<Vec3> vector_columns(const CsvTable& table, const std::string& x, const std::string& y,
                                 const std::string& z) {
  const std::vector<double> a = table.numbers(x), b = table.numbers(y), c = table.numbers(z);
  std::vector<Vec3> v(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) v[i] = {a[i], b[i], c[i]};
  return v;
}

}  // namespace hapsim
