#include <cmath>
#include <nlohmann/json.hpp>

#include "explore/explore_summary.h"

namespace hapsim {
namespace {

nlohmann::json known(double value) {
  return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json();
}

}  // namespace

std::string aim_name(Aim aim) {
  switch (aim) {
    case Aim::kSpread:
      return "spread";
    case Aim::kTest:
      return "test";
    case Aim::kTellApart:
      return "tell apart";
    case Aim::kSharpen:
      return "sharpen";
    case Aim::kUnseen:
      return "unseen";
    case Aim::kLump:
      return "lump";
    default:
      return "none";
  }
}

std::string explore_json(const Exploration& e) {
  nlohmann::json j;
  j["reached"] = e.reached;
  j["ended"] = e.ended;
  j["presses"] = e.presses;
  j["places"] = e.places;
  j["goals"] = nlohmann::json::array();
  for (const GoalState& g : e.goals)
    j["goals"].push_back({{"goal", g.name},
                          {"said", g.said},
                          {"value", known(g.value)},
                          {"wanted", g.wanted},
                          {"reached", g.reached},
                          {"unreachable", g.unreachable},
                          {"note", g.note}});
  j["aim"] = aim_name(e.aim);
  j["why"] = e.why;
  j["promise"] = known(e.promise);
  j["rivals"] = e.rivals;
  j["parameter"] = e.parameter;
  j["verdict"] =
      e.diagnosis ? nlohmann::json(verdict_name(e.diagnosis->verdict)) : nlohmann::json();
  j["explanation"] = e.diagnosis ? nlohmann::json(e.diagnosis->explanation) : nlohmann::json();
  j["missing"] = nlohmann::json::array();
  if (e.diagnosis)
    for (const Finding& f : e.diagnosis->findings)
      if (f.verdict == Verdict::kMissing) j["missing"].push_back(f.effect);
  j["untested"] = nlohmann::json::array();
  for (const UntestedEffect& u : e.untested)
    j["untested"].push_back({{"effect", u.effect}, {"lack", u.lack}});
  j["no_times"] = e.no_times;
  j["gap"] = known(e.gap);
  j["shallower"] = e.shallower;
  j["lumps"] = nlohmann::json::array();
  for (const Lump& l : e.lumps)
    j["lumps"].push_back({{"centre", {l.centre.x(), l.centre.y(), l.centre.z()}},
                          {"low", {l.x.low, l.y.low, l.z.low}},
                          {"high", {l.x.high, l.y.high, l.z.high}},
                          {"radius", l.radius},
                          {"ratio", l.ratio},
                          {"chance", l.chance}});
  j["inside"] = e.inside;
  j["next"] = nlohmann::json::array();
  for (const PlannedPress& p : e.plan.presses)
    j["next"].push_back({{"motion", p.motion},
                         {"x", p.position.x()},
                         {"y", p.position.y()},
                         {"z", p.position.z()}});
  return j.dump(2) + "\n";
}

}  // namespace hapsim
