// The flags of commands: a name, and the kind of value that stands behind it.
#pragma once

#include <initializer_list>
#include <string>
#include <type_traits>

namespace hapsim {

// Those from kLength on are quantities: in SI, or with a unit ("0.004", "4mm"). What Arguments
// tells of them is in SI. kLengths and kTimes are several numbers in one value ("0,0,0.05",
// "1ms:2ms"), kPose is X,Y,Z[,R,P,Y]: lengths, then angles.
enum class OptionKind {
  kSwitch,
  kText,
  kNumber,
  kInteger,
  kChoice,
  kFile,
  kLength,
  kTime,
  kForce,
  kPressure,
  kLengths,
  kTimes,
  kPose
};

struct AnyFlag {
  const char* name = "";  // "--unit"
  OptionKind kind = OptionKind::kText;
};
using AnyFlags = std::initializer_list<AnyFlag>;

inline std::string operator+(const AnyFlag& flag, const std::string& text) {
  return flag.name + text;
}
inline std::string operator+(const std::string& text, const AnyFlag& flag) {
  return text + flag.name;
}

// A constant of a tool, by which it declares an option and asks for its value: a name that was
// never declared, or a value read as another kind, does not compile.
template <OptionKind kKind>
struct Flag : AnyFlag {
  explicit constexpr Flag(const char* name_) : AnyFlag{name_, kKind} {}

  static constexpr bool kIsNumber = kKind == OptionKind::kNumber || kKind == OptionKind::kLength ||
                                    kKind == OptionKind::kTime || kKind == OptionKind::kForce ||
                                    kKind == OptionKind::kPressure;
  // What Arguments tells of it: whether it is given, a number, or text.
  using Value =
      std::conditional_t<kKind == OptionKind::kSwitch, bool,
                         std::conditional_t<kKind == OptionKind::kInteger, long,
                                            std::conditional_t<kIsNumber, double, std::string>>>;
};

using SwitchFlag = Flag<OptionKind::kSwitch>;
using TextFlag = Flag<OptionKind::kText>;
using NumberFlag = Flag<OptionKind::kNumber>;
using IntegerFlag = Flag<OptionKind::kInteger>;
using ChoiceFlag = Flag<OptionKind::kChoice>;
using FileFlag = Flag<OptionKind::kFile>;
using LengthFlag = Flag<OptionKind::kLength>;
using TimeFlag = Flag<OptionKind::kTime>;
using ForceFlag = Flag<OptionKind::kForce>;
using PressureFlag = Flag<OptionKind::kPressure>;
using LengthsFlag = Flag<OptionKind::kLengths>;
using TimesFlag = Flag<OptionKind::kTimes>;
using PoseFlag = Flag<OptionKind::kPose>;

// Those of every tool; a tool adds its own.
namespace flag {
inline constexpr FileFlag output{"--output"};
inline constexpr SwitchFlag quiet{"--quiet"}, verbose{"--verbose"}, help{"--help"}, man{"--man"},
    version{"--version"};
}  // namespace flag

}  // namespace hapsim
