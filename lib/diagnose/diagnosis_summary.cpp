#include "diagnose/diagnosis_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "base/counted.h"
#include "base/shell_words.h"
#include "diagnose/wording.h"

namespace hapsim {
namespace {

std::string joined(const std::vector<std::string>& words, const char* between) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : between) + word;
  return text;
}

std::vector<std::string> named(const Diagnosis& d, Verdict verdict) {
  std::vector<std::string> names;
  for (const Finding& f : d.findings)
    if (f.verdict == verdict) names.push_back(f.effect);
  return names;
}

std::string verdict_words(const Diagnosis& d) {
  switch (d.verdict) {
    case ModelVerdict::kComplete:
      return "complete: nothing is missing that these data could show";
    case ModelVerdict::kIncomplete:
      return "incomplete: something is missing";
    case ModelVerdict::kAmbiguous:
      return "ambiguous: more than one effect would do";
    default:
      return verdict_name(d.verdict) +
             (d.left.noise_alone() && !d.torque.explained()
                  ? ": the forces are accounted for, the tool's torques are not"
              : d.left.noise_alone() && !d.marker.explained()
                  ? ": the forces are accounted for, the marked points are not"
                  : ": no known effect takes the error away");
  }
}

std::string label_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::kMissing:
      return "MISSING";
    case Verdict::kIndistinguishable:
      return "ONE OF";
    default:
      return "POSSIBLE";
  }
}

std::string chance_words(const Finding& f) {
  const std::string alarm =
      f.p_value < 1e-3 ? "false alarm p < 0.001" : fmt::format("false alarm p = {:.2g}", f.p_value);
  return std::isfinite(f.probability)
             ? fmt::format("{:.0f} % likely, {}", 100 * f.probability, alarm)
             : alarm;
}

std::string change(const ForceError& before, const ForceError& after) {
  return fmt::format("{:.3g} -> {:.3g} N", before.told(), after.told());
}

// What is unseen: positions, presses, or the rest of the presses.
std::string unseen_of(const Diagnosis& d, const Finding& f) {
  return f.by_presses || d.held_out_by.empty() ? "presses" : d.held_out_by;
}

SummaryItem item_of(const Diagnosis& d, const Finding& f, bool brief) {
  SummaryItem item{label_of(f.verdict), f.effect, chance_words(f), {}};
  std::string errors = "error " + change(f.rmse_now, f.rmse_after);
  if (std::isfinite(f.held_out_after.pooled))
    errors +=
        fmt::format("; unseen {} {}", unseen_of(d, f), change(f.held_out_now, f.held_out_after));
  item.facts.push_back(errors);
  if (!f.fitted.empty()) item.facts.push_back(f.fitted);
  if (brief) return item;
  if (!f.where.empty()) item.facts.push_back(f.where);
  std::string rivals =
      f.confused_with.empty() ? "" : "could also be " + joined(f.confused_with, ", ");
  if (!rivals.empty() && !f.next_measurement.empty()) rivals += "; to tell: " + f.next_measurement;
  if (!rivals.empty()) item.facts.push_back(rivals);
  return item;
}

void add_items(const Diagnosis& d, Summary& s) {
  constexpr std::size_t kInFull = 2, kMostPossible = 3;
  std::vector<const Finding*> shown;
  std::size_t possible = 0;
  // One effect can be missing more than once, as a relaxation by several terms.
  std::map<std::string, int> terms;
  std::map<std::string, const Finding*> last_term;
  for (const Finding& f : d.findings) {
    const bool settled = f.verdict == Verdict::kMissing || f.verdict == Verdict::kIndistinguishable;
    const bool others = f.verdict == Verdict::kAbsent || f.verdict == Verdict::kNotTestable;
    if (!settled && (others || ++possible > kMostPossible)) continue;
    if (f.verdict == Verdict::kMissing && ++terms[f.effect] > 1)
      last_term[f.effect] = &f;
    else
      shown.push_back(&f);
  }
  for (const Finding* f : shown) {
    s.items.push_back(item_of(d, *f, shown.size() > kInFull || f->verdict == Verdict::kPossible));
    if (f->verdict != Verdict::kMissing || terms[f->effect] == 1) continue;
    s.items.back().name += fmt::format(", {} terms", terms[f->effect]);
    s.items.back().facts.push_back(
        fmt::format("with all of its terms {:.3g} N", last_term[f->effect]->rmse_after.told()));
  }
  if (possible > kMostPossible)
    s.notes.push_back(possible == kMostPossible + 1
                          ? "1 more is possible"
                          : fmt::format("{} more are possible", possible - kMostPossible));
}

// What the verdict's own words say beyond what stands on the screen already.
std::string beyond_names(const Diagnosis& d) {
  const std::string told = d.verdict == ModelVerdict::kComplete
                               ? kNothingMissing
                               : "missing: " + joined(named(d, Verdict::kMissing), ", then ") + ".";
  if (d.explanation.rfind(told, 0) != 0) return d.explanation;
  const std::size_t begin = d.explanation.find_first_not_of(' ', told.size());
  return begin == std::string::npos ? "" : d.explanation.substr(begin);
}

}  // namespace

Summary diagnosis_summary(const Diagnosis& d, const DiagnosedFiles& files,
                          const std::string& plan) {
  Summary s;
  s.mark = d.verdict == ModelVerdict::kComplete    ? Summary::Mark::kGood
           : d.verdict == ModelVerdict::kAmbiguous ? Summary::Mark::kOpen
                                                   : Summary::Mark::kBad;
  s.verdict = files.recording + ": " + verdict_words(d);
  const double ratio = d.rmse.told() / d.noise;
  s.size = fmt::format("error {:.3g} N = {} x noise", d.rmse.told(),
                       ratio < 100 ? fmt::format("{:.2g}", ratio) : fmt::format("{:.0f}", ratio));
  add_items(d, s);
  if (const std::string more = beyond_names(d); !more.empty())
    s.notes.insert(s.notes.begin(), more);
  if (const std::string shape = shape_words(d); !shape.empty()) s.notes.push_back(shape);
  const std::size_t absent = named(d, Verdict::kAbsent).size();
  const std::vector<std::string> untestable = named(d, Verdict::kNotTestable);
  std::string tested =
      fmt::format("{} tested and not needed", counted(absent, "effect", "effects"));
  if (!untestable.empty())
    tested += fmt::format("; {} not testable: {}", untestable.size(), joined(untestable, ", "));
  s.notes.push_back(tested);
  s.notes.push_back("No recording tells the sensor's gain from E: check it with a weight.");
  s.next = next_step(d, files, plan);
  s.details = "All effects: -v" + (files.output.empty() ? ", or a file given by -o"
                                                        : ", or " + shell_quoted(files.output));
  return s;
}

}  // namespace hapsim
