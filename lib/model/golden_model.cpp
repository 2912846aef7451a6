#include "model/golden_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "model/interval.h"
#include "model/search_state.h"

namespace hapsim {
namespace {

constexpr double kRounding = 1e-9;  // of a value that was written and read again

std::string full_name(const GoldenRow& row) {
  if (row.effect.empty()) return row.parameter;
  return fmt::format("{}.{}{}", row.effect, row.parameter,
                     row.region > 0 ? fmt::format(" of region {}", row.region) : "");
}

std::string with_unit(double value, const std::string& unit) {
  return fmt::format("{:.5g}{}", value, unit == "1" || unit.empty() ? "" : " " + unit);
}

double tolerance_of(const Parameter& p, const GoldenOptions& options) {
  double allowed = kRounding * std::abs(p.value);
  for (const Tolerance& t : options.tolerances)
    if (t.parameter.empty() || t.parameter == p.name || t.parameter == p.effect + "." + p.name)
      allowed = t.relative ? t.value * std::abs(p.value) : t.value;
  return allowed;
}

// What the standard errors of both explain, on the value's side of the golden one: of what is
// stepped in its logarithm a factor, as its interval is.
double allowed_by_errors(const Parameter& p, const Parameter& golden, double times) {
  const auto error = [](const Parameter& x) {
    const bool estimated = x.state != ParameterState::kFixed && std::isfinite(x.std_error);
    return estimated ? x.std_error : 0.0;
  };
  if (!is_logarithmic(golden) || !(p.value > 0 && golden.value > 0))
    return times * std::hypot(error(p), error(golden));
  constexpr double kMost = 100;  // exp() of it is beyond all that can be
  const double spread =
      std::min(times * std::hypot(error(p) / p.value, error(golden) / golden.value), kMost);
  return golden.value * std::abs(std::expm1(p.value < golden.value ? -spread : spread));
}

GoldenRow compare_parameter(const Parameter* p, const Parameter* golden,
                            const GoldenOptions& options) {
  const Parameter& either = golden != nullptr ? *golden : *p;
  GoldenRow row{either.effect, either.region, either.name, either.unit};
  row.value = p != nullptr ? p->value : std::nan("");
  row.golden = golden != nullptr ? golden->value : std::nan("");
  if (p == nullptr || golden == nullptr) {
    row.verdict = p == nullptr ? GoldenVerdict::kGone : GoldenVerdict::kNew;
    row.why =
        fmt::format("{} = {} {}", full_name(row), with_unit(either.value, either.unit),
                    p == nullptr ? "is only in the golden model" : "is not in the golden model");
    return row;
  }
  const double by_errors = allowed_by_errors(*p, *golden, options.standard_errors);
  const double by_tolerance = tolerance_of(*golden, options);
  row.allowed = std::max(by_errors, by_tolerance);
  const double difference = std::abs(row.value - row.golden);
  if ((p->state == ParameterState::kFixed) != (golden->state == ParameterState::kFixed)) {
    row.verdict = GoldenVerdict::kDiffers;
    row.why = fmt::format("{} is {}, in the golden model {}", full_name(row),
                          p->state == ParameterState::kFixed ? "fixed" : "estimated",
                          golden->state == ParameterState::kFixed ? "fixed" : "estimated");
  } else if (!(difference <= row.allowed)) {
    row.verdict = GoldenVerdict::kDiffers;
    row.why = fmt::format(
        "{} = {} differs from {} by {}{}; allowed {} ({})", full_name(row),
        with_unit(row.value, row.unit), with_unit(row.golden, row.unit),
        with_unit(difference, row.unit),
        row.golden != 0 ? fmt::format(" = {:.2g} %", 100 * difference / std::abs(row.golden)) : "",
        with_unit(row.allowed, row.unit),
        by_errors >= by_tolerance ? fmt::format("{:g} standard errors", options.standard_errors)
                                  : "tolerance");
  }
  return row;
}

void add_error(const Model& model, const Model& golden, const char* key,
               const GoldenOptions& options, std::vector<GoldenRow>& rows) {
  const auto value = model.metadata.number(key, "model"),
             before = golden.metadata.number(key, "golden model");
  if (!before) return;
  GoldenRow row{"", 0, key, "N", value.value_or(std::nan("")), *before, options.worse * *before};
  if (!value) {
    row.verdict = GoldenVerdict::kGone;
    row.why = fmt::format("{} = {} is only in the golden model", key, with_unit(*before, "N"));
  } else if (!(row.value - row.golden <= row.allowed)) {
    row.verdict = GoldenVerdict::kDiffers;
    row.why = fmt::format("{} = {} is worse than {} by {:.2g} %; allowed {:.2g} %", key,
                          with_unit(row.value, "N"), with_unit(row.golden, "N"),
                          100 * (row.value / row.golden - 1), 100 * options.worse);
  }
  rows.push_back(row);
}

}  // namespace

std::vector<GoldenRow> compare_with_golden(const Model& model, const Model& golden,
                                           const GoldenOptions& options) {
  std::vector<GoldenRow> rows;
  for (const Parameter& g : golden.parameters)
    rows.push_back(compare_parameter(model.find(g.effect, g.region, g.name), &g, options));
  for (const Parameter& p : model.parameters)
    if (golden.find(p.effect, p.region, p.name) == nullptr)
      rows.push_back(compare_parameter(&p, nullptr, options));
  add_error(model, golden, "rmse", options, rows);
  add_error(model, golden, "heldout", options, rows);
  if (is_unfinished(model) && !is_unfinished(golden)) {
    GoldenRow row{"", 0, "converged", "1", 0, 1};
    row.verdict = GoldenVerdict::kDiffers;
    row.why = "the fit was ended before it converged, that of the golden model was not";
    rows.push_back(row);
  }
  return rows;
}

const char* golden_verdict_name(GoldenVerdict verdict) {
  switch (verdict) {
    case GoldenVerdict::kSame:
      return "same";
    case GoldenVerdict::kDiffers:
      return "differs";
    case GoldenVerdict::kNew:
      return "new";
    default:
      return "gone";
  }
}

}  // namespace hapsim
