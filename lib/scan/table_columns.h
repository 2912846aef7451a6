// What tables of points of all kinds share: columns by several names, zones, touch forces.
#pragma once

#include <string>
#include <vector>

#include "io/csv.h"
#include "io/find_column.h"
#include "scan/scan.h"

namespace hapsim {

// The columns of zones and touch forces, as the table writes them; "" for none.
std::string zone_column(const CsvTable& table);
std::string touch_force_column(const CsvTable& table);

// Takes the columns zone (or region, view, organ_zone) and touch_force (or force, f_touch), where
// there are any, into the scan, for the rows `kept`.
void take_zones(const CsvTable& table, const std::vector<int>& kept, Scan& scan);
void take_touch_force(const CsvTable& table, const std::vector<int>& kept, Scan& scan);

// Three columns as vectors.
std::vector<Vec3> vector_columns(const CsvTable& table, const std::string& x, const std::string& y,
                                 const std::string& z);

}  // namespace hapsim
