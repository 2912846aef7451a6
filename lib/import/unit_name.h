// Units as people write them: "mm", "[mm]", "Millimeter", "sec", "N".
#pragma once

#include <string>
#include <string_view>

namespace hapsim {

enum class UnitKind { kNone, kLength, kTime, kForce, kTemperature, kOther };

struct UnitName {
  UnitKind kind = UnitKind::kNone;
  double factor = 1;  // value_SI = factor * value
  std::string name;   // as hapsim writes it: "mm"
};

// Reads a unit; brackets and spaces around it do not matter. kNone when it is none; kOther when it
// is one that no role of an import has ("MPa", "%").
UnitName parse_unit(std::string_view text);

}  // namespace hapsim
