// hs-check: is a model still the golden one?
#include <fmt/format.h>

#include <algorithm>

#include "answer.h"
#include "base/error.h"
#include "common_options.h"
#include "model/golden_report.h"
#include "model/golden_summary.h"

namespace hapsim {
namespace flag {
inline constexpr FileFlag golden{"--golden"}, junit{"--junit"};
inline constexpr TextFlag tolerance{"--tolerance"}, worse{"--worse"};
inline constexpr NumberFlag standard_errors{"--standard-errors"};
}  // namespace flag

namespace {

ToolSpec specification() {
  ToolSpec spec;
  spec.name = "hs-check";
  spec.task = Task::kMany;
  spec.summary = "compare a model with a golden one, by tolerance and standard errors";
  spec.input = "model CSV, freshly identified";
  spec.description = {
      "On one machine the same call gives the same bytes. Another compiler or processor changes "
      "the last digits, and a new recording of the same object changes more. A parameter counts "
      "as the same when it differs by no more than its tolerance, or than --standard-errors "
      "times the standard error of the difference, whichever is more; of moduli, times and sizes "
      "that is a factor, as their intervals are. Parameters that only one model has differ, and so "
      "do those that are fixed in one and free in the other. The "
      "errors of the fit and on unseen data (metadata rmse, heldout) may be smaller, but not "
      "larger by more than --worse, nor absent when the golden model has them. A fit that was "
      "ended before it converged differs from one that was not.",
      "Exit code 1 when anything differs, and a line for each that says what."};
  spec.options = {
      {.flag = flag::golden,
       .value = "FILE",
       .help = "The model as it should be.",
       .required = true},
      {.flag = flag::tolerance,
       .value = "LIST",
       .help = "By how much parameters may differ: 2% of the golden value, or in the parameter's "
               "unit; for one alone NAME=, as in 2%,elastic.nu=0.01,tau1=10%.",
       .default_text = "1%",
       .repeatable = true},
      {.flag = flag::standard_errors,
       .value = "K",
       .help = "Differences of up to K standard errors are chance.",
       .default_text = "3",
       .minimum = 0,
       .maximum = 100},
      {.flag = flag::worse,
       .value = "SHARE",
       .help = "By how much rmse and heldout may exceed the golden ones.",
       .default_text = "10%"},
      {.flag = flag::junit,
       .value = "FILE",
       .help = "Also writes JUnit's XML, a test a parameter, for CI servers.",
       .writes = {"xml"}}};
  spec.options.push_back(answer_option());
  spec.tables = {{"Comparison (output)",
                  {{"effect, region, parameter",
                    "as in the models; rmse, heldout and converged without effect"},
                   {"value, golden", "of the two models, in SI units"},
                   {"allowed", "largest difference that counts as the same"},
                   {"verdict", "same, differs, new (not in the golden model) or gone"}}}};
  spec.examples = {
      {"hs-check model.csv --golden golden.csv", "A check in CI."},
      {"hs-identify data.csv --body body.ply | hs-check --golden golden.csv --tolerance 5% -q -o "
       "changes.csv",
       "With the table of all parameters."}};
  spec.see_also = {"hs-identify(1)", "hs-compare(1)", "hs-diagnose(1)", "hs-batch(1)"};
  return spec;
}

GoldenOptions golden_options(const Arguments& arguments) {
  GoldenOptions options;
  options.standard_errors = arguments[flag::standard_errors];
  options.tolerances = {parse_tolerance("1%", flag::tolerance.name)};
  for (const std::string& text : arguments.list(flag::tolerance))
    options.tolerances.push_back(parse_tolerance(text, flag::tolerance.name));
  options.worse = parse_share(arguments[flag::worse], flag::worse.name);
  return options;
}

int run(const Arguments& arguments) {
  const GoldenOptions options = golden_options(arguments);
  Input input(arguments.input()), golden_input(arguments[flag::golden]);
  const Model model = load_model(arguments, "hs-check", input);
  const Model golden = load_model(arguments, "hs-check", golden_input);
  const std::vector<GoldenRow> rows = compare_with_golden(model, golden, options);
  require_named(options.tolerances, rows, flag::tolerance.name);

  Output output(result_file(arguments));
  write_golden(output.stream(), rows);
  if (arguments.given(flag::junit)) {
    Output junit(arguments[flag::junit]);
    write_junit(junit.stream(), "hs-check", golden_cases(rows));
    junit.commit();
  }
  output.commit();
  for (const GoldenRow& row : rows)
    if (!row.why.empty()) tell("hs-check", row.why);
  const bool same = std::all_of(rows.begin(), rows.end(), [](const GoldenRow& row) {
    return row.verdict == GoldenVerdict::kSame;
  });
  tell_answer(arguments, golden_summary(rows, input.name(), arguments[flag::golden]));
  return static_cast<int>(same ? ExitCode::kDone : ExitCode::kCheckFailed);
}

}  // namespace
}  // namespace hapsim

int main(int argc, char** argv) {
  return hapsim::run_tool(hapsim::specification(), argc, argv, hapsim::run);
}
