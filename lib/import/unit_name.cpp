#include "import/unit_name.h"

#include <array>

#include "import/text_decode.h"

namespace hapsim {
namespace {

struct Spelling {
  const char* text;  // folded
  UnitKind kind;
  double factor;
  const char* name;
};

constexpr std::array kSpellings{
    Spelling{"m", UnitKind::kLength, 1, "m"},
    Spelling{"meter", UnitKind::kLength, 1, "m"},
    Spelling{"meters", UnitKind::kLength, 1, "m"},
    Spelling{"metre", UnitKind::kLength, 1, "m"},
    Spelling{"metres", UnitKind::kLength, 1, "m"},
    Spelling{"mm", UnitKind::kLength, 1e-3, "mm"},
    Spelling{"millimeter", UnitKind::kLength, 1e-3, "mm"},
    Spelling{"millimeters", UnitKind::kLength, 1e-3, "mm"},
    Spelling{"millimetre", UnitKind::kLength, 1e-3, "mm"},
    Spelling{"millimetres", UnitKind::kLength, 1e-3, "mm"},
    Spelling{"cm", UnitKind::kLength, 1e-2, "cm"},
    Spelling{"um", UnitKind::kLength, 1e-6, "um"},
    Spelling{"micron", UnitKind::kLength, 1e-6, "um"},
    Spelling{"microns", UnitKind::kLength, 1e-6, "um"},
    Spelling{"nm", UnitKind::kLength, 1e-9, "nm"},
    Spelling{"inch", UnitKind::kLength, 0.0254, "in"},
    Spelling{"s", UnitKind::kTime, 1, "s"},
    Spelling{"sec", UnitKind::kTime, 1, "s"},
    Spelling{"secs", UnitKind::kTime, 1, "s"},
    Spelling{"second", UnitKind::kTime, 1, "s"},
    Spelling{"seconds", UnitKind::kTime, 1, "s"},
    Spelling{"sek", UnitKind::kTime, 1, "s"},
    Spelling{"sekunde", UnitKind::kTime, 1, "s"},
    Spelling{"sekunden", UnitKind::kTime, 1, "s"},
    Spelling{"ms", UnitKind::kTime, 1e-3, "ms"},
    Spelling{"msec", UnitKind::kTime, 1e-3, "ms"},
    Spelling{"us", UnitKind::kTime, 1e-6, "us"},
    Spelling{"ns", UnitKind::kTime, 1e-9, "ns"},
    Spelling{"min", UnitKind::kTime, 60, "min"},
    Spelling{"n", UnitKind::kForce, 1, "N"},
    Spelling{"newton", UnitKind::kForce, 1, "N"},
    Spelling{"newtons", UnitKind::kForce, 1, "N"},
    Spelling{"mn", UnitKind::kForce, 1e-3, "mN"},
    Spelling{"millinewton", UnitKind::kForce, 1e-3, "mN"},
    Spelling{"kn", UnitKind::kForce, 1e3, "kN"},
    Spelling{"cn", UnitKind::kForce, 1e-2, "cN"},
    Spelling{"un", UnitKind::kForce, 1e-6, "uN"},
    Spelling{"g", UnitKind::kForce, 9.80665e-3, "gf"},
    Spelling{"gf", UnitKind::kForce, 9.80665e-3, "gf"},
    Spelling{"gram", UnitKind::kForce, 9.80665e-3, "gf"},
    Spelling{"grams", UnitKind::kForce, 9.80665e-3, "gf"},
    Spelling{"kg", UnitKind::kForce, 9.80665, "kgf"},
    Spelling{"kgf", UnitKind::kForce, 9.80665, "kgf"},
    Spelling{"lbf", UnitKind::kForce, 4.4482216152605, "lbf"},
    Spelling{"degc", UnitKind::kTemperature, 1, "degC"},
    Spelling{"c", UnitKind::kTemperature, 1, "degC"},
    Spelling{"pa", UnitKind::kOther, 1, "Pa"},
    Spelling{"kpa", UnitKind::kOther, 1, "kPa"},
    Spelling{"mpa", UnitKind::kOther, 1, "MPa"},
    Spelling{"%", UnitKind::kOther, 1, "%"},
    Spelling{"nm/mm", UnitKind::kOther, 1, "Nmm/mm"},
    Spelling{"nmm", UnitKind::kOther, 1, "Nmm"},
    Spelling{"n/mm", UnitKind::kOther, 1, "N/mm"},
    Spelling{"n/mm2", UnitKind::kOther, 1, "MPa"},
    Spelling{"mm/s", UnitKind::kOther, 1, "mm/s"},
    Spelling{"mm/min", UnitKind::kOther, 1, "mm/min"},
    Spelling{"m/s", UnitKind::kOther, 1, "m/s"},
    Spelling{"deg", UnitKind::kOther, 1, "deg"},
    Spelling{"rad", UnitKind::kOther, 1, "rad"},
    Spelling{"v", UnitKind::kOther, 1, "V"},
    Spelling{"mv", UnitKind::kOther, 1, "mV"},
    Spelling{"hz", UnitKind::kOther, 1, "Hz"},
    Spelling{"-", UnitKind::kOther, 1, "-"},
};

}  // namespace

UnitName parse_unit(std::string_view text) {
  while (!text.empty() && std::string_view(" \t[](){}<>\"").find(text.front()) != text.npos)
    text.remove_prefix(1);
  while (!text.empty() && std::string_view(" \t[](){}<>\".").find(text.back()) != text.npos)
    text.remove_suffix(1);
  const std::string folded = fold(text);
  for (const Spelling& spelling : kSpellings)
    if (folded == spelling.text) return {spelling.kind, spelling.factor, spelling.name};
  return {};
}

}  // namespace hapsim
