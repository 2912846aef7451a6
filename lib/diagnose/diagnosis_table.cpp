#include "diagnose/diagnosis_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/shell_words.h"
#include "diagnose/wording.h"
#include "effects/catalogue.h"

namespace hapsim {
namespace {

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : " ") + name;
  return text;
}

// "m0.csv": "m1.csv"; a name without a number: "better.csv".
std::string next_version(const std::string& model) {
  const std::size_t dot = model.rfind('.');
  const std::size_t end = dot == std::string::npos ? model.size() : dot;
  std::size_t begin = end;
  while (begin > 0 && std::isdigit(static_cast<unsigned char>(model[begin - 1])) != 0) --begin;
  if (begin == end || end - begin > 6) return "better.csv";
  return model.substr(0, begin) + std::to_string(std::stoi(model.substr(begin, end - begin)) + 1) +
         model.substr(end);
}

// "a.csv --body body.ply --model m0.csv", as a shell reads it.
std::string inputs(const DiagnosedFiles& files) {
  return fmt::format("{} --body {} --model {}", shell_quoted(files.recording),
                     shell_quoted(files.body), shell_quoted(files.model));
}

std::string add_command(const DiagnosedFiles& files, const std::string& effects, bool every_site) {
  return fmt::format("hs-identify {}{} --add {}{} -o {}", inputs(files), files.flags, effects,
                     every_site ? " --regions sites" : "", shell_quoted(next_version(files.model)));
}

bool may_be_there(const Finding& f) {
  return f.verdict != Verdict::kAbsent && f.verdict != Verdict::kNotTestable;
}

// Not among effects that a press could tell apart.
bool only_shape(const Diagnosis& d) {
  return std::all_of(d.findings.begin(), d.findings.end(), [](const Finding& f) {
    return f.verdict != Verdict::kIndistinguishable ||
           f.confused_with == std::vector<std::string>{"shape"};
  });
}

}  // namespace

std::string add_command(const DiagnosedFiles& files, const Finding& f) {
  return add_command(files, f.effect, f.every_site);
}

std::string next_step(const Diagnosis& d, const DiagnosedFiles& files, const std::string& plan) {
  std::string missing;
  bool every_site = false;
  for (const Finding& f : d.findings) {
    if (f.verdict != Verdict::kMissing) continue;
    missing += (missing.empty() ? "" : ",") + f.effect;
    every_site = every_site || f.every_site;
  }
  const std::string recording = shell_quoted(files.recording), body = shell_quoted(files.body);
  switch (d.verdict) {
    case ModelVerdict::kIncomplete:
      return add_command(files, missing, every_site);
    case ModelVerdict::kAmbiguous:
      if (only_shape(d)) return "scan the body again, or touch it where it is pressed";
      if (!plan.empty()) return "record the presses of " + plan + " and diagnose them as well";
      return fmt::format("hs-diagnose {}{} --plan next.csv", inputs(files), files.flags);
    case ModelVerdict::kComplete:
      return fmt::format("hs-simulate {}{} -o forces.csv", inputs(files), files.flags);
    default:
      return fmt::format(
          "hs-simulate {}{} | hs-compare {} --simulated - --body {}{} --html report.html -o "
          "residuals.csv",
          inputs(files), files.flags, recording, body,
          files.output.empty() ? "" : " --diagnosis " + shell_quoted(files.output));
  }
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
  CsvWriter csv(out, metadata,
                {"rank", "effect", "verdict", "rmse_now", "rmse_after", "heldout_now",
                 "heldout_after", "p_value", "probability", "confused_with", "where", "evidence",
                 "next_measurement", "command"});
  const auto number = [](double v) { return std::isfinite(v) ? fmt::format("{:.6g}", v) : ""; };
  csv.row({"0", "model", verdict_name(d.verdict), number(d.rmse.told()), number(d.rmse_end.told()),
           number(d.held_out.told()), number(d.held_out_end.told()), "", "", "", "", d.explanation,
           "", ""});
  int rank = 0;
  for (const Finding& f : d.findings) {
    const bool tried = f.verdict != Verdict::kNotTestable;
    const auto value = [&](double v) { return tried ? number(v) : std::string(); };
    csv.row({std::to_string(++rank), f.effect, verdict_name(f.verdict), value(f.rmse_now.told()),
             value(f.rmse_after.told()), value(f.held_out_now.told()),
             value(f.held_out_after.told()), value(f.p_value), value(f.probability),
             joined(f.confused_with), f.where, evidence_words(f), f.next_measurement,
             may_be_there(f) ? add_command(files, f) : ""});
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

namespace {

// What is not known, as of an effect that could not be tested, is null.
nlohmann::json finding_json(const Finding& f, const DiagnosedFiles& files) {
  const bool tested = f.verdict != Verdict::kNotTestable;
  const auto number = [&](double v) { return tested ? nlohmann::json(v) : nlohmann::json(); };
  const Effect* const effect = find_effect(f.effect);
  nlohmann::json j{{"effect", f.effect},
                   {"kinds", effect ? effect->card().kinds : std::vector<std::string>{}},
                   {"verdict", verdict_name(f.verdict)},
                   {"rmse_now", number(f.rmse_now.told())},
                   {"rmse_after", number(f.rmse_after.told())},
                   {"heldout_now", number(f.held_out_now.told())},
                   {"heldout_after", number(f.held_out_after.told())},
                   {"p_value", number(f.p_value)},
                   {"probability", number(f.probability)},
                   {"criterion_gain", number(f.criterion_gain)},
                   {"share", number(f.share)},
                   {"confused_with", f.confused_with},
                   {"where", f.where},
                   {"evidence", evidence_words(f)},
                   {"next_measurement", f.next_measurement},
                   {"values", nlohmann::json::array()},
                   {"smallest_seen", nlohmann::json()},
                   {"command", nlohmann::json()}};
  if (may_be_there(f)) {
    j["command"] = add_command(files, f);
    for (const FittedValue& v : f.values)
      j["values"].push_back({{"parameter", v.name},
                             {"value", v.value},
                             {"std_error", v.std_error},
                             {"unit", v.unit},
                             {"identity", v.identity}});
  }
  if (tested && std::isfinite(f.smallest.value))
    j["smallest_seen"] = {{"parameter", f.smallest.name},
                          {"size", f.smallest.value},
                          {"unit", f.smallest.unit},
                          {"identity", f.smallest.identity}};
  return j;
}

nlohmann::json kinds_json(const std::vector<LeftKind>& kinds) {
  nlohmann::json j = nlohmann::json::array();
  for (const LeftKind& k : kinds)
    j.push_back({{"kind", k.kind}, {"share", k.share}, {"alike", k.alike}});
  return j;
}

}  // namespace

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
  j["kind_now"] = d.kind_now;
  j["left"] = {{"kind", d.left.kind},
               {"error_over_noise", d.left.error},
               {"strain", d.left.strain},
               {"common", d.left.common},
               {"kinds", kinds_json(d.left.kinds)}};
  j["misfit"] = kinds_json(d.misfit);
  j["one_kind"] = d.one_kind.kind;
  j["stand_ins"] = {{"kind", d.stand_ins.kind},
                    {"effects", d.stand_ins.effects},
                    {"law", d.stand_ins.law},
                    {"named", d.stand_ins.named}};
  j["odd_presses"] = d.odd_presses;
  j["effects"] = nlohmann::json::array();
  for (const Finding& f : d.findings) j["effects"].push_back(finding_json(f, files));
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
  if (const std::string shape = shape_words(d); !shape.empty()) line(shape);
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
                     f.p_value, evidence_words(f)));
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
    cases.push_back({f.effect, lacking ? verdict_name(f.verdict) + (": " + evidence_words(f)) : "",
                     f.where, f.verdict == Verdict::kNotTestable});
  }
  return cases;
}

}  // namespace hapsim
