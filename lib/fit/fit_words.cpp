#include "fit/fit_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/counted.h"
#include "effects/catalogue.h"
#include "effects/plates_law.h"
#include "estimate/identifiability.h"
#include "experiment/plausible.h"
#include "fit/constraints.h"
#include "fit/marker_words.h"
#include "model/body_parameters.h"
#include "model/interval.h"
#include "model/model_edit.h"

namespace hapsim {
namespace {

// " of 2 bodies by 3 tools"; empty for one of each.
std::string setups_in_words(const Dataset& dataset) {
  std::string text;
  if (dataset.bodies() > 1) text += fmt::format(" of {} bodies", dataset.bodies());
  if (dataset.tools() > 1) text += fmt::format(" by {} tools", dataset.tools());
  return text;
}

}  // namespace

std::vector<std::string> hardly_known(const Model& model) {
  // A standard error of half the modulus lets zero lie within two; one of half of nu's range of
  // 0 to 0.5 says nothing of it.
  constexpr double kHalf = 0.5, kHalfRange = 0.25;
  std::vector<std::string> names;
  for (const Parameter& p : model.parameters) {
    if (p.state != ParameterState::kFree) continue;
    const bool modulus = p.unit == "Pa", nu = is_poissons_ratio(p);
    if ((modulus && p.std_error > kHalf * p.value) || (nu && p.std_error > kHalfRange))
      names.push_back(p.effect + " " + p.name);
  }
  return names;
}

std::string plates_words(const Model& model, const Experiment& experiment) {
  const Dataset& dataset = experiment.dataset;
  const auto between = std::find_if(dataset.episodes.begin(), dataset.episodes.end(),
                                    [](const Episode& e) { return e.view.height > 0; });
  if (between == dataset.episodes.end() || dataset.setups.size() > 1) return "";
  const double height = between->view.height;
  const double section = signed_volume(experiment.places.setup(0)->surface()) / height;
  const double slender = height / std::sqrt(4 * section / std::numbers::pi);
  const PreparedContact& contact =
      experiment.places.contact(static_cast<std::size_t>(between->position));
  Eigen::Matrix3d K, dK_dnu;
  contact.stiffness.evaluate(material_of(model).nu, K, dK_dnu);
  std::string text = fmt::format(
      "the tool covers the body, {:.3g} mm high, which is taken as bonded to both plates; where "
      "its "
      "faces slide, E is {:.2f} times this",
      1e3 * height, contact.normal.dot(K * contact.normal) * height / section);
  if (slender < kLeastSlender || slender > kMostSlender)
    text += fmt::format(
        "; it is {:.2g} times as high as wide, and finite strain was verified from {:g} to {:g}",
        slender, kLeastSlender, kMostSlender);
  return text;
}

std::vector<std::string> known_words(const Model& model, const Dataset& dataset) {
  std::vector<std::string> lines;
  const DataSummary summary = summarise(dataset, 1);
  for (const Effect* effect : catalogue()) {
    const std::vector<double> values = effect->known(summary);
    const EffectCard& card = effect->card();
    for (std::size_t k = 0; k < values.size(); ++k) {
      const ParameterCard& p = card.parameters[k];
      const std::string said = fmt::format("{} {} = {:.4g} {}", card.name, p.name, values[k],
                                           p.unit == "1" ? "" : p.unit);
      const Parameter* own = model.find(card.name, 0, p.name);
      if (own == nullptr)
        lines.push_back(fmt::format(
            "the recording's header says {}, which the model lacks: its other values take that up "
            "(identify it without --model, or --add {})",
            said, card.name));
      else if (own->state == ParameterState::kFixed && own->value == values[k])
        lines.push_back(fmt::format(
            "{} is what the recording's header says of the tool, and not fitted (--add {} does)",
            said, card.name));
    }
  }
  return lines;
}

namespace {

std::string value_words(const Parameter& p) {
  const std::string name = p.region > 0 ? fmt::format("{} (region {})", p.name, p.region) : p.name;
  if (std::isnan(p.std_error))
    return fmt::format("{} = {:.4g}{} ± not estimated", name, p.value,
                       p.unit == "1" ? "" : " " + p.unit);
  return name + " = " +
         with_interval(p.value, p.unit, p.std_error, interval95(p), is_logarithmic(p), 4, 2);
}

// A paragraph an effect, of the free parameters; `values` has all of them.
SummaryItem values_item(const Model& model, std::vector<SummaryValue>& values) {
  constexpr int kMost = 12;
  SummaryItem item{"VALUES", "", "", {}};
  std::string effect;
  int shown = 0;
  for (const Parameter& p : model.parameters) {
    if (p.state != ParameterState::kFree) continue;
    values.push_back({parameter_name(p), p.value, p.unit, p.std_error});
    if (++shown > kMost) continue;
    if (p.effect == effect)
      item.facts.back() += ", " + value_words(p);
    else
      item.facts.push_back(p.effect + " " + value_words(p));
    effect = p.effect;
  }
  if (shown > kMost) item.facts.push_back(fmt::format("... and {} more", shown - kMost));
  if (item.facts.empty()) item.facts.push_back("none was free");
  return item;
}

// What the data do not tell, or make doubtful.
std::vector<std::string> doubts(const Experiment& w, const Fit& result) {
  std::vector<std::string> lines;
  const auto add = [&](const std::string& text) {
    if (!text.empty()) lines.push_back(text);
  };
  const auto warn = [&](const std::vector<std::string>& names, const char* what) {
    constexpr std::size_t kMost = 4;
    for (std::size_t i = 0; i < std::min(kMost, names.size()); ++i) add(names[i] + what);
    if (names.size() > kMost) add(fmt::format("... and {} more", names.size() - kMost));
  };
  add(w.shape.words());
  for (const std::string& known : known_words(result.model, w.dataset)) add(known);
  add(plates_words(result.model, w));
  warn(result.at_bound,
       " is at its bound: the data ask for more than the model can give, or cannot tell; where it "
       "is known, hold it (--fix NAME=VALUE), for the other values depend on it");
  warn(result.undetermined, " is not determined by these data: fix it, or press where it matters");
  warn(hardly_known(result.model),
       " is hardly known (standard error of half its value or range): fix it, or press at more "
       "places and sideways");
  if (w.dataset.positions.size() == 1)
    add("all presses are at one place: how the body differs from place to place is not seen");
  add(strange_modulus(result.model));
  add(mixture_words(result.about));
  add(result.torque.unused);
  add(result.marker.unused);
  for (const std::string& sentence : result.blind) add(sentence);
  for (const std::string& sentence : untold_times(result.model, w.dataset)) add(sentence);
  for (const std::string& interval : result.intervals) add(interval);
  if (result.discounted > 0)
    add(fmt::format("{} of {} {} components discounted as far off", result.discounted,
                    result.residuals + 3 * static_cast<long>(result.torque.rows) +
                        static_cast<long>(result.marker.components),
                    result.marker.rows > 0   ? "force and other"
                    : result.torque.rows > 0 ? "force and torque"
                                             : "force"));
  if (!enough_data(result.residuals,
                   static_cast<Eigen::Index>(result.model.free_parameters().size())))
    add("fewer than ten force components a free parameter: noise may decide their values");
  return lines;
}

}  // namespace

Summary fit_summary(const Experiment& w, const Fit& result, double held_out, const std::string& by,
                    double force_rms) {
  constexpr double kNoiseAlone = 1.15;
  Summary s;
  const double error = result.error.told(), noise = w.noise.value;
  const bool unseen = !by.empty() && !std::isnan(held_out);
  const bool torques_too = result.torque.rows == 0 || result.torque.whitened <= kNoiseAlone;
  const bool points_too = marker_explained(result.marker);
  const bool only_noise = error <= kNoiseAlone * noise && torques_too && points_too,
             known = result.at_bound.empty();
  s.mark = only_noise && known ? Summary::Mark::kGood : Summary::Mark::kOpen;
  s.verdict = fmt::format("{}: {} fits{}", w.dataset.recording.name, effects_label(result.model),
                          !only_noise && error <= kNoiseAlone * noise
                              ? fmt::format(" the forces to the noise, and not the {}",
                                            torques_too ? "marked points" : "torques")
                          : !only_noise ? "; more than noise is left"
                          : known       ? " to the noise"
                                        : " to the noise, but at a bound");
  s.size = fmt::format("error {:.4g} N = {:.3g} x noise", error, error / noise);
  s.items = {
      {"ERROR", "", "", {fmt::format("{:.3g} % of the force's rms", 100 * error / force_rms)}}};
  if (unseen)
    s.items[0].facts.push_back(
        fmt::format("on {} not seen by the fit {:.4g} N = {:.3g} %, {:.3g} x noise", by, held_out,
                    100 * held_out / force_rms, held_out / noise));
  const TorqueError& torque = result.torque;
  if (torque.rows > 0)
    s.items.push_back(
        {"TORQUES",
         "",
         "",
         {fmt::format("{} count beside the forces: error {:.3g} N m = {:.3g} x noise ({:.3g} N m, "
                      "{}), {:.3g} of what noise and levers let it be; torque rms {:.3g} N m",
                      counted(torque.rows, "row", "rows"), torque.rms, torque.rms / torque.noise,
                      torque.noise, torque.noise_origin, torque.whitened, torque.size)}});
  const MarkerError& marker = result.marker;
  if (marker.rows > 0) s.items.push_back({"MARKERS", "", "", marker_facts(marker)});
  s.values = {{"error", error, "N"},
              {"heldout", unseen ? held_out : std::nan(""), "N"},
              {"force_noise", noise, "N"},
              {"force_rms", force_rms, "N"}};
  if (torque.rows > 0) {
    s.values.push_back({"torque_error", torque.rms, "N m"});
    s.values.push_back({"torque_noise", torque.noise, "N m"});
  }
  if (marker.rows > 0) {
    s.values.push_back({"marker_error", marker.rms, "m"});
    s.values.push_back({"marker_noise", marker.noise, "m"});
  }
  s.items.push_back(values_item(result.model, s.values));
  if (std::vector<std::string> words = constraint_words(result); !words.empty()) {
    s.items.push_back({"CONSTRAINTS", "", "", std::move(words)});
    s.values.push_back({"unconstrained_error", result.unconstrained, "N"});
    for (const KeptConstraint& c : result.constraints)
      s.values.push_back({"cost of " + c.text, c.active ? c.cost : 0, "N"});
  }
  s.items.push_back(
      {"DATA",
       "",
       "",
       {fmt::format("{} at {}{}, {}; noise {:.3g} N ({}), force rms {:.3g} N",
                    counted(w.dataset.recording.presses().size(), "press", "presses"),
                    counted(w.dataset.positions.size(), "position", "positions"),
                    setups_in_words(w.dataset), counted(w.dataset.rows(), "sample", "samples"),
                    noise, w.noise.origin, force_rms)}});
  s.notes = doubts(w, result);
  return s;
}

std::string choice_words(const TermChoice& choice, const std::string& effect) {
  std::string trials;
  for (const TermTrial& t : choice.trials)
    trials += fmt::format(
        "{}{}: error {:.4g} N{}", trials.empty() ? "" : "; ", t.terms, t.fit.error.told(),
        std::isnan(t.held_out.pooled) ? "" : fmt::format(", unseen {:.4g} N", t.held_out.told()));
  return fmt::format("{} of {} chosen ({})", counted(choice.terms, "term", "terms"), effect,
                     trials);
}

std::string boundary_words(const BoundaryFit& refined, const Fit& before) {
  if (!refined.better) return "the boundaries stay: moving them does not lower the error";
  double squares = 0;
  for (const double d : refined.moved) squares += d * d / static_cast<double>(refined.moved.size());
  return fmt::format(
      "boundaries moved by {:.2g} mm (rms), at most {:.2g} mm; error {:.4g} N before; "
      "their points are known to {:.2g} to {:.2g} mm",
      1e3 * std::sqrt(squares), 1e3 * *std::max_element(refined.moved.begin(), refined.moved.end()),
      before.error.told(), 1e3 * *std::min_element(refined.error.begin(), refined.error.end()),
      1e3 * *std::max_element(refined.error.begin(), refined.error.end()));
}

std::string later_words(const LaterError& error, double seconds) {
  return fmt::format(
      "after {:g} s, not seen by the fit: {} samples, error {:.4g} N, median {:.3g} "
      "% of the peak of the press",
      seconds, error.rows, error.rmse, 100 * error.median);
}

}  // namespace hapsim
