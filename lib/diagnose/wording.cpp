#include "diagnose/wording.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "effects/catalogue.h"
#include "experiment/learned_curves.h"
#include "fit/learned_field.h"
#include "model/interval.h"
#include "model/model_edit.h"
#include "recording/ceiling.h"

namespace hapsim {
namespace {

constexpr double kByChance = 0.5;  // this often errors of random sign lose as much

// Where a field is stiffest and softest, of the places that it was learned from.
std::string extremes_of(const PlaceField& field) {
  std::vector<double> log_factor;
  for (const Vec3& p : field.place) log_factor.push_back(field.at(p)[0]);
  const auto at = [&](auto which) {
    const Vec3& p = field.place[static_cast<std::size_t>(which - log_factor.begin())];
    return fmt::format("({:.0f}, {:.0f}) mm", 1e3 * p.x(), 1e3 * p.y());
  };
  const auto [softest, stiffest] = std::minmax_element(log_factor.begin(), log_factor.end());
  return fmt::format("stiffest near {}; softest near {}; ratio {:.2g}", at(stiffest), at(softest),
                     std::exp(*stiffest - *softest));
}

}  // namespace

std::string describe_where(const Candidate& candidate) {
  const EffectCard& card = candidate.effect->card();
  if (card.is_field) return extremes_of(place_field(candidate.fitted.model));
  if (!card.is_map) return card.signature;
  const MaterialSpec material = material_of(candidate.fitted.model);
  const auto stiffest = std::max_element(material.modulus.begin(), material.modulus.end());
  const auto softest = std::min_element(material.modulus.begin(), material.modulus.end());
  const auto places = [&](long region) {
    std::string text;
    int named = 0, all = 0;
    for (std::size_t k = 0; k < material.key_point.size(); ++k) {
      if (material.key_region[k] != region) continue;
      ++all;
      if (named == 3) continue;
      text += fmt::format("{}({:.0f}, {:.0f})", named++ > 0 ? " " : "",
                          1e3 * material.key_point[k].x(), 1e3 * material.key_point[k].y());
    }
    return fmt::format("{} mm{}", text,
                       all > named ? fmt::format(" and {} more", all - named) : "");
  };
  return fmt::format("stiffest near {}; softest near {}; ratio {:.2g}",
                     places(stiffest - material.modulus.begin()),
                     places(softest - material.modulus.begin()), *stiffest / *softest);
}

namespace {

// The places and reach of a field, and what the depth does where that is not what the model says.
std::string field_words(const PlaceField& field) {
  constexpr double kPlain = 0.05;  // a tenth of the power between a disc's law and a ball's
  const auto kernel = [](const PlaceField::Kernel& k) { return k.share > 0.5 ? k.fine : k.range; };
  std::string text = fmt::format("{} places, alike over {:.2g} mm", field.place.size(),
                                 1e3 * kernel(field.factor));
  double low = field.mean_power, high = field.mean_power;
  for (const Vec3& p : field.place) {
    low = std::min(low, field.at(p)[1]);
    high = std::max(high, field.at(p)[1]);
  }
  if (std::max(std::abs(low), std::abs(high)) < kPlain) return text;
  return text + fmt::format(
                    "; with depth the force grows otherwise than the model says, by a "
                    "further power of {:+.2f} ({:+.2f} to {:+.2f} by place)",
                    field.mean_power, low, high);
}

// A map's regions with their moduli, or a field's places.
std::string map_words(const Candidate& candidate) {
  if (candidate.effect->card().is_field) return field_words(place_field(candidate.fitted.model));
  const MaterialSpec material = material_of(candidate.fitted.model);
  const auto [least, most] = std::minmax_element(material.modulus.begin(), material.modulus.end());
  return fmt::format("{}, E from {:.3g} to {:.3g} Pa",
                     candidate.every_site ? "it changes from place to place"
                                          : fmt::format("{} regions", material.modulus.size()),
                     *least, *most);
}

std::string curves_words(const Model& model, const std::string& effect) {
  std::string text;
  for (const LearnedCurveBand& curve : learned_curves(model))
    if (curve.effect == effect) text += (text.empty() ? "" : "; ") + curve_words(curve);
  return text;
}

double identity_of(const EffectCard& card, const std::string& parameter) {
  for (const ParameterCard& p : card.parameters)
    if (p.name == parameter) return p.identity;
  return 0;  // of a further term
}

// That it would have to be infinite to do nothing: no size of it is small.
bool ends_nowhere(const ParameterCard& p) {
  return p.logarithmic && p.identity >= p.upper;
}

// Such a parameter where it does nothing, as the end of an axis that was never reached.
bool does_nothing(const EffectCard& card, const Parameter& row) {
  return std::any_of(card.parameters.begin(), card.parameters.end(), [&](const ParameterCard& p) {
    return p.name == row.name && ends_nowhere(p) && row.value >= p.identity;
  });
}

std::string values_words(const std::vector<FittedValue>& values, bool solved) {
  constexpr std::size_t kMost = 6;
  bool uneven = false;
  std::string text;
  for (std::size_t k = 0; k < std::min(kMost, values.size()); ++k)
    text += fmt::format("{}{} = {}", k == 0 ? "" : "; ", values[k].name,
                        with_interval(values[k].value, values[k].unit, values[k].std_error,
                                      values[k].interval, values[k].logarithmic, 3, 1));
  for (const FittedValue& v : values)
    uneven = uneven || tells_interval(v.value, v.std_error, v.logarithmic);
  // Trials are not profiled, which costs as much as all of them.
  return solved && uneven ? text + ", by the curvature alone" : text;
}

// The smallest size is that about the fitted value. Where this lies far from the one that does
// nothing and the effect is not there all the same, as a friction that nothing reaches, it says
// nothing of a smaller effect.
std::string shows_words(const Finding& f) {
  constexpr double kFar = 10;  // such sizes
  const FittedValue& least = f.smallest;
  if (!std::isfinite(least.value)) return "";
  if (f.verdict == Verdict::kAbsent && !f.values.empty() &&
      std::abs(f.values.front().value - least.identity) > kFar * least.value)
    return "";
  const std::string size = with_interval(least.value, least.unit, std::nan(""), {}, false, 3, 1);
  return fmt::format("would show from {} = {}{}", least.name,
                     least.identity == 0 ? "" : fmt::format("{:g} ± ", least.identity), size);
}

}  // namespace

void describe_fit(const Candidate& candidate, const Measured& measured, const Dataset& dataset,
                  Finding& finding) {
  finding.evidence =
      fmt::format("takes away {:.0f} % of the squared misfit beyond noise{}", 100 * finding.share,
                  finding.share > 0.005 && finding.p_value > kByChance ? ", as chance would" : "");
  const EffectCard& card = candidate.effect->card();
  if (card.needs_ceiling)
    finding.evidence += "; " + ceiling_words(find_ceilings(dataset.recording.f));
  if (card.is_map || card.is_field) {
    finding.fitted = map_words(candidate);
    return;
  }
  const ParameterCard& first = card.parameters.front();
  const ParameterState shown = first.fixed ? ParameterState::kFixed : ParameterState::kFree;
  for (const Parameter& p : candidate.fitted.model.parameters)
    if (p.effect == card.name && p.state == shown && !does_nothing(card, p))
      finding.values.push_back({p.name, p.unit, p.value, p.std_error, identity_of(card, p.name),
                                interval95(p), is_logarithmic(p)});
  finding.fitted = card.learned ? curves_words(candidate.fitted.model, card.name)
                                : values_words(finding.values, card.solved);
  if (!first.fixed && !ends_nowhere(first) && measured.smallest_seen > 0 &&
      std::isfinite(measured.smallest_seen))
    finding.smallest = {first.name, first.unit, measured.smallest_seen, std::nan(""),
                        first.identity};
}

std::string evidence_words(const Finding& f) {
  std::string text = f.evidence;
  if (f.verdict != Verdict::kAbsent && !f.fitted.empty()) text += "; " + f.fitted;
  if (const std::string shows = shows_words(f); !shows.empty()) text += "; " + shows;
  return text;
}

std::string shape_words(const Diagnosis& d) {
  const std::string words = d.shape.words();
  if (words.empty() || !d.shape_in_doubt) return words;
  return words +
         "; the forces do not follow such a move, so the scan is in doubt (surface, unit, frame), "
         "and so is what differs by place";
}

namespace {

// A body's effect that is told from the same gain at all positions is one of many causes.
std::string set_up_words(const Diagnosis& d) {
  const bool of_body = std::any_of(d.findings.begin(), d.findings.end(), [](const Finding& f) {
    return (f.verdict == Verdict::kMissing || f.verdict == Verdict::kIndistinguishable) &&
           require_effect(f.effect).card().solved;
  });
  if (d.kind_now != kSetUp || !of_body) return "";
  return " The model misses the same gain at all positions, and so it would for a wrong tool "
         "radius, "
         "an arm that bends or a scale that is wrong: check these before the body.";
}

// A curve of no law is told as what it is; a named effect that it looks like has not its form.
std::string learned_words(const Diagnosis& d) {
  std::string text;
  for (const Finding& f : d.findings) {
    const EffectCard& card = require_effect(f.effect).card();
    if (f.verdict != Verdict::kMissing || !card.learned) continue;
    text += fmt::format(" {} names no cause: {} ({}).", f.effect, card.signature, f.fitted);
    for (const Finding& other : d.findings)
      if (other.curve == f.effect)
        text +=
            fmt::format(" {} alone has not its form, and is no name of the cause.", other.effect);
  }
  return text;
}

// What passed and is not stood by.
std::string doubted_words(const Diagnosis& d) {
  std::string names;
  for (const Finding& f : d.findings)
    if (f.doubted && f.curve.empty() && names.find(f.effect) == std::string::npos)
      names += (names.empty() ? "" : ", ") + f.effect;
  return names.empty() ? ""
                       : " " + names +
                             " would take a part of it away, but less than is left, or not with "
                             "one size in the whole recording: that is no name of the cause.";
}

}  // namespace

namespace {

std::string describe_verdict(const Diagnosis& d) {
  std::string missing, rivals;
  for (const Finding& f : d.findings) {
    if (f.verdict == Verdict::kMissing) missing += (missing.empty() ? "" : ", then ") + f.effect;
    if (f.verdict == Verdict::kIndistinguishable)
      rivals += (rivals.empty() ? "" : " or ") + f.effect;
  }
  const std::string left = d.left.noise_alone() ? "" : " Beside that " + d.left.words;
  switch (d.verdict) {
    case ModelVerdict::kIncomplete:
      return "missing: " + missing + "." + learned_words(d) + set_up_words(d) + left +
             doubted_words(d);
    case ModelVerdict::kAmbiguous:
      return (missing.empty() ? "" : "missing: " + missing + "; beyond that ") +
             "the data cannot tell " + rivals + " apart; see the next measurement." +
             set_up_words(d) + (left.empty() ? "" : " None of them explains all: " + d.left.words);
    case ModelVerdict::kUnexplained:
      return "none of the effects it knows explains the error: " + d.left.words +
             (d.stand_ins.kind.empty() ? doubted_words(d) : stand_in_words(d.stand_ins));
    default:
      return kNothingMissing +
             (d.left.error < kLikeNoise
                  ? ""
                  : fmt::format(
                        " What is left, {:.2g} x noise, is within the {:.1f} % that mesh and "
                        "shape may err by.",
                        d.left.error, 100 * d.floor));
  }
}

}  // namespace

std::string step_words(const ImprovementStep& step, double noise) {
  const double rmse = step.fitted.error.told(), held_out = step.held_out.told();
  return fmt::format("{}: error {:.4g} N{}, {:.3g} x noise", effects_label(step.fitted.model), rmse,
                     std::isnan(held_out) ? "" : fmt::format(", unseen {:.4g} N", held_out),
                     rmse / noise);
}

std::string end_words(const Improvement& improvement) {
  if (!improvement.refused.empty())
    return improvement.refused +
           (improvement.by_rest
                ? " was called missing but does not foretell the " + improvement.unseen +
                      ": left out"
                : " was called missing but does not help on unseen presses: left out");
  const std::string by =
      improvement.unseen.empty() ? "" : " (judged on unseen data: " + improvement.unseen + ")";
  return verdict_name(improvement.last.verdict) + by + ": " + improvement.last.explanation;
}

namespace {

std::string converter_words(const Noise& noise) {
  if (noise.step == 0) return "";
  return fmt::format(
      " Forces are rounded to steps of {:.3g} N (quantisation), most of the {:.2g} N that counts "
      "as noise: what is smaller these data cannot tell.",
      noise.step, noise.value);
}

}  // namespace

std::string one_kind_words(const Diagnosis& d) {
  if (d.one_kind.effects.empty()) return "";
  if (d.one_kind.effects.size() == 2)
    return fmt::format(
        " Two of these are of one kind ({}): both may act, or one cause of that kind which has no "
        "name here.",
        d.one_kind.kind);
  return fmt::format(
      " So many of one kind ({}) are rather one cause of that kind which has no name here: "
      "together they foretell, but none of the names is sure.",
      d.one_kind.kind);
}

std::string explain_verdict(const Diagnosis& d, const Noise& noise) {
  // What else than forces is not explained, if it is that alone.
  const bool forces_told = d.verdict == ModelVerdict::kUnexplained && d.left.noise_alone();
  const bool torques_alone = forces_told && !d.torque.explained();
  const bool points_alone = forces_told && !torques_alone;
  std::string words = torques_alone  ? d.torque.words
                      : points_alone ? d.marker.words
                                     : describe_verdict(d);
  if (!torques_alone && !d.torque.words.empty()) words += " " + d.torque.words;
  if (!points_alone && !d.marker.words.empty()) words += " " + d.marker.words;
  return words + converter_words(noise) + misfit_words(d.misfit) + one_kind_words(d);
}

}  // namespace hapsim
