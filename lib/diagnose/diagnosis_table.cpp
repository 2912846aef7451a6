#include "diagnose/diagnosis_table.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/error.h"

namespace hapsim {
namespace {

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : " ") + name;
  return text;
}

}  // namespace

std::string add_command(const DiagnosedFiles& files, const Finding& f) {
  return fmt::format("hs-identify {} --body {} --model {} --add {}{} -o better.csv",
                     files.recording, files.body, files.model, f.effect,
                     f.every_site ? " --regions sites" : "");
}

void write_diagnosis(std::ostream& out, const Diagnosis& d, const DiagnosedFiles& files,
                     const std::string& seed) {
  Metadata metadata;
  metadata.set("force_noise", format_number(d.noise));
  metadata.set("mesh_uncertainty", format_number(d.mesh_uncertainty));
  metadata.set("floor", format_number(d.floor));
  metadata.set("shape_error", format_number(d.shape.before));
  metadata.set("seed", seed);
  if (!d.held_out_by.empty()) metadata.set("heldout_by", d.held_out_by);
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
             f.evidence, f.next_measurement, add ? add_command(files, f) : ""});
  }
}

std::vector<std::string> missing_effects(const CsvTable& table) {
  const int effect = table.find("effect"), verdict = table.find("verdict");
  if (effect < 0 || verdict < 0)
    fail_input(table.name, "this is no diagnosis: it has no columns effect and verdict",
               "give a file that hs-diagnose wrote");
  std::vector<std::string> missing;
  for (std::size_t row = 0; row < table.rows(); ++row)
    if (table.columns[verdict][row] == "missing") missing.push_back(table.columns[effect][row]);
  return missing;
}

std::string diagnosis_json(const Diagnosis& d, const DiagnosedFiles& files) {
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
                            {"command", add_command(files, f)}});
  return j.dump(2) + "\n";
}

std::vector<std::string> diagnosis_lines(const Diagnosis& d, const DiagnosedFiles& files) {
  std::vector<std::string> lines;
  const auto line = [&](const std::string& text) { lines.push_back(text); };
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
      line("                add it: " + add_command(files, f));
    }
  }
  line(
      "never testable from a recording: a common gain of the force sensor (it looks like E): check "
      "with a calibration weight");
  return lines;
}

std::vector<JunitCase> diagnosis_cases(const Diagnosis& d) {
  std::vector<JunitCase> cases;
  const bool complete = d.verdict == ModelVerdict::kComplete;
  cases.push_back({"model", complete ? "" : verdict_name(d.verdict) + (": " + d.explanation), ""});
  for (const Finding& f : d.findings) {
    const bool lacking = f.verdict == Verdict::kMissing || f.verdict == Verdict::kIndistinguishable;
    cases.push_back({f.effect, lacking ? verdict_name(f.verdict) + (": " + f.evidence) : "",
                     f.where, f.verdict == Verdict::kNotTestable});
  }
  return cases;
}

}  // namespace hapsim
