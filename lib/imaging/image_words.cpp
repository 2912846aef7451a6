#include <fmt/format.h>

#include "imaging/stiffness_image.h"

namespace hapsim {

std::vector<std::string> words_of(const StiffnessImage& image) {
  std::vector<std::string> words;
  const auto mm = [](const Interval& i) {
    return fmt::format("{:.1f} to {:.1f} mm", 1e3 * i.low, 1e3 * i.high);
  };
  // The bounds of what is asked say nothing of the body.
  const auto ratio = [](const Interval& i) {
    if (i.high > 0.8 * kMostRatio) return fmt::format("{:.2g} or more", i.low);
    if (i.low < 1.5 * kLeastRatio) return fmt::format("{:.2g} or less", i.high);
    return fmt::format("{:.2g} to {:.2g}", i.low, i.high);
  };
  for (const Lump& l : image.lumps)
    words.push_back(fmt::format(
        "something {} at ({:.1f}, {:.1f}, {:.1f}) mm, x {}, y {}, z {}; its centre {:.1f} mm deep, "
        "{}; as a ball of {:.1f} mm radius, {}, and {:.2g} times the modulus, {} "
        "(95 % each; size and modulus trade for each other); a body without one looks so {}",
        l.ratio > 1 ? "stiffer" : "softer", 1e3 * l.centre.x(), 1e3 * l.centre.y(),
        1e3 * l.centre.z(), mm(l.x), mm(l.y), mm(l.z), 1e3 * l.depth, mm(l.depth_in),
        1e3 * l.radius, mm(l.radius_in), l.ratio, ratio(l.ratio_in),
        l.chance < 1e-6 ? "in less than one of a million"
                        : fmt::format("with a chance of {:.1g}", l.chance)));
  if (image.lumps.empty())
    words.push_back(
        fmt::format("nothing compact is seen: no ball explains the presses better than "
                    "chance does in {:.2g} % of the bodies without one",
                    100 * kFalseAlarm));
  for (const Sight& s : image.found.sight) {
    const std::string ball =
        s.ratio < 0.05 ? fmt::format("a cavity of {:.0f} mm diameter ", 2e3 * s.radius)
                       : fmt::format("a ball of {:.0f} mm diameter, {:g} times as stiff, ",
                                     2e3 * s.radius, s.ratio);
    words.push_back(s.depth > 0 ? ball + fmt::format("is seen with its centre down to {:.0f} mm; "
                                                     "deeper it cannot be seen by these presses",
                                                     1e3 * s.depth)
                                : ball + "cannot be seen by these presses at any depth");
  }
  words.push_back(fmt::format(
      "gains differ by {:.2g} % from place to place; with the field by {:.2g} %, {:.2g} "
      "% on positions left out; their errors are {:.2g} %",
      100 * image.misfit_before, 100 * image.field.misfit, 100 * image.field.held_out,
      100 * image.error));
  return words;
}

}  // namespace hapsim
