#include "tables/unit_name.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>

#include "tables/fold.h"

namespace hapsim {
namespace {

struct Prefix {
  const char* symbol;
  double factor;
};

// Symbols: their case matters.
constexpr std::array kPrefixes{Prefix{"", 1},     Prefix{"p", 1e-12}, Prefix{"n", 1e-9},
                               Prefix{"u", 1e-6}, Prefix{"m", 1e-3},  Prefix{"c", 1e-2},
                               Prefix{"d", 1e-1}, Prefix{"da", 10},   Prefix{"k", 1e3},
                               Prefix{"M", 1e6},  Prefix{"G", 1e9}};
// Names, folded.
constexpr std::array kPrefixNames{
    Prefix{"", 1},          Prefix{"pico", 1e-12}, Prefix{"nano", 1e-9},     Prefix{"micro", 1e-6},
    Prefix{"mikro", 1e-6},  Prefix{"milli", 1e-3}, Prefix{"mili", 1e-3},     Prefix{"centi", 1e-2},
    Prefix{"zenti", 1e-2},  Prefix{"deci", 1e-1},  Prefix{"kilo", 1e3},      Prefix{"mega", 1e6},
    Prefix{"giga", 1e9},    Prefix{"纳", 1e-9},    Prefix{"納", 1e-9},       Prefix{"奈", 1e-9},
    Prefix{"微", 1e-6},     Prefix{"毫", 1e-3},    Prefix{"厘", 1e-2},       Prefix{"千", 1e3},
    Prefix{"兆", 1e6},      Prefix{"ナノ", 1e-9},  Prefix{"マイクロ", 1e-6}, Prefix{"ミリ", 1e-3},
    Prefix{"センチ", 1e-2}, Prefix{"キロ", 1e3},   Prefix{"メガ", 1e6}};

struct Base {
  const char* text;
  UnitKind kind;
  double factor;
  const char* name;  // as hapsim writes it
};

// What takes a prefix: by symbol ...
constexpr std::array kSymbols{
    Base{"m", UnitKind::kLength, 1, "m"},          Base{"s", UnitKind::kTime, 1, "s"},
    Base{"N", UnitKind::kForce, 1, "N"},           Base{"gf", UnitKind::kForce, 9.80665e-3, "gf"},
    Base{"g", UnitKind::kForce, 9.80665e-3, "gf"}, Base{"Pa", UnitKind::kOther, 1, "Pa"},
    Base{"Nm", UnitKind::kOther, 1, "Nm"},         Base{"N.m", UnitKind::kOther, 1, "Nm"},
    Base{"N m", UnitKind::kOther, 1, "Nm"},        Base{"V", UnitKind::kOther, 1, "V"},
    Base{"A", UnitKind::kOther, 1, "A"},           Base{"Hz", UnitKind::kOther, 1, "Hz"},
    Base{"J", UnitKind::kOther, 1, "J"},           Base{"W", UnitKind::kOther, 1, "W"},
    Base{"rad", UnitKind::kOther, 1, "rad"}};
// ... and by name, folded.
constexpr std::array kNames{Base{"meter", UnitKind::kLength, 1, "m"},
                            Base{"meters", UnitKind::kLength, 1, "m"},
                            Base{"metre", UnitKind::kLength, 1, "m"},
                            Base{"metres", UnitKind::kLength, 1, "m"},
                            Base{"metro", UnitKind::kLength, 1, "m"},
                            Base{"metros", UnitKind::kLength, 1, "m"},
                            Base{"metri", UnitKind::kLength, 1, "m"},
                            Base{"米", UnitKind::kLength, 1, "m"},
                            Base{"メートル", UnitKind::kLength, 1, "m"},
                            Base{"メトル", UnitKind::kLength, 1, "m"},
                            Base{"second", UnitKind::kTime, 1, "s"},
                            Base{"seconds", UnitKind::kTime, 1, "s"},
                            Base{"seconde", UnitKind::kTime, 1, "s"},
                            Base{"secondes", UnitKind::kTime, 1, "s"},
                            Base{"secondi", UnitKind::kTime, 1, "s"},
                            Base{"secondo", UnitKind::kTime, 1, "s"},
                            Base{"segundo", UnitKind::kTime, 1, "s"},
                            Base{"segundos", UnitKind::kTime, 1, "s"},
                            Base{"sekunde", UnitKind::kTime, 1, "s"},
                            Base{"sekunden", UnitKind::kTime, 1, "s"},
                            Base{"sec", UnitKind::kTime, 1, "s"},
                            Base{"secs", UnitKind::kTime, 1, "s"},
                            Base{"sek", UnitKind::kTime, 1, "s"},
                            Base{"s", UnitKind::kTime, 1, "s"},
                            Base{"秒", UnitKind::kTime, 1, "s"},
                            Base{"newton", UnitKind::kForce, 1, "N"},
                            Base{"newtons", UnitKind::kForce, 1, "N"},
                            Base{"牛顿", UnitKind::kForce, 1, "N"},
                            Base{"牛頓", UnitKind::kForce, 1, "N"},
                            Base{"牛", UnitKind::kForce, 1, "N"},
                            Base{"ニュートン", UnitKind::kForce, 1, "N"},
                            Base{"gram", UnitKind::kForce, 9.80665e-3, "gf"},
                            Base{"grams", UnitKind::kForce, 9.80665e-3, "gf"},
                            Base{"gramm", UnitKind::kForce, 9.80665e-3, "gf"},
                            Base{"gramme", UnitKind::kForce, 9.80665e-3, "gf"},
                            Base{"grammes", UnitKind::kForce, 9.80665e-3, "gf"},
                            Base{"gramo", UnitKind::kForce, 9.80665e-3, "gf"},
                            Base{"gramos", UnitKind::kForce, 9.80665e-3, "gf"},
                            Base{"grammo", UnitKind::kForce, 9.80665e-3, "gf"},
                            Base{"grammi", UnitKind::kForce, 9.80665e-3, "gf"},
                            Base{"克", UnitKind::kForce, 9.80665e-3, "gf"},
                            Base{"グラム", UnitKind::kForce, 9.80665e-3, "gf"},
                            Base{"pascal", UnitKind::kOther, 1, "Pa"},
                            Base{"帕", UnitKind::kOther, 1, "Pa"}};

struct Whole {
  const char* text;  // folded
  UnitKind kind;
  double factor;
  const char* name;
  double offset = 0;
};

// What takes no prefix, and how people abbreviate what does.
constexpr std::array kWholes{
    Whole{"micron", UnitKind::kLength, 1e-6, "um"},
    Whole{"microns", UnitKind::kLength, 1e-6, "um"},
    Whole{"in", UnitKind::kLength, 0.0254, "in"},
    Whole{"inch", UnitKind::kLength, 0.0254, "in"},
    Whole{"inches", UnitKind::kLength, 0.0254, "in"},
    Whole{"mil", UnitKind::kLength, 2.54e-5, "mil"},
    Whole{"mils", UnitKind::kLength, 2.54e-5, "mil"},
    Whole{"thou", UnitKind::kLength, 2.54e-5, "mil"},
    Whole{"ft", UnitKind::kLength, 0.3048, "ft"},
    Whole{"msec", UnitKind::kTime, 1e-3, "ms"},
    Whole{"msecs", UnitKind::kTime, 1e-3, "ms"},
    Whole{"usec", UnitKind::kTime, 1e-6, "us"},
    Whole{"nsec", UnitKind::kTime, 1e-9, "ns"},
    Whole{"nsecs", UnitKind::kTime, 1e-9, "ns"},
    Whole{"min", UnitKind::kTime, 60, "min"},
    Whole{"minute", UnitKind::kTime, 60, "min"},
    Whole{"minutes", UnitKind::kTime, 60, "min"},
    Whole{"minuten", UnitKind::kTime, 60, "min"},
    Whole{"minuto", UnitKind::kTime, 60, "min"},
    Whole{"minutos", UnitKind::kTime, 60, "min"},
    Whole{"minuti", UnitKind::kTime, 60, "min"},
    Whole{"分", UnitKind::kTime, 60, "min"},
    Whole{"分钟", UnitKind::kTime, 60, "min"},
    Whole{"h", UnitKind::kTime, 3600, "h"},
    Whole{"hr", UnitKind::kTime, 3600, "h"},
    Whole{"hours", UnitKind::kTime, 3600, "h"},
    Whole{"kp", UnitKind::kForce, 9.80665, "kgf"},
    Whole{"kg-f", UnitKind::kForce, 9.80665, "kgf"},
    Whole{"g-f", UnitKind::kForce, 9.80665e-3, "gf"},
    Whole{"pond", UnitKind::kForce, 9.80665e-3, "gf"},
    Whole{"公斤", UnitKind::kForce, 9.80665, "kgf"},
    Whole{"公斤力", UnitKind::kForce, 9.80665, "kgf"},
    Whole{"lbf", UnitKind::kForce, 4.4482216152605, "lbf"},
    Whole{"lb", UnitKind::kForce, 4.4482216152605, "lbf"},
    Whole{"lbs", UnitKind::kForce, 4.4482216152605, "lbf"},
    Whole{"ozf", UnitKind::kForce, 0.27801385095378, "ozf"},
    Whole{"oz", UnitKind::kForce, 0.27801385095378, "ozf"},
    Whole{"dyn", UnitKind::kForce, 1e-5, "dyn"},
    Whole{"dyne", UnitKind::kForce, 1e-5, "dyn"},
    Whole{"degc", UnitKind::kTemperature, 1, "degC"},
    Whole{"deg c", UnitKind::kTemperature, 1, "degC"},
    Whole{"celsius", UnitKind::kTemperature, 1, "degC"},
    Whole{"摄氏度", UnitKind::kTemperature, 1, "degC"},
    Whole{"c", UnitKind::kTemperature, 1, "degC"},
    Whole{"k", UnitKind::kTemperature, 1, "K", -273.15},
    Whole{"kelvin", UnitKind::kTemperature, 1, "K", -273.15},
    Whole{"degf", UnitKind::kTemperature, 5. / 9., "degF", -160. / 9.},
    Whole{"fahrenheit", UnitKind::kTemperature, 5. / 9., "degF", -160. / 9.},
    Whole{"%", UnitKind::kOther, 1, "%"},
    Whole{"percent", UnitKind::kOther, 1, "%"},
    Whole{"nmm", UnitKind::kOther, 1, "Nmm"},
    Whole{"n.mm", UnitKind::kOther, 1, "Nmm"},
    Whole{"n mm", UnitKind::kOther, 1, "Nmm"},
    Whole{"psi", UnitKind::kOther, 1, "psi"},
    Whole{"bar", UnitKind::kOther, 1, "bar"},
    Whole{"mbar", UnitKind::kOther, 1, "mbar"},
    Whole{"deg", UnitKind::kOther, 1, "deg"},
    Whole{"grad", UnitKind::kOther, 1, "deg"},
    Whole{"volt", UnitKind::kOther, 1, "V"},
    Whole{"volts", UnitKind::kOther, 1, "V"},
    Whole{"counts", UnitKind::kOther, 1, "counts"},
    Whole{"a.u.", UnitKind::kOther, 1, "a.u."},
    Whole{"a.u", UnitKind::kOther, 1, "a.u."},
    Whole{"au", UnitKind::kOther, 1, "a.u."},
    Whole{"-", UnitKind::kOther, 1, "-"},
    Whole{"pc", UnitKind::kOther, 1e-12, "pC"},
    Whole{"nc", UnitKind::kOther, 1e-9, "nC"}};

UnitName prefixed(const Prefix& prefix, const Base& base, const std::string& symbol) {
  return {base.kind, prefix.factor * base.factor, symbol + base.name};
}

std::string symbol_of(double factor) {
  const auto at = std::find_if(kPrefixes.begin(), kPrefixes.end(),
                               [factor](const Prefix& p) { return p.factor == factor; });
  return at->symbol;
}

// There are no megametres in a recording, and "Ms" is a spelling of milliseconds.
bool is_used(const Prefix& prefix, const Base& base) {
  return prefix.factor <= 1 || base.kind == UnitKind::kForce || base.kind == UnitKind::kOther;
}

std::optional<UnitName> by_symbol(std::string_view text) {
  for (const Base& base : kSymbols)
    for (const Prefix& prefix : kPrefixes)
      if (text == std::string(prefix.symbol) + base.text && is_used(prefix, base))
        return prefixed(prefix, base, prefix.symbol);
  return {};
}

std::optional<UnitName> by_name(const std::string& folded) {
  for (const Whole& whole : kWholes)
    if (folded == whole.text) return UnitName{whole.kind, whole.factor, whole.name, whole.offset};
  for (const Base& base : kNames)
    for (const Prefix& prefix : kPrefixNames)
      if (folded == std::string(prefix.symbol) + base.text)
        return prefixed(prefix, base, symbol_of(prefix.factor));
  return {};
}

// "MM", "Kn", "KGF": letters whose case says nothing have the prefixes of everyday. "NM" is a
// torque as well as a length: neither is taken.
std::optional<UnitName> without_case(const std::string& folded) {
  if (folded == "nm") return UnitName{UnitKind::kOther, 1, "NM"};
  if (auto unit = by_symbol(folded)) return unit;
  for (const char* text :
       {"mN", "kN", "cN", "uN", "nN", "pN", "N", "Pa", "kPa", "MPa", "Nm", "kgf", "V", "mV", "Hz"})
    if (folded == fold(text)) return by_symbol(text);
  return {};
}

bool is_ratio(const std::string& folded) {
  const std::size_t slash = folded.find('/');
  if (slash == folded.npos || slash == 0) return false;
  std::string below = folded.substr(slash + 1);
  while (!below.empty() && std::isdigit(static_cast<unsigned char>(below.back()))) below.pop_back();
  if (!below.empty() && below.back() == '^') below.pop_back();
  return parse_unit(folded.substr(0, slash)).kind != UnitKind::kNone &&
         parse_unit(below).kind != UnitKind::kNone;
}

}  // namespace

UnitName parse_unit(std::string_view given) {
  const std::string whole = plain(given);
  std::string_view text = whole;
  while (!text.empty() && std::string_view(" \t[](){}<>\"").find(text.front()) != text.npos)
    text.remove_prefix(1);
  while (!text.empty() && std::string_view(" \t[](){}<>\".").find(text.back()) != text.npos)
    text.remove_suffix(1);
  if (text.empty()) return {};
  if (const auto unit = by_symbol(text)) return *unit;
  const std::string folded = fold(text);
  if (const auto unit = by_name(folded)) return *unit;
  if (const auto unit = without_case(folded)) return *unit;
  if (is_ratio(folded)) return {UnitKind::kOther, 1, std::string(text)};
  return {};
}

}  // namespace hapsim
