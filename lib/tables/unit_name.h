// Units as people write them: "mm", "[mm]", "Millimètre", "nN", "毫牛".
#pragma once

#include <string>
#include <string_view>

namespace hapsim {

enum class UnitKind { kNone, kLength, kTime, kForce, kTemperature, kOther };

struct UnitName {
  UnitKind kind = UnitKind::kNone;
  double factor = 1;  // value_SI = factor * value + offset
  std::string name;   // as hapsim writes it: "mm"
  double offset = 0;  // of temperatures, to degC
};

// Reads a unit with any SI prefix; brackets and spaces around it do not matter. Case tells "mN"
// from "MN" and "nm" from "Nm"; a spelling whose case fits no unit is read without regard to it.
// kNone when it is none; kOther when it is one that no role of an import has ("MPa", "%", "N mm").
UnitName parse_unit(std::string_view text);

}  // namespace hapsim
