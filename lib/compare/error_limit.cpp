#include "compare/error_limit.h"

#include <fmt/format.h>

#include "base/error.h"
#include "compare/wording.h"
#include "io/number.h"
#include "io/quantity.h"

namespace hapsim {

double ErrorLimit::newtons_of(const Comparison& c) const {
  if (unit == Unit::kPercent) return factor / 100 * c.size.force_rms;
  return unit == Unit::kNoise ? factor * c.noise.value : factor;
}

ErrorLimit parse_error_limit(const std::string& text, const std::string& option) {
  const auto end = text.find_last_of("0123456789.");
  const std::string unit(trim(end == text.npos ? text : text.substr(end + 1)));
  ErrorLimit limit;
  limit.option = option;
  limit.text = text;
  const bool number = end != text.npos && parse_number(text.substr(0, end + 1), limit.factor);
  if (unit == "%")
    limit.unit = ErrorLimit::Unit::kPercent;
  else if (unit == "noise" || unit == "xnoise")
    limit.unit = ErrorLimit::Unit::kNoise;
  else if (number && !unit.empty())
    limit.factor = parse_quantity(text, Quantity::kForce, option);
  if (!number || unit.empty() || limit.factor < 0)
    fail_usage(
        option + " " + shown(text) + " is not a limit",
        "give newtons, per cent of the force or multiples of the noise: 0.05N, 5%, 1.5noise");
  return limit;
}

std::string excess_over(const ErrorLimit& limit, const Comparison& c,
                        const std::string& recording) {
  if (limit.unit == ErrorLimit::Unit::kNoise && !(c.noise.value > 0))
    fail_input(recording,
               "the noise is not known, so " + limit.option + " in noise cannot be judged",
               "add a line '# force_noise: 0.02' (newtons), or give the limit in N");
  const double most = limit.newtons_of(c);
  if (!(c.size.rmse > most)) return "";
  std::string text = fmt::format("typical error {} exceeds {} ({})", newtons(c.size.rmse),
                                 newtons(most), limit.text);
  if (const std::vector<int> worst = c.worst_positions(); !worst.empty())
    text += "; worst position " +
            c.by_position().grouping.bins[static_cast<std::size_t>(worst[0])].label;
  return text;
}

JunitCase error_case(const ErrorLimit& limit, const Comparison& c, const std::string& recording) {
  const std::string excess = excess_over(limit, c, recording);
  std::string details = excess;
  for (const Observation& o : c.observations) details += "\n" + o.sentence;
  return {recording + " below " + limit.text, excess, details};
}

}  // namespace hapsim
