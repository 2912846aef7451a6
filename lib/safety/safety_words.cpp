#include "safety/safety_words.h"

#include <fmt/format.h>

namespace hapsim {

void SafetyCounts::add(const SafeSample& sample) noexcept {
  ++samples;
  for (std::size_t bit = 0; bit < flagged.size(); ++bit) flagged[bit] += sample.flags >> bit & 1;
}

std::string SafetyCounts::summary() const {
  constexpr std::array<const char*, 9> kWords{
      "force cut", "change cut", "power cut", "outside the workspace", "no valid sample", "held",
      "ramped",    "ended",      "damped"};
  std::string text;
  for (std::size_t bit = 0; bit < flagged.size(); ++bit)
    if (flagged[bit] > 0)
      text += fmt::format("{}{} in {}", text.empty() ? "" : ", ", kWords[bit], flagged[bit]);
  return text.empty() ? text : fmt::format("{} of {} samples", text, samples);
}

}  // namespace hapsim
