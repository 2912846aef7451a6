// hs-diagnose: which physical effect the model lacks.
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "common_options.h"
#include "diagnose/diagnose.h"
#include "experiment/plausible.h"
#include "io/csv.h"
#include "model/model_edit.h"
#include "plan/press_plan.h"
#include "report/junit.h"

namespace hapsim {
namespace {

ToolSpec specification() {
  ToolSpec spec;
  spec.name = "hs-diagnose";
  spec.summary = "name the physical effect that a model lacks";
  spec.input = "recording CSV (press,t,x,y,z,ux,uy,uz,fx,fy,fz)";
  spec.description = {
      "Layers, inclusions, anisotropy, supports and regions are solved by finite elements on the "
      "coarser of a position's two meshes, and only where some position asks for "
      "another stiffness than the model's; hs-identify takes the finer one.",
      "Force noise and a gain error by position for mesh and scanned shape (--floor) are taken "
      "into account, so a model is not blamed for them.",
      "Two effects that do equally well are rivals, unless both together leave nothing but noise "
      "and mesh where each alone leaves plainly more: then both are there.",
      "Contact points that lie off the body's surface by more than a hundredth of its least extent "
      "are told. Where the forces do not follow the move of the body that would explain them "
      "(shift), the shape is in doubt: the gain error allows for it, and an effect that a wrong "
      "shape looks like is not named alone, but as confused with `shape`.",
      "What acts at one position only, an inclusion or a region, cannot foretell unseen positions; "
      "where it leaves nothing but noise it is judged by unseen presses of the positions, and the "
      "evidence says so.",
      "A common gain of the force sensor cannot be told from Young's modulus by any recording: "
      "check the sensor with a calibration weight."};
  const std::vector<std::string> gates = gates_in_words();
  spec.description.insert(spec.description.begin(), gates.begin(), gates.end());
  spec.options = experiment_flags();
  const std::vector<Option> own{
      {.flag = "--model",
       .kind = OptionKind::kFile,
       .value = "FILE",
       .help = "Model from hs-identify.",
       .group = "Input",
       .required = true},
      {.flag = "--check",
       .kind = OptionKind::kSwitch,
       .help = "Exit code 1 when the model is not complete.",
       .group = "Output"},
      {.flag = "--json",
       .kind = OptionKind::kFile,
       .value = "FILE",
       .help = "Also writes the diagnosis as JSON.",
       .group = "Output",
       .writes = {"json"}},
      {.flag = "--junit",
       .kind = OptionKind::kFile,
       .value = "FILE",
       .help = "Also writes the verdict as JUnit's XML, a test each effect that could be tested.",
       .group = "Output",
       .writes = {"xml"}},
      {.flag = "--plan",
       .kind = OptionKind::kFile,
       .value = "FILE",
       .help = "Writes the motion (CSV, without forces) of the next presses to record: those that "
               "best tell indistinguishable effects apart, or determine the least certain "
               "parameter; at pressed positions, and between them where the effects differ there.",
       .group = "Output",
       .writes = kTableExtensions},
      {.flag = "--plan-presses",
       .kind = OptionKind::kInteger,
       .value = "N",
       .help = "Number of presses of the plan.",
       .group = "Output",
       .default_text = "3",
       .minimum = 1,
       .maximum = 100},
      {.flag = "--folds",
       .kind = OptionKind::kInteger,
       .value = "N",
       .help = "Parts in which positions are held out.",
       .group = "Diagnosis",
       .default_text = "6",
       .minimum = 2,
       .maximum = 1000},
      {.flag = "--flips",
       .kind = OptionKind::kInteger,
       .value = "N",
       .help = "Random sign flips of presses behind the false-alarm chance.",
       .group = "Diagnosis",
       .default_text = "999",
       .minimum = 99,
       .maximum = 1000000},
      {.flag = "--seed",
       .kind = OptionKind::kInteger,
       .value = "N",
       .help = "Seed of the flips.",
       .group = "Diagnosis",
       .default_text = "1",
       .minimum = 0}};
  spec.options.insert(spec.options.end(), own.begin(), own.end());
  spec.tables = {
      {"Diagnosis (output)",
       {{"rank", "0: the model as a whole; then the effects, best first"},
        {"effect", "name in the catalogue; 'model' in the first row"},
        {"verdict",
         "missing, possible, indistinguishable, absent, not testable; of the model: "
         "complete, incomplete, ambiguous, unexplained"},
        {"rmse_now, rmse_after", "error without and with the effect [N]"},
        {"heldout_now, heldout_after",
         "the same on positions left out of the fit [N]; after only for effects that "
         "pass the other tests"},
        {"p_value", "chance of a false alarm, all effects tried counted"},
        {"confused_with", "effects that do as well, separated by spaces; `shape`: a wrong body"},
        {"where", "where and when it acts"},
        {"evidence", "share of the misfit, fitted size, smallest size that would show"},
        {"next_measurement", "what would tell it from its rivals"},
        {"command", "the command that adds it"}}}};
  spec.examples = {
      {"hs-diagnose data.csv --body body.ply --model m0.csv -o effects.csv", "What is missing."},
      {"hs-diagnose data.csv --body body.ply --model m0.csv --plan next.csv -o effects.csv",
       "And what to measure next."},
      {"hs-diagnose data.csv --body body.ply --model m0.csv --check -q", "A check in CI."}};
  spec.see_also = {"hs-identify(1)", "hs-compare(1)", "hs-effects(7)"};
  return spec;
}

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : " ") + name;
  return text;
}

std::string add_command(const Arguments& a, const Finding& f) {
  return fmt::format("hs-identify {} --body {} --model {} --add {}{} -o better.csv", a.input(),
                     a.text("--body"), a.text("--model"), f.effect,
                     f.every_site ? " --regions sites" : "");
}

void write_table(std::ostream& out, const Arguments& arguments, const Diagnosis& d) {
  Metadata metadata;
  metadata.set("force_noise", format_number(d.noise));
  metadata.set("mesh_uncertainty", format_number(d.mesh_uncertainty));
  metadata.set("floor", format_number(d.floor));
  metadata.set("shape_error", format_number(d.shape.before));
  metadata.set("seed", arguments.text("--seed"));
  CsvWriter csv(
      out, metadata,
      {"rank", "effect", "verdict", "rmse_now", "rmse_after", "heldout_now", "heldout_after",
       "p_value", "confused_with", "where", "evidence", "next_measurement", "command"});
  const auto number = [](double v) { return std::isfinite(v) ? fmt::format("{:.6g}", v) : ""; };
  csv.row({"0", "model", verdict_name(d.verdict), number(d.rmse.told()), number(d.rmse_end.told()),
           number(d.held_out.told()), number(d.held_out_end.told()), "", "", "", d.explanation, "",
           ""});
  int rank = 0;
  for (const Finding& f : d.findings) {
    const bool tried = f.verdict != Verdict::kNotTestable;
    const bool add = f.verdict == Verdict::kMissing || f.verdict == Verdict::kIndistinguishable ||
                     f.verdict == Verdict::kPossible;
    const auto value = [&](double v) { return tried ? number(v) : std::string(); };
    csv.row({std::to_string(++rank), f.effect, verdict_name(f.verdict), value(f.rmse_now.told()),
             value(f.rmse_after.told()), value(f.held_out_now.told()),
             value(f.held_out_after.told()), value(f.p_value), joined(f.confused_with), f.where,
             f.evidence, f.next_measurement, add ? add_command(arguments, f) : ""});
  }
}

nlohmann::json as_json(const Arguments& arguments, const Diagnosis& d) {
  nlohmann::json j;
  j["verdict"] = verdict_name(d.verdict);
  j["explanation"] = d.explanation;
  j["force_noise"] = d.noise;
  j["mesh_uncertainty"] = d.mesh_uncertainty;
  j["floor"] = d.floor;
  j["shape_error"] = d.shape.before;
  j["shape_error_moved"] = d.shape.after;
  j["shape_in_doubt"] = d.shape_in_doubt;
  j["force_rms"] = d.force_rms.told();
  j["rmse"] = d.rmse.told();
  j["heldout"] = d.held_out.told();
  j["rmse_with_missing_effects"] = d.rmse_end.told();
  j["heldout_with_missing_effects"] = d.held_out_end.told();
  j["effects"] = nlohmann::json::array();
  for (const Finding& f : d.findings)
    j["effects"].push_back({{"effect", f.effect},
                            {"verdict", verdict_name(f.verdict)},
                            {"rmse_now", f.rmse_now.told()},
                            {"rmse_after", f.rmse_after.told()},
                            {"heldout_now", f.held_out_now.told()},
                            {"heldout_after", f.held_out_after.told()},
                            {"p_value", f.p_value},
                            {"criterion_gain", f.criterion_gain},
                            {"share", f.share},
                            {"confused_with", f.confused_with},
                            {"where", f.where},
                            {"evidence", f.evidence},
                            {"next_measurement", f.next_measurement},
                            {"command", add_command(arguments, f)}});
  return j;
}

void report(const Arguments& arguments, const Diagnosis& d) {
  const auto line = [&](const std::string& text) { say(arguments, "hs-diagnose", text); };
  line(fmt::format("{}: {}", verdict_name(d.verdict), d.explanation));
  line(fmt::format(
      "typical error {:.3g} N = {:.3g} % of the force's rms; sensor noise {:.3g} N "
      "({}); mesh uncertainty {:.1f} %, floor {:.1f} %",
      d.rmse.told(), 100 * d.rmse.told() / d.force_rms.told(), d.noise,
      d.noise_measured ? "measured" : "declared", 100 * d.mesh_uncertainty, 100 * d.floor));
  if (const std::string shape = d.shape.words(); !shape.empty())
    line(shape + (d.shape_in_doubt
                      ? "; the forces do not follow such a move, so the scan is in doubt "
                        "(surface, unit, frame), and so is what differs by place"
                      : ""));
  for (const Finding& f : d.findings) {
    if (f.verdict == Verdict::kNotTestable) {
      line(fmt::format("  {:<13} not testable: {}", f.effect, f.evidence));
      continue;
    }
    const std::string unseen = std::isfinite(f.held_out_after.pooled)
                                   ? fmt::format(", unseen {:.3g} -> {:.3g} N",
                                                 f.held_out_now.told(), f.held_out_after.told())
                                   : "";
    line(fmt::format("  {:<13} {:<17} error {:.3g} -> {:.3g} N{}, false alarm {:.3f}; {}", f.effect,
                     verdict_name(f.verdict), f.rmse_now.told(), f.rmse_after.told(), unseen,
                     f.p_value, f.evidence));
    if (f.verdict == Verdict::kMissing || f.verdict == Verdict::kIndistinguishable) {
      if (!f.confused_with.empty())
        line("                may be confused with " + joined(f.confused_with) +
             "; to tell: " + f.next_measurement);
      line("                add it: " + add_command(arguments, f));
    }
  }
  line(
      "never testable from a recording: a common gain of the force sensor (it looks like E): check "
      "with a calibration weight");
}

void write_plan(const Arguments& arguments, const Diagnosis& d, const Experiment& w) {
  const MeasurementPlan plan =
      plan_presses(d.rivals, w, static_cast<std::size_t>(arguments.integer("--plan-presses")));
  Output output(arguments.text("--plan"));
  write_recording(output.stream(), plan.motion);
  output.commit();
  const auto line = [&](const std::string& text) { say(arguments, "hs-diagnose", text); };
  if (plan.parameter.empty())
    line(fmt::format("to tell them apart, record {} ({:.3g} standard deviations of the noise):",
                     arguments.text("--plan"), plan.separation));
  else
    line(fmt::format("to know {} better, record {} (its standard error falls to {:.0f} %):",
                     plan.parameter, arguments.text("--plan"), 100 * plan.separation));
  for (const PlannedPress& p : plan.presses)
    line(fmt::format("  at ({:.1f}, {:.1f}, {:.1f}) mm: {}{}", 1e3 * p.position.x(),
                     1e3 * p.position.y(), 1e3 * p.position.z(), p.motion,
                     p.separation > 0 ? fmt::format(" ({:.3g} alone)", p.separation) : ""));
}

void write_verdicts(const std::string& path, const Diagnosis& d) {
  std::vector<JunitCase> cases;
  const bool complete = d.verdict == ModelVerdict::kComplete;
  cases.push_back({"model", complete ? "" : verdict_name(d.verdict) + (": " + d.explanation), ""});
  for (const Finding& f : d.findings) {
    const bool lacking = f.verdict == Verdict::kMissing || f.verdict == Verdict::kIndistinguishable;
    cases.push_back({f.effect, lacking ? verdict_name(f.verdict) + (": " + f.evidence) : "",
                     f.where, f.verdict == Verdict::kNotTestable});
  }
  Output junit(path);
  write_junit(junit.stream(), "hs-diagnose", cases);
  junit.commit();
}

int run(const Arguments& arguments) {
  const Model model = load_model(arguments, "hs-diagnose");
  const TetMesh body = load_body(arguments);
  std::shared_ptr<Progress> progress;
  ExperimentOptions options = experiment_options(arguments, progress);
  options.draft = true;  // many materials are tried; the one that is added is identified finely
  set_poisson_range(model, options);
  Dataset dataset = make_dataset(load_recording(arguments, arguments.input(), true));
  require_presses(dataset);
  const Experiment w = make_experiment({body}, std::move(dataset), options);
  progress.reset();
  DiagnoseOptions diagnose_options;
  diagnose_options.folds = static_cast<int>(arguments.integer("--folds"));
  diagnose_options.flips = static_cast<int>(arguments.integer("--flips"));
  diagnose_options.seed = static_cast<std::uint64_t>(arguments.integer("--seed"));
  const Diagnosis d = diagnose(model, w, w.allowance(), diagnose_options);

  Output output(arguments.output());
  write_table(output.stream(), arguments, d);
  output.commit();
  if (arguments.given("--json")) {
    Output json(arguments.text("--json"));
    json.stream() << as_json(arguments, d).dump(2) << '\n';
    json.commit();
  }
  if (arguments.given("--junit")) write_verdicts(arguments.text("--junit"), d);
  report(arguments, d);
  if (arguments.given("--plan")) write_plan(arguments, d, w);
  const bool failed = arguments.given("--check") && d.verdict != ModelVerdict::kComplete;
  return static_cast<int>(failed ? ExitCode::kCheckFailed : ExitCode::kDone);
}

}  // namespace
}  // namespace hapsim

int main(int argc, char** argv) {
  return hapsim::run_tool(hapsim::specification(), argc, argv, hapsim::run);
}
