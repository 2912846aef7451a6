#include "compare/gain_sentences.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

namespace hapsim {
namespace {

constexpr double kSmallestWeight = 0.002;  // of all bins, to be named

std::string percent(double share) {
  const double p = 100 * std::abs(share);
  return p < 9.95 ? fmt::format("{:.1f} %", p) : fmt::format("{:.0f} %", p);
}

std::string opening(const std::string& name) {
  if (name == "position") return "The error differs by place";
  if (name == "depth") return "The error changes with depth";
  if (name == "rate") return "The error changes with the tool's speed";
  if (name == "contact-time") return "The error changes with time since contact";
  if (name == "session-time") return "The error changes in the course of the session";
  if (name == "direction") return "The error depends on the force's direction";
  if (name == "press-direction") return "The error depends on which way the tool moves";
  if (name == "cycle") return "The error differs between first and later presses of a place";
  if (name == kByTemperature) return "The error changes with the temperature";
  return "The error differs between loading, hold and unloading";
}

std::string where(const Grouping& grouping, int bin) {
  std::string label = grouping.bins[bin].label;
  if (grouping.name == "position") return "at " + label;
  if (grouping.name == "contact-time" && label.rfind("in the first", 0) == 0)
    return label + " of each press";
  if (std::isdigit(static_cast<unsigned char>(label[0])))
    return (grouping.name == "depth" || grouping.name == "rate" || grouping.name == kByTemperature
                ? "at "
                : "from ") +
           label;
  return label;
}

// Two standard errors of too_stiff().
double doubt_of(const BinError& error) {
  return 2 * error.gain_error / (error.gain * error.gain);
}

}  // namespace

bool right_on_the_whole(const BinError& error) {
  return error.gain > 0.1 && std::abs(error.too_stiff()) < doubt_of(error);
}

std::string stiffness_words(const BinError& error) {
  if (std::isnan(error.gain)) return "without force there";
  if (!(error.gain > 0.1))
    return "unlike the measured force (gain " + fmt::format("{:.2f}", error.gain) + ")";
  const double stiff = error.too_stiff();
  if (right_on_the_whole(error))
    return "right (within " + percent(std::max(doubt_of(error), 0.001)) + ")";
  return (stiff > 0 ? "too stiff by " : "too soft by ") + percent(stiff);
}

std::string sentence_overall(const BinError& error) {
  return "The model is " + stiffness_words(error) +
         (error.gain < 1 ? " on the whole: its force is too large."
                         : " on the whole: its force is too small.");
}

std::string sentence_of_bins(const Grouping& grouping, const std::vector<BinError>& errors) {
  double weight = 0;
  for (const BinError& e : errors) weight += e.weight;
  int low = -1, high = -1;
  for (int b = 0; b < static_cast<int>(errors.size()); ++b) {
    const BinError& e = errors[b];
    if (!(e.weight > kSmallestWeight * weight) || grouping.bins[b].label == "not pressed") continue;
    if (low < 0 || e.gain < errors[low].gain) low = b;
    if (high < 0 || e.gain > errors[high].gain) high = b;
  }
  if (low == high) return "";
  const int first = std::min(low, high), second = std::max(low, high);
  return fmt::format("{}: the model is {} {}, {} {}.", opening(grouping.name),
                     stiffness_words(errors[first]), where(grouping, first),
                     stiffness_words(errors[second]), where(grouping, second));
}

}  // namespace hapsim
