// Prints the manual page hs-effects(7) from the catalogue.
#include <cmath>
#include <cstdio>
#include <string>

#include "effects/catalogue.h"

namespace {

// Roff text: backslashes and a leading dot or quote would be commands.
std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '\\')
      out += "\\e";
    else if (c == '-')
      out += "\\-";
    else
      out += c;
  }
  return !out.empty() && (out[0] == '.' || out[0] == '\'') ? "\\&" + out : out;
}

void item(const char* tag, const std::string& text) {
  if (!text.empty()) std::printf(".TP\n%s\n%s\n", tag, escaped(text).c_str());
}

// What a recording must have for the effect to show at all.
std::vector<std::string> needs(const hapsim::EffectCard& card) {
  std::vector<std::string> list;
  const auto add = [&](bool needed, const char* what) {
    if (needed) list.emplace_back(what);
  };
  add(card.needs_time, "the column t");
  add(card.needs_session, "one clock for all presses");
  add(card.needs_positions, "four places or more");
  add(card.needs_temperature, "the column temp, warm and cold presses");
  add(card.needs_sideways, "presses that move sideways");
  add(card.needs_return, "presses recorded on their way out");
  add(card.shows_at_starts, "presses recorded on their way out, or many");
  add(card.needs_rim, "a tool that covers a part of the body");
  add(card.needs_repeats, "a place pressed more than once");
  add(card.needs_ceiling, "readings that are exactly the largest of their axis");
  add(card.needs_line, "a frequency that stands out of what the model leaves");
  return list;
}

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

}  // namespace

int main() {
  std::printf(
      ".TH HS\\-EFFECTS 7 \"\" hapsim \"hapsim manual\"\n.SH NAME\nhs\\-effects \\- the "
      "physical effects that hapsim knows\n.SH DESCRIPTION\n"
      "A model is a list of effects; a force passes through them in the order below. "
      "Every effect can be identified, simulated and looked for.\n");
  for (const hapsim::Effect* effect : hapsim::catalogue()) {
    const hapsim::EffectCard& card = effect->card();
    std::printf(".SH %s\n%s.\n", escaped(card.name).c_str(), escaped(card.title).c_str());
    item("Equation", card.equation);
    item("Source", card.source);
    item("Assumptions", card.assumptions);
    for (const hapsim::ParameterCard& p : card.parameters)
      std::printf(".TP\n%s [%s]\n%s; from %g to %g%s.\n", p.name.c_str(), p.unit.c_str(),
                  escaped(p.meaning).c_str(), p.lower, p.upper,
                  card.terms ? ", one for every term" : "");
    for (const hapsim::ParameterCard& p : card.of_region)
      std::printf(".TP\n%s [%s]\n%s; from %g to %g, of a region above 0.\n", p.name.c_str(),
                  p.unit.c_str(), escaped(p.meaning).c_str(), p.lower, p.upper);
    item("Needs", joined(needs(card)));
    item("When it is missing", card.signature);
    if (card.form_error > 0)
      item("Its law may err by",
           std::to_string(std::lround(100 * card.form_error)) +
               " % of the force that it changes; a diagnosis infers nothing from less");
    item("Kind", joined(card.kinds));
    item("Taken for", joined(card.confounders));
    item("To tell them apart", card.separated_by);
    item("Includes", joined(card.contains));
    item("Live", card.live);
  }
  std::printf(".SH SEE ALSO\nhs\\-identify(1), hs\\-diagnose(1)\n");
  return 0;
}
