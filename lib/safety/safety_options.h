// The limits of a force at somebody's hand, as flags of the tools that make one.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "base/error.h"
#include "cli/tool.h"
#include "io/number.h"
#include "io/stream.h"
#include "safety/safe_force.h"

namespace hapsim {

namespace flag {
inline constexpr FileFlag device{"--device"};
inline constexpr ForceFlag max_force{"--max-force"};
inline constexpr NumberFlag max_rate{"--max-rate"}, max_power{"--max-power"},
    max_speed{"--max-speed"}, max_energy{"--max-energy"};
inline constexpr SwitchFlag any_energy{"--any-energy"};
inline constexpr TimeFlag hold{"--hold"}, ramp{"--ramp"};
inline constexpr LengthsFlag workspace{"--workspace"};
}  // namespace flag

inline std::vector<Option> safety_flags() {
  const SafetyLimits usual;
  return {
      {.flag = flag::device,
       .value = "FILE",
       .help = "Limits of the device at the hand: CSV limit,value with rows force, rate, power, "
               "speed, hold, ramp, energy, damping, x_low, x_high, ... (SI). Flags go before it.",
       .group = "Safety"},
      {.flag = flag::max_force,
       .value = "N",
       .help = "Largest force at the hand [N]; otherwise the device's, otherwise " +
               format_number(usual.force) + ".",
       .group = "Safety",
       .minimum = 1e-6},
      {.flag = flag::max_rate,
       .value = "N/S",
       .help = "Fastest change of it [N/s]; otherwise " + format_number(usual.rate) + ".",
       .group = "Safety",
       .minimum = 1e-6},
      {.flag = flag::max_power,
       .value = "W",
       .help = "Most power that it may do on the hand [W]; otherwise " +
               format_number(usual.power) + ".",
       .group = "Safety",
       .minimum = 1e-9},
      {.flag = flag::max_speed,
       .value = "M/S",
       .help = "Fastest motion of a tool that is led from afar, and of a hand whose energy has a "
               "bound [m/s]; otherwise " +
               format_number(usual.speed) + ".",
       .group = "Safety",
       .minimum = 1e-6},
      {.flag = flag::max_energy,
       .value = "J",
       .help = "Most energy that it may give to the hand beyond what the hand has put in [J]; "
               "otherwise what the limits make inevitable, 1.25 x force x (force / (2 rate) + a "
               "period) x speed, " +
               format_number(usual.energy_bound()) + " of the usual ones.",
       .group = "Safety",
       .minimum = 1e-6},
      {.flag = flag::any_energy,
       .help = "Does not count it: to see what late forces do, not for a hand.",
       .group = "Safety"},
      {.flag = flag::hold,
       .value = "S",
       .help = "How long a force goes on when nothing new comes [s]; otherwise " +
               format_number(usual.hold) + ".",
       .group = "Safety",
       .minimum = 1e-3,
       .maximum = 2},
      {.flag = flag::ramp,
       .value = "S",
       .help =
           "Within which it then goes to zero [s]; otherwise " + format_number(usual.ramp) + ".",
       .group = "Safety",
       .minimum = 1e-3,
       .maximum = 5},
      {.flag = flag::workspace,
       .value = "X,Y,Z,X,Y,Z",
       .help = "Low and high corner of where the tool may be [m]; outside there is no force.",
       .group = "Safety"}};
}

inline SafetyLimits safety_limits(const Arguments& arguments) {
  SafetyLimits limits;
  if (arguments.given(flag::device)) {
    Input input(arguments[flag::device]);
    limits = read_limits(input);
  }
  const auto take = [&](const auto& flag, double& value) {
    if (arguments.given(flag)) value = arguments[flag];
  };
  take(flag::max_force, limits.force);
  take(flag::max_rate, limits.rate);
  take(flag::max_power, limits.power);
  take(flag::max_speed, limits.speed);
  take(flag::max_energy, limits.energy);
  if (arguments[flag::any_energy]) {
    if (arguments.given(flag::max_energy))
      fail_usage("--max-energy and --any-energy exclude each other", "leave one of them out");
    limits = of_any_energy(limits);
  }
  take(flag::hold, limits.hold);
  take(flag::ramp, limits.ramp);
  if (arguments.given(flag::workspace)) {
    std::string text = arguments[flag::workspace];
    for (char& c : text)
      if (c == ',' || c == ':') c = ' ';
    std::vector<double> corners;
    for (std::size_t at = 0; at < text.size();) {
      const std::size_t end = std::min(text.find(' ', at), text.size());
      double value = 0;
      if (!parse_number(text.substr(at, end - at), value)) break;
      corners.push_back(value);
      at = end + 1;
    }
    if (corners.size() != 6)
      fail_usage("--workspace has " + std::to_string(corners.size()) + " numbers and not six",
                 "give its low corner, then its high one: -0.1,-0.1,-0.1,0.1,0.1,0.1");
    limits.low = {corners[0], corners[1], corners[2]};
    limits.high = {corners[3], corners[4], corners[5]};
  }
  check(limits);
  return limits;
}

}  // namespace hapsim
